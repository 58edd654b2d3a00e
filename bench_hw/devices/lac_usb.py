"""The USB link to an Actuonix LAC board: 3-byte packets `<BH` of a code and a value from 0 to 1023, answers checked.

Every command is echoed, except that `SET_POSITION` and `GET_FEEDBACK` are answered with the present position in the
value. Source: Actuonix, "USB Control and Configuration of the LAC". pyusb finds the board; a backend can be given, so
that the simulated board runs the same code without libusb. Millimetres and travel limits are in `lac`.
"""

from __future__ import annotations

import errno
import struct
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from bench_hw.errors import DeviceError

if TYPE_CHECKING:
    from usb.backend import IBackend


VENDOR = 0x04D8
PRODUCT = 0xFC5F
ENDPOINT_OUT = 0x01
ENDPOINT_IN = 0x81
PACKET = struct.Struct("<BH")
LARGEST = 1023
"""Largest value of any command."""
COUNTS = 1024
"""Counts over the full stroke: one count is stroke / 1024."""
WHERE = f"LAC board (USB {VENDOR:04X}:{PRODUCT:04X})"
_FLUSH_MS = 2
_MOST_STALE = 16


class Code(IntEnum):
    """The board's commands."""

    SET_ACCURACY = 0x01
    SET_RETRACT_LIMIT = 0x02
    SET_EXTEND_LIMIT = 0x03
    SET_MOVEMENT_THRESHOLD = 0x04
    SET_STALL_TIME = 0x05
    SET_PWM_THRESHOLD = 0x06
    SET_DERIVATIVE_THRESHOLD = 0x07
    SET_DERIVATIVE_MAXIMUM = 0x08
    SET_DERIVATIVE_MINIMUM = 0x09
    SET_PWM_MAXIMUM = 0x0A
    SET_PWM_MINIMUM = 0x0B
    SET_PROPORTIONAL_GAIN = 0x0C
    SET_DERIVATIVE_GAIN = 0x0D
    SET_AVERAGE_RC = 0x0E
    SET_AVERAGE_ADC = 0x0F
    GET_FEEDBACK = 0x10
    SET_POSITION = 0x20
    SET_SPEED = 0x21
    DISABLE_MANUAL = 0x30
    RESET = 0xFF


ANSWERED_WITH_POSITION = frozenset({Code.SET_POSITION, Code.GET_FEEDBACK})
GUARDED = frozenset({Code.DISABLE_MANUAL, Code.RESET})
"""Commands that write the board's EEPROM or throw its settings away."""


def packet(code: Code, value: int = 0) -> bytes:
    """Give the 3 bytes of a command.

    Raises
    ------
    ValueError
        `value` is outside 0 to 1023.
    """
    if not 0 <= value <= LARGEST:
        raise ValueError(f"{code.name} = {value}: allowed are 0 to {LARGEST}")
    return PACKET.pack(code, value)


def parse(data: bytes) -> tuple[int, int] | None:
    """Read code and value of a packet; None if it is not 3 bytes."""
    if len(data) != PACKET.size:
        return None
    code, value = PACKET.unpack(data)
    return int(code), int(value)


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
            data = bytes(self._device.read(ENDPOINT_IN, PACKET.size, self._timeout_ms))
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
        """Discard unread answers."""
        self._flush()

    def close(self) -> None:
        """Give the board back to the system."""
        import usb.util

        usb.util.dispose_resources(self._device)

    def _write(self, code: Code, value: int) -> None:
        self._device.write(ENDPOINT_OUT, packet(code, value), self._timeout_ms)

    def _checked(self, code: Code, value: int, data: bytes) -> int:
        answer = parse(data)
        good = answer is not None and answer[0] == code and answer[1] <= LARGEST
        if good and answer is not None and (code in ANSWERED_WITH_POSITION or answer[1] == value):
            return answer[1]
        self._flush()
        raise DeviceError(
            f"{WHERE}: {code.name} = {value} was answered with {data.hex(' ') or 'nothing'}; "
            f"expected {packet(code, value).hex(' ')}"
            + (" or another position" if code in ANSWERED_WITH_POSITION else "")
        )

    def _flush(self) -> None:
        import usb.core

        for _ in range(_MOST_STALE):
            try:
                self._device.read(ENDPOINT_IN, PACKET.size, _FLUSH_MS)
            except usb.core.USBError:
                return


def _find(serial: str | None, backend: IBackend | None) -> Any:
    import usb.core

    try:
        found = list(usb.core.find(find_all=True, idVendor=VENDOR, idProduct=PRODUCT, backend=backend))
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
