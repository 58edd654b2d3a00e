"""How a Net F/T box is reached: its XML configuration over HTTP, its datagrams over UDP. What they mean is in `rdt`.

XML comes from a device on the network, so it is read with defusedxml, with a time-out and a limit on its size. The
socket never waits.
"""

from __future__ import annotations

import hashlib
import http.client
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bench_hw.devices import rdt
from bench_hw.devices.rdt import Command
from bench_hw.errors import DeviceError

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element


CONFIGURATION_PAGE = "/netftapi2.xml"
_LARGEST_PAGE = 1_000_000
_FORCE_UNITS = {"N": 1.0, "kN": 1e3, "lbf": 4.4482216152605, "klbf": 4448.2216152605, "kgf": 9.80665}
_TORQUE_UNITS = {
    "Nm": 1.0,
    "Nmm": 1e-3,
    "kNm": 1e3,
    "lbfin": 0.1129848290276167,
    "lbfft": 1.3558179483314004,
    "kgfcm": 0.0980665,
}
_PATIENCE = 3.0
"""Times the time-out of one piece that a whole answer may take."""
_LARGEST_DATAGRAM = 65_536
_RECEIVE_BUFFER = 4 * 1024 * 1024
_MOST_DATAGRAMS = 8192


@dataclass(frozen=True, slots=True)
class NetFTConfiguration:
    """What the box says of itself.

    Parameters
    ----------
    product, serial : str
        Product name and serial number of the active calibration.
    newton_per_count, newton_metre_per_count : float
        Scale of force and torque counts, units included.
    ranges : tuple of 6 floats
        Largest magnitudes of Fx..Tz, N and N m; NaN where the box does not say.
    rate : int
        RDT output rate, Hz.
    buffer : int
        Records in one datagram of buffered mode; 0 if the box does not say.
    status : int
        Status word of the moment.
    enabled : bool
        Whether RDT is switched on.
    fingerprint : str
        SHA-256 of everything that turns counts into newtons.
    """

    product: str
    serial: str
    newton_per_count: float
    newton_metre_per_count: float
    ranges: tuple[float, ...]
    rate: int
    buffer: int
    status: int
    enabled: bool
    fingerprint: str


def fetch(host: str, port: int, path: str, timeout: float) -> bytes:
    """GET one page of the box.

    Raises
    ------
    DeviceError
        No connection, no answer in time, another status than 200 or 302, or a page above 1 MB. `timeout` (s) holds for
        each piece of the answer, and `_PATIENCE` times as long for the whole.
    """
    where = f"force sensor at http://{host}:{port}{path}"
    connection = _Connection(host, port, timeout=timeout)
    try:
        with _ended_after(connection, _PATIENCE * timeout):
            connection.request("GET", path)
            answer = connection.getresponse()
            page = answer.read(_LARGEST_PAGE + 1)
    except (OSError, http.client.HTTPException, AttributeError, UnicodeError) as error:
        # AttributeError: ended while it was read; UnicodeError: a name that no network has
        reason = str(error) or type(error).__name__
        raise DeviceError(
            f"{where}: no answer ({reason}) within {timeout:g} s, or no whole one within {_PATIENCE * timeout:g} s; "
            "check host, http_port, cable and power"
        ) from error
    finally:
        connection.close()
    if answer.status not in (200, 302):
        raise DeviceError(f"{where}: answered with status {answer.status}; allowed is 200")
    if len(page) > _LARGEST_PAGE:
        raise DeviceError(f"{where}: the page is larger than {_LARGEST_PAGE} bytes; this is no Net F/T box")
    return page


class _Connection(http.client.HTTPConnection):
    """Keeps its socket as `opened`: its own `sock` is let go once an answer has begun that ends with the connection."""

    opened: socket.socket | None = None

    def connect(self) -> None:
        super().connect()
        self.opened = self.sock


@contextmanager
def _ended_after(connection: _Connection, seconds: float) -> Iterator[None]:
    """Shut a connection down after a time: one byte a second would otherwise keep it open for ever.

    Raises
    ------
    TimeoutError
        The time was over; what came may be cut.
    """
    over = threading.Event()

    def end() -> None:
        over.set()
        if connection.opened is not None:
            with suppress(OSError):
                connection.opened.shutdown(socket.SHUT_RDWR)

    timer = threading.Timer(seconds, end)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
    if over.is_set():
        raise TimeoutError("it answers too slowly")


def read_configuration(host: str, port: int, timeout: float) -> NetFTConfiguration:
    """Read and understand the box's configuration.

    Raises
    ------
    DeviceError
        As `fetch`; or the page is no Net F/T configuration.
    """
    return parse_configuration(fetch(host, port, CONFIGURATION_PAGE, timeout), f"{host}:{port}")


def set_rate(host: str, port: int, rate: int, timeout: float, buffer: int | None = None) -> None:
    """Ask for an RDT output rate (Hz), and for a number of records in a datagram of buffered mode.

    Read the configuration to see the effect.

    Raises
    ------
    DeviceError
        As `fetch`.
    """
    size = "" if buffer is None else f"&comrdtbsiz={buffer}"
    fetch(host, port, f"/comm.cgi?comrdtrate={rate}{size}", timeout)


