"""What the status word of an RDT record means, and which of its bits a bench must stop for."""

from __future__ import annotations

from bench_hw.devices.netft_wire import Status

_BITS = {
    30: "CPU or RAM error",
    29: "digital board error",
    28: "analog board error",
    27: "serial link error",
    26: "program memory error",
    25: "halted by a configuration error",
    24: "settings not valid",
    23: "settings do not fit the calibration",
    22: "network failure",
    20: "RDT failure",
    17: "transducer saturated",
    16: "condition latched",
    1: "analog board watchdog",
    0: "excessive gauge current",
}
_HARMLESS = Status.ERROR | Status.LATCH


def is_fault(status: int) -> bool:
    """Tell whether a status word says more than "a threshold was crossed once"."""
    return bool(status & ~_HARMLESS)


def is_saturated(status: int) -> bool:
    """Tell whether the transducer was beyond its range, so that the record's force is too small."""
    return bool(status & Status.SATURATED)


def describe(status: int) -> str:
    """Say in words what a status word means."""
    named = [text for bit, text in _BITS.items() if status >> bit & 1]
    other = status & ~_HARMLESS & ~sum(1 << bit for bit in _BITS)
    return ", ".join(named + ([f"other bits {other:#x}"] if other else [])) or "healthy"
