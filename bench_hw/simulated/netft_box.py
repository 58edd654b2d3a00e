"""`NetFTBox`: a simulated Net F/T box on loopback: RDT over UDP, configuration over HTTP, faults on demand.

One client at a time, as the real box: a later request takes the stream over. The box works at each tick of its clock,
in a thread of its own in real time and inside `sleep` in simulated time. Its records are made in `rdt_stream`.
"""

from __future__ import annotations

import contextlib
import socket
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import parse_qs, urlsplit
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from bench_hw.clock import Cancel, Clock
from bench_hw.devices import rdt
from bench_hw.devices.rdt import INTERNAL_RATE, Command, Status
from bench_hw.simulated.rdt_stream import RdtStream, StreamFaults, StreamSettings
from bench_hw.simulated.sensor import SensorModel
from bench_hw.simulated.specimen import FloatArray

Page = Callable[[str, dict[str, str]], str | None]
"""Path and query of a request to the text of the page; None for a page there is not."""
TICK = 1e-3
_LARGEST_COUNT = 2**31 - 1


def configuration_page(values: dict[str, str]) -> str:
    """Write `netftapi2.xml` from element names and their texts."""
    lines = [f"<{name}>{escape(text)}</{name}>" for name, text in values.items()]
    return "\r\n".join(['<?xml version="1.0" encoding="UTF-8"?>', "<netft>", *lines, "</netft>", ""])


