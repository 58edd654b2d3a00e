"""The bytes of the Actuonix LAC board (USB): 3-byte packets `<BH` of a code and a value from 0 to 1023.

Every command is echoed, except that `SET_POSITION` and `GET_FEEDBACK` are answered with the present position
in the value. Source: Actuonix, "USB Control and Configuration of the LAC".
"""

from __future__ import annotations

import struct
from enum import IntEnum

VENDOR = 0x04D8
PRODUCT = 0xFC5F
ENDPOINT_OUT = 0x01
ENDPOINT_IN = 0x81
PACKET = struct.Struct("<BH")
LARGEST = 1023
"""Largest value of any command."""
COUNTS = 1024
"""Counts over the full stroke: one count is stroke / 1024."""


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
