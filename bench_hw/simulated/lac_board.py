"""The simulated LAC board: its firmware (a packet in, a packet out, an actuator that obeys) and its USB plug.

`LacUsbBackend` is a pyusb backend, so that the whole driver runs without libusb: give it to `LacActuator(backend=...)`
or to `usb.core.find(backend=...)`. Faults are switched on its attributes.
"""

from __future__ import annotations

import array
import errno
from collections import deque
from types import SimpleNamespace
from typing import Any

import usb.core
from usb.backend import IBackend

from bench_hw.clock import Clock
from bench_hw.devices.lac_usb import COUNTS, ENDPOINT_IN, ENDPOINT_OUT, LARGEST, PRODUCT, VENDOR, Code, packet, parse
from bench_hw.simulated.virtual_bench import VirtualBench

FACTORY = {
    Code.SET_ACCURACY: 4,
    Code.SET_RETRACT_LIMIT: 0,
    Code.SET_EXTEND_LIMIT: LARGEST,
    Code.SET_SPEED: LARGEST,
}
"""Settings at power-on and after RESET."""
_GET_DESCRIPTOR = 0x06
_STRING = 0x03
_LANGUAGE = 0x0409
_SERIAL_INDEX = 3
_TIMEOUT, _NO_DEVICE = -7, -4
KEPT = 1000
"""Packets that a board remembers for who looks at it."""


class LacBoard:
    """A board with an actuator on it.

    Parameters
    ----------
    bench : VirtualBench
        What its actuator moves.
    clock : Clock
        Its clock.
    max_speed : float
        Speed of the actuator at the largest speed value, m/s.
    """

    def __init__(self, bench: VirtualBench, clock: Clock, max_speed: float = 0.020) -> None:
        self._bench, self._clock, self._max_speed = bench, clock, max_speed
        bench.motion.resolution = bench.motion.stroke / COUNTS
        self.settings: dict[Code, int] = {}
        self.eeprom_writes = 0
        self.received: deque[bytes] = deque(maxlen=KEPT)
        self._restore()

    @property
    def target(self) -> float:
        """Where the actuator was last sent, m."""
        with self._bench.lock:
            return self._bench.motion.target

    def handle(self, data: bytes) -> bytes | None:
        """Obey one packet and give the answer; None for bytes that are no command."""
        self.received.append(data)
        command = parse(data)
        if command is None or command[0] not in set(Code) or command[1] > LARGEST:
            return None
        code, value = Code(command[0]), command[1]
        with self._bench.lock:
            self._bench.advance(self._clock.now())
            if code is Code.GET_FEEDBACK:
                return packet(code, self._feedback())
            if code is Code.SET_POSITION:
                self._send_to(value)
                return packet(code, self._feedback())
            self._set(code, value)
        return packet(code, value)

    def _set(self, code: Code, value: int) -> None:
        if code is Code.RESET:
            self._restore()
        elif code is Code.DISABLE_MANUAL:
            self.eeprom_writes += 1
        else:
            self.settings[code] = value
            self._apply()

    def _restore(self) -> None:
        self.settings = dict(FACTORY)
        self._apply()

    def _apply(self) -> None:
        motion = self._bench.motion
        motion.speed = self.settings[Code.SET_SPEED] / LARGEST * self._max_speed
        motion.dead_band = self.settings[Code.SET_ACCURACY] * motion.stroke / COUNTS

    def _send_to(self, value: int) -> None:
        low, high = self.settings[Code.SET_RETRACT_LIMIT], self.settings[Code.SET_EXTEND_LIMIT]
        self._bench.motion.target = min(max(value, low), high) * self._bench.motion.stroke / COUNTS

    def _feedback(self) -> int:
        motion = self._bench.motion
        return min(LARGEST, max(0, round(motion.reading() / motion.stroke * COUNTS)))


# ruff: noqa: ARG002 - the signatures are pyusb's