def parse_configuration(page: bytes, source: str) -> NetFTConfiguration:
    """Understand `netftapi2.xml`.

    Raises
    ------
    DeviceError
        Not well-formed, another root element, a value that is missing or no number, an unknown unit.
    """
    root = _root(page, source)
    fields = _Fields(root, source)
    force, torque = fields.positive("cfgcpf"), fields.positive("cfgcpt")
    newton = fields.unit("scfgfu", _FORCE_UNITS)
    newton_metre = fields.unit("scfgtu", _TORQUE_UNITS)
    described = "|".join(fields.text(key) for key in ("cfgcalsn", "cfgcpf", "cfgcpt", "scfgfu", "scfgtu"))
    return NetFTConfiguration(
        product=fields.text("prodname"),
        serial=fields.text("cfgcalsn"),
        newton_per_count=newton / force,
        newton_metre_per_count=newton_metre / torque,
        ranges=_ranges(fields.text("cfgmr"), newton, newton_metre),
        rate=int(fields.positive("comrdtrate")),
        buffer=fields.integer("comrdtbsiz", 10),
        status=fields.integer("runstat", 16),
        enabled=fields.text("comrdte").lower() not in ("disabled", "0"),
        fingerprint=hashlib.sha256(described.encode()).hexdigest(),
    )


def _root(page: bytes, source: str) -> Element:
    import defusedxml.ElementTree

    try:
        root: Element = defusedxml.ElementTree.fromstring(page)
    except Exception as error:
        raise DeviceError(f"force sensor at {source}: its configuration is no XML ({error})") from error
    if root.tag.lower() != "netft":
        raise DeviceError(f"force sensor at {source}: root element <{root.tag[:40]}>; allowed is <netft>")
    return root


class _Fields:
    """The page's elements by name."""

    def __init__(self, root: Element, source: str) -> None:
        self._values = {element.tag.lower(): (element.text or "").strip() for element in root.iter()}
        self._source = source

    def text(self, key: str) -> str:
        return self._values.get(key, "")

    def positive(self, key: str) -> float:
        try:
            value = float(self.text(key))
        except ValueError:
            value = 0.0
        if not 0.0 < value < float("inf"):
            raise self._wrong(key, "a positive number")
        return value

    def integer(self, key: str, base: int) -> int:
        text = self.text(key)
        try:
            return int(text, base) if text else 0
        except ValueError:
            raise self._wrong(key, f"an integer to base {base}") from None

    def unit(self, key: str, units: dict[str, float]) -> float:
        name = self.text(key).replace("-", "").replace("\N{MIDDLE DOT}", "").replace("*", "")
        if name not in units:
            raise self._wrong(key, " or ".join(units))
        return units[name]

    def _wrong(self, key: str, allowed: str) -> DeviceError:
        return DeviceError(f"force sensor at {self._source}: {key} = {self.text(key)[:40]!r}; allowed is {allowed}")


def _ranges(text: str, newton: float, newton_metre: float) -> tuple[float, ...]:
    try:
        values = [float(part) for part in text.split(";") if part.strip()]
    except ValueError:
        values = []
    if len(values) != 6:
        return (float("nan"),) * 6
    return tuple(value * (newton if axis < 3 else newton_metre) for axis, value in enumerate(values))


class RdtSocket:
    """A socket connected to one box: the kernel drops what other hosts send.

    Parameters
    ----------
    host : str
        Address of the box.
    port : int
        Its RDT port.

    Raises
    ------
    DeviceError
        The address means nothing or cannot be reached.
    """

    def __init__(self, host: str, port: int) -> None:
        self.where = f"{host}:{port}"
        self.malformed = 0
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _RECEIVE_BUFFER)
            self._socket.connect((host, port))
            self._socket.setblocking(False)
        except (OSError, UnicodeError) as error:
            self._socket.close()
            raise self._failed(error) from error

    def send(self, command: Command) -> None:
        """Send one request.

        Raises
        ------
        DeviceError
            The box or the network refuses it.
        """
        try:
            self._socket.send(rdt.request(command))
        except OSError as error:
            raise self._failed(error) from error

    def receive(self) -> list[NDArray[np.void]]:
        """Give the records (n,) of every datagram that has come, oldest first; others are counted `malformed`.

        Raises
        ------
        DeviceError
            The box refuses datagrams, or the network is down.
        """
        received: list[NDArray[np.void]] = []
        for _ in range(_MOST_DATAGRAMS):
            try:
                datagram = self._socket.recv(_LARGEST_DATAGRAM)
            except BlockingIOError:
                break
            except OSError as error:
                raise self._failed(error) from error
            records = rdt.parse_records(datagram)
            if records is None:
                self.malformed += 1
            else:
                received.append(records)
        return received

    def close(self) -> None:
        """Ask the box to stop, if it still listens, and close."""
        try:
            self._socket.send(rdt.request(Command.STOP))
        except OSError:
            pass  # gone already: nothing to stop
        finally:
            self._socket.close()

    def _failed(self, error: OSError | UnicodeError) -> DeviceError:
        if isinstance(error, ConnectionRefusedError):
            return DeviceError(f"force sensor at {self.where}: refuses datagrams; check rdt_port and power")
        return DeviceError(f"force sensor at {self.where}: {getattr(error, 'strerror', None) or error}")
