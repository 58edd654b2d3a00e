"""The USB link to a LAC board through pyusb: find it, exchange packets, check each answer.

A backend can be given, so that the simulated board runs the same code without libusb. What the commands mean
is in `lac`.
"""

from __future__ import annotations

import errno
from typing import TYPE_CHECKING, Any

from bench_hw.devices import lac_wire
from bench_hw.devices.lac_wire import ANSWERED_WITH_POSITION, Code
from bench_hw.errors import DeviceError

if TYPE_CHECKING:
    from usb.backend import IBackend

WHERE = f"LAC board (USB {lac_wire.VENDOR:04X}:{lac_wire.PRODUCT:04X})"
_FLUSH_MS = 2
_MOST_STALE = 16


class LacLink:
    """One opened board.

    Parameters
    ----------
    serial : str, optional
        USB serial number the board must have; without it there must be exactly one board.
    backend : usb.backend.IBackend, optional
        Where to look; by default pyusb finds libusb.
    timeout : float
        Longest wait for one packet, s.

    Raises
    ------
    DeviceError
        No libusb, no board, several boards, another serial number, or no permission.
    """

    def __init__(self, serial: str | None, backend: IBackend | None, timeout: float) -> None:
        self._timeout_ms = max(1, round(timeout * 1000))
        self._device = _find(serial, backend)
        self._flush()

    @property
    def serial(self) -> str:
        """The board's USB serial number; empty if it has none."""
        return _serial_of(self._device)

    def exchange(self, code: Code, value: int = 0) -> int:
        """Send a command and give the value of its answer.

        Raises
        ------
        DeviceError
            Unplugged, no answer in time, or an answer to something else (then stale packets are thrown away).
        """
        import usb.core

        try:
            self._write(code, value)
            data = bytes(self._device.read(lac_wire.ENDPOINT_IN, lac_wire.PACKET.size, self._timeout_ms))
        except usb.core.USBError as error:
            self._flush()
            raise _failed(code, error) from error
        return self._checked(code, value, data)

    def send(self, code: Code, value: int) -> None:
        """Send a command without waiting for its answer: for a retraction that cannot wait.

        Raises
        ------
        DeviceError
            Unplugged, or the board does not take the packet in time.
        """
        import usb.core

        try:
            self._write(code, value)
        except usb.core.USBError as error:
            raise _failed(code, error) from error

    def flush(self) -> None:
        """Throw away answers that nobody read."""
        self._flush()

    def close(self) -> None:
        """Give the board back to the system."""
        import usb.util

        usb.util.dispose_resources(self._device)

    def _write(self, code: Code, value: int) -> None:
        self._device.write(lac_wire.ENDPOINT_OUT, lac_wire.packet(code, value), self._timeout_ms)

    def _checked(self, code: Code, value: int, data: bytes) -> int:
        answer = lac_wire.parse(data)
        good = answer is not None and answer[0] == code and answer[1] <= lac_wire.LARGEST
        if good and answer is not None and (code in ANSWERED_WITH_POSITION or answer[1] == value):
            return answer[1]
        self._flush()
        raise DeviceError(
            f"{WHERE}: {code.name} = {value} was answered with {data.hex(' ') or 'nothing'}; "
            f"expected {lac_wire.packet(code, value).hex(' ')}"
            + (" or another position" if code in ANSWERED_WITH_POSITION else "")
        )

    def _flush(self) -> None:
        import usb.core

        for _ in range(_MOST_STALE):
            try:
                self._device.read(lac_wire.ENDPOINT_IN, lac_wire.PACKET.size, _FLUSH_MS)
            except usb.core.USBError:
                return


def _find(serial: str | None, backend: IBackend | None) -> Any:
    import usb.core

    try:
        found = list(
            usb.core.find(find_all=True, idVendor=lac_wire.VENDOR, idProduct=lac_wire.PRODUCT, backend=backend)
        )
    except usb.core.NoBackendError as error:
        raise DeviceError(f"{WHERE}: libusb is missing; install it (Debian: apt install libusb-1.0-0)") from error
    except usb.core.USBError as error:
        raise _failed(None, error) from error
    device = _chosen(found, serial)
    try:
        device.set_configuration()
    except usb.core.USBError as error:
        raise _failed(None, error) from error
    return device


def _chosen(found: list[Any], serial: str | None) -> Any:
    if not found:
        raise DeviceError(f"{WHERE}: not found; check the USB cable and the board's power")
    if serial is None:
        if len(found) > 1:
            raise DeviceError(f"{WHERE}: {len(found)} boards; name one by `serial` in the rig file")
        return found[0]
    serials = [_serial_of(device) for device in found]
    if serial not in serials:
        raise DeviceError(f"{WHERE}: serial {' or '.join(map(repr, serials))}; the rig asks for {serial!r}")
    return found[serials.index(serial)]


def _serial_of(device: Any) -> str:
    import usb.core

    try:
        return str(device.serial_number or "")
    except (usb.core.USBError, ValueError):
        return ""


def _failed(code: Code | None, error: Any) -> DeviceError:
    doing = "" if code is None else f" at {code.name}"
    if error.errno in (errno.ENODEV, errno.EIO, errno.ENOENT, errno.EPIPE):
        return DeviceError(f"{WHERE}: lost{doing} (unplugged?)")
    if error.errno == errno.EACCES:
        return DeviceError(f"{WHERE}: no permission; add a udev rule for it or use an account that has it")
    if error.errno == errno.ETIMEDOUT:
        return DeviceError(f"{WHERE}: no answer in time{doing}")
    return DeviceError(f"{WHERE}: {error}{doing}")