class LacUsbBackend(IBackend):  # type: ignore[misc]
    """USB with one simulated board on it.

    Parameters
    ----------
    board : LacBoard
        The board behind the plug.
    serial : str
        Its USB serial number.

    Attributes
    ----------
    unplugged : bool
        While true there is no such device.
    lost_answers : int
        How many of the next answers are lost, so that reading them times out.
    wrong_echo : bool
        While true, answers carry another code.
    """

    def __init__(self, board: LacBoard, serial: str = "LAC00001") -> None:
        super().__init__()
        self._board, self._serial = board, serial
        self._answers: deque[bytes] = deque()
        self.unplugged = False
        self.lost_answers = 0
        self.wrong_echo = False

    def enumerate_devices(self) -> list[str]:
        """List the board while it is plugged in."""
        return [] if self.unplugged else ["lac"]

    def get_device_descriptor(self, dev: Any) -> SimpleNamespace:
        """Describe the device."""
        return SimpleNamespace(
            bLength=18, bDescriptorType=1, bcdUSB=0x0200, bDeviceClass=0, bDeviceSubClass=0, bDeviceProtocol=0,
            bMaxPacketSize0=8, idVendor=VENDOR, idProduct=PRODUCT, bcdDevice=0x0001, iManufacturer=1, iProduct=2,
            iSerialNumber=_SERIAL_INDEX, bNumConfigurations=1, address=1, bus=1, port_number=1, port_numbers=(1,),
            speed=2,
        )  # fmt: skip

    def get_configuration_descriptor(self, dev: Any, config: int) -> SimpleNamespace:
        """Describe its one configuration."""
        _only(config)
        return SimpleNamespace(
            bLength=9, bDescriptorType=2, wTotalLength=32, bNumInterfaces=1, bConfigurationValue=1,
            iConfiguration=0, bmAttributes=0x80, bMaxPower=50, extra_descriptors=[],
        )  # fmt: skip

    def get_interface_descriptor(self, dev: Any, intf: int, alt: int, config: int) -> SimpleNamespace:
        """Describe its one interface."""
        _only(intf, alt, config)
        return SimpleNamespace(
            bLength=9, bDescriptorType=4, bInterfaceNumber=0, bAlternateSetting=0, bNumEndpoints=2,
            bInterfaceClass=0xFF, bInterfaceSubClass=0, bInterfaceProtocol=0, iInterface=0, extra_descriptors=[],
        )  # fmt: skip

    def get_endpoint_descriptor(self, dev: Any, ep: int, intf: int, alt: int, config: int) -> SimpleNamespace:
        """Describe its two bulk endpoints."""
        _only(intf, alt, config)
        return SimpleNamespace(
            bLength=7, bDescriptorType=5, bEndpointAddress=(ENDPOINT_OUT, ENDPOINT_IN)[ep], bmAttributes=2,
            wMaxPacketSize=64, bInterval=1, bRefresh=0, bSynchAddress=0, extra_descriptors=[],
        )  # fmt: skip

    def open_device(self, dev: Any) -> Any:
        """Open it."""
        self._check_plug()
        self._answers.clear()
        return dev

    def close_device(self, dev_handle: Any) -> None:
        """Close it."""

    def set_configuration(self, dev_handle: Any, config_value: int) -> None:
        """Take its one configuration."""
        self._check_plug()

    def get_configuration(self, dev_handle: Any) -> int:
        """Give its one configuration."""
        self._check_plug()
        return 1

    def claim_interface(self, dev_handle: Any, intf: int) -> None:
        """Claim its one interface."""
        self._check_plug()

    def release_interface(self, dev_handle: Any, intf: int) -> None:
        """Release it."""

    def bulk_write(self, dev_handle: Any, ep: int, intf: int, data: Any, timeout: int) -> int:
        """Hand one packet to the board."""
        self._check_plug()
        answer = self._board.handle(bytes(data))
        if answer is not None and self.lost_answers > 0:
            self.lost_answers -= 1
        elif answer is not None:
            self._answers.append(bytes([answer[0] ^ 0x40]) + answer[1:] if self.wrong_echo else answer)
        return len(data)

    def bulk_read(self, dev_handle: Any, ep: int, intf: int, buff: Any, timeout: int) -> int:
        """Take the board's next answer, or time out at once."""
        self._check_plug()
        if not self._answers:
            raise usb.core.USBTimeoutError("Operation timed out", _TIMEOUT, errno.ETIMEDOUT)
        answer = self._answers.popleft()
        buff[: len(answer)] = array.array("B", answer)
        return len(answer)

    def ctrl_transfer(
        self,
        dev_handle: Any,
        bmRequestType: int,
        bRequest: int,
        wValue: int,
        wIndex: int,
        data: Any,
        timeout: int,
    ) -> int:
        """Answer requests for string descriptors."""
        self._check_plug()
        if bRequest != _GET_DESCRIPTOR or wValue >> 8 != _STRING:
            raise usb.core.USBError("Pipe error", -9, errno.EPIPE)
        text = _LANGUAGE.to_bytes(2, "little") if wValue & 0xFF == 0 else self._text(wValue & 0xFF)
        answer = bytes([len(text) + 2, _STRING]) + text
        data[: len(answer)] = array.array("B", answer)
        return len(answer)

    def _text(self, index: int) -> bytes:
        return {1: "Simulated", 2: "LAC", _SERIAL_INDEX: self._serial}.get(index, "").encode("utf-16-le")

    def _check_plug(self) -> None:
        if self.unplugged:
            raise usb.core.USBError("No such device (it may have been disconnected)", _NO_DEVICE, errno.ENODEV)


def _only(*indices: int) -> None:
    """Refuse any index but 0, which is how pyusb finds the end of its lists."""
    if any(indices):
        raise IndexError(indices)