class PageServer:
    """An HTTP server on loopback in its own threads.

    Parameters
    ----------
    page : Page
        What to answer.
    port : int
        Port; 0 lets the system choose.
    """

    def __init__(self, page: Page, port: int = 0) -> None:
        self._server = ThreadingHTTPServer(("127.0.0.1", port), _handler(page))
        self._server.daemon_threads = True
        self._thread = threading.Thread(
            target=self._server.serve_forever, kwargs={"poll_interval": 0.05}, name="pages", daemon=True
        )
        self._thread.start()

    @property
    def port(self) -> int:
        """The port it listens on."""
        return int(self._server.server_address[1])

    def close(self) -> None:
        """Stop answering and free the port."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join(timeout=5.0)


def _handler(page: Page) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        timeout = 5.0

        def do_GET(self) -> None:
            parts = urlsplit(self.path)
            query = {name: values[-1] for name, values in parse_qs(parts.query).items()}
            text = page(parts.path, query)
            body = (text or "no such page").encode()
            self.send_response(200 if text is not None else 404)
            self.send_header("Content-Type", "text/xml" if parts.path.endswith(".xml") else "text/html")
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args: object) -> None:
            """Say nothing: this runs inside tests and other programs."""

    return Handler


@dataclass(frozen=True, slots=True)
class BoxSettings:
    """What the box is.

    Parameters
    ----------
    serial : str
        Serial number of its calibration.
    counts_per_force, counts_per_torque : int
        Counts per N and per N m.
    rate : int
        RDT rate at power-on, Hz (the factory's 7000).
    records_per_datagram : int
        Buffer size of buffered mode.
    first_sequence : int
        rdt_sequence of a stream's first record.
    sensor : SensorModel
        What it measures with.
    faults : StreamFaults
        What goes wrong in the stream.
    """

    serial: str = "FT00000"
    counts_per_force: int = 1_000_000
    counts_per_torque: int = 1_000_000
    rate: int = INTERNAL_RATE
    records_per_datagram: int = 40
    first_sequence: int = 1
    sensor: SensorModel = field(default_factory=SensorModel)
    faults: StreamFaults = field(default_factory=StreamFaults)


class NetFTBox:
    """A box that is switched on when made and off by `close`.

    Parameters
    ----------
    load : callable
        Force on the tool at instants (n,) of the clock, (n, 3) N: sideways x and y, press.
    clock : Clock
        Its clock.
    settings : BoxSettings
        What it is.
    rng : numpy.random.Generator
        Source of noise and chance.
    rdt_port, http_port : int
        Ports on 127.0.0.1; 0 lets the system choose.
    """

    host = "127.0.0.1"

    def __init__(
        self,
        load: Callable[[FloatArray], FloatArray],
        clock: Clock,
        settings: BoxSettings,
        rng: np.random.Generator,
        *,
        rdt_port: int = 0,
        http_port: int = 0,
    ) -> None:
        self._load, self._clock, self._settings, self._rng = load, clock, settings, rng
        self._on_since = clock.now()
        self._lock = threading.RLock()
        self._rate, self._buffer = settings.rate, settings.records_per_datagram
        self._bias = np.zeros(6)
        self._status = 0
        self._last = np.zeros(6, np.int32)
        self._held: NDArray[np.int32] | None = None
        self._stalled_until = -np.inf
        self._client: tuple[str, int] | None = None
        self._stream: RdtStream | None = None
        self._ended = [0, 0]
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((self.host, rdt_port))
        self._socket.setblocking(False)
        self._pages = PageServer(self._page, http_port)
        self._cancel: Cancel = clock.every(TICK, self.tick)

    @property
    def rdt_port(self) -> int:
        """UDP port."""
        return int(self._socket.getsockname()[1])

    @property
    def http_port(self) -> int:
        """TCP port of the pages."""
        return self._pages.port

    @property
    def sent(self) -> int:
        """Records that left the box, repeated ones included."""
        return self._ended[0] + (self._stream.sent if self._stream else 0)

    @property
    def dropped(self) -> int:
        """Records that were to be lost."""
        return self._ended[1] + (self._stream.dropped if self._stream else 0)

    def tick(self, now: float) -> None:
        """Answer requests and send what is due at the reading `now`."""
        with self._lock, contextlib.suppress(OSError):  # closed meanwhile
            self._answer_requests(now)
            if self._stream is None or self._client is None or now < self._stalled_until:
                return
            for datagram in self._stream.due(now):
                self._socket.sendto(datagram, self._client)
            if self._stream.finished:
                self._end_stream()

    def stall(self, duration: float) -> None:
        """Send nothing for `duration` seconds, then go on with the next number."""
        with self._lock:
            self._stalled_until = self._clock.now() + duration
            if self._stream is not None:
                self._stream.pause(duration)

    def freeze(self, frozen: bool = True) -> None:
        """Let the sample number stand still while records go on."""
        with self._lock:
            if self._stream is not None:
                self._stream.freeze(frozen)

    def hold_reading(self, held: bool = True) -> None:
        """Give the last reading again and again under new sample numbers, as a box whose analogue part hangs."""
        with self._lock:
            self._held = self._last if held else None

    def restart(self) -> None:
        """Restart the counters while the stream continues."""
        with self._lock:
            if self._stream is not None:
                self._stream.restart()

    def set_status(self, status: int) -> None:
        """Set bits of the status word of every following record."""
        with self._lock:
            self._status = status

    def close(self) -> None:
        """Switch the box off; may be repeated."""
        self._cancel()
        with self._lock:
            self._end_stream()
            self._socket.close()
        self._pages.close()

    def __enter__(self) -> NetFTBox:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _answer_requests(self, now: float) -> None:
        with contextlib.suppress(BlockingIOError):
            while True:
                datagram, client = self._socket.recvfrom(2048)
                request = rdt.parse_request(datagram)
                if request is not None:
                    self._obey(*request, client, now)

    def _obey(self, command: Command, count: int, client: tuple[str, int], now: float) -> None:
        if command in (Command.START_REALTIME, Command.START_BUFFERED):
            self._end_stream()
            buffered = command is Command.START_BUFFERED
            size = self._buffer if buffered else 1
            divider = rdt.divider_of(self._rate)
            settings = StreamSettings(divider, size, count, self._settings.first_sequence)
            self._client = client
            self._stream = RdtStream(settings, now, self._measure, self._settings.faults, self._rng)
        elif command is Command.STOP:
            self._end_stream()
        elif command is Command.BIAS:
            self._bias = self._wrench(np.array([now])).mean(axis=0)
        else:
            self._status &= ~Status.LATCH_ONLY

    def _end_stream(self) -> None:
        if self._stream is not None:
            self._ended = [self.sent, self.dropped]
        self._stream = self._client = None

    def _wrench(self, instants: FloatArray) -> FloatArray:
        sensor = self._settings.sensor
        return sensor.wrench(self._load(instants), instants - self._on_since, self._rng)

    def _measure(self, instants: FloatArray) -> tuple[NDArray[np.int32], NDArray[np.uint32]]:
        wrench, saturated = self._settings.sensor.saturated(self._wrench(instants))
        scale = np.repeat([self._settings.counts_per_force, self._settings.counts_per_torque], 3)
        counts = np.clip(np.rint((wrench - self._bias) * scale), -_LARGEST_COUNT, _LARGEST_COUNT)
        flagged = np.where(saturated, Status.ERROR | Status.SATURATED, 0)
        if self._held is not None:
            counts = np.broadcast_to(self._held, counts.shape)
        self._last = counts[-1].astype(np.int32)
        return counts.astype(np.int32), (flagged | self._status).astype(np.uint32)

    def _page(self, path: str, query: dict[str, str]) -> str | None:
        if path == "/netftapi2.xml":
            return configuration_page(self._values())
        if path != "/comm.cgi":
            return None
        with self._lock:
            if (rate := _number(query.get("comrdtrate", ""), INTERNAL_RATE)) is not None:
                self._rate = rdt.rate_of(rate)
            if (size := _number(query.get("comrdtbsiz", ""), rdt.LARGEST_BUFFER)) is not None:
                self._buffer = size
        return "<html><body>Communication settings</body></html>"

    def _values(self) -> dict[str, str]:
        settings = self._settings
        return {
            "prodname": "Simulated Net F/T",
            "runstat": f"0x{self._status:08x}",
            "runrate": str(INTERNAL_RATE),
            "cfgnam": "simulated",
            "cfgcalsn": settings.serial,
            "cfgfu": "2",
            "scfgfu": "N",
            "cfgtu": "3",
            "scfgtu": "N-m",
            "cfgcpf": str(settings.counts_per_force),
            "cfgcpt": str(settings.counts_per_torque),
            "cfgmr": ";".join(f"{value:g}" for value in settings.sensor.ranges),
            "comrdte": "Enabled",
            "comrdtrate": str(self._rate),
            "comrdtbsiz": str(self._buffer),
        }


def _number(text: str, largest: int) -> int | None:
    """Read a setting from 1 to `largest`; None leaves it as it is."""
    return int(text) if text.isdecimal() and 1 <= int(text) <= largest else None
