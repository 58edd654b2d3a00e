"""What a trial file holds: one frozen dataclass per kind of record, and what a writer of them can do.

All times are seconds on the one monotonic clock of the capture, as each device's sample was stamped; the
file stores them relative to nothing (raw readings, in whole nanoseconds) together with the reading at the
start of the trial, `TrialHeader.clock_epoch`, which reading subtracts. The bytes of the file live in
`writer` and `encoding`, not here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Literal, Protocol, Self

Level = Literal["info", "warning", "fault"]
PressAxis = Literal["+x", "-x", "+y", "-y", "+z", "-z"]
Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class TrialHeader:
    """What is known before the first sample; written as the file's metadata.

    Parameters
    ----------
    name : str
        Name of the trial, for instance `trial_001`.
    started : str
        Wall-clock start, ISO 8601 with its offset (`2024-05-06T07:08:09.123456+00:00`).
    clock_epoch : float
        Reading of the capture's monotonic clock (s) at the start: time zero of everything read back.
    press_axis : str
        Axis and sign of the force sensor along which the tool presses: with `-z` the press force is -Fz.
    protocol : str
        Name of the protocol of motion.
    protocol_text : str
        The protocol itself (TOML), empty if there is none.
    serials : Mapping[str, str]
        Serial number by device (`force`, `actuator`, `camera`).
    calibrations : Mapping[str, str]
        Fingerprint (for instance a SHA-256) of the calibration by device.
    settings : Mapping[str, str]
        Anything else worth keeping, value and unit in the text (`{"force.rate": "1000 Hz"}`).
    synthetic : bool
        True if any of the devices was simulated.
    """

    name: str
    started: str
    clock_epoch: float
    press_axis: PressAxis = "-z"
    protocol: str = ""
    protocol_text: str = ""
    serials: Mapping[str, str] = field(default_factory=dict)
    calibrations: Mapping[str, str] = field(default_factory=dict)
    settings: Mapping[str, str] = field(default_factory=dict)
    synthetic: bool = False


@dataclass(frozen=True, slots=True)
class ForceRecord:
    """One sample of the force/torque sensor, as it came.

    Parameters
    ----------
    time : float
        Monotonic clock, s.
    rdt_sequence, ft_sequence : int
        The box's counters modulo 2^32. A DAQ counts its samples in both.
    status : int
        The box's status word; 0 healthy. A DAQ sets 0x80020000 where it is saturated.
    force : tuple of 3 floats
        Fx, Fy, Fz in the sensor's axes, N, bias already taken off if the rig says so.
    torque : tuple of 3 floats
        Tx, Ty, Tz in the sensor's axes, N m.
    counts : tuple of 6 ints, optional
        The raw Fx..Tz counts of the RDT record; None for a DAQ.
    """

    time: float
    rdt_sequence: int
    ft_sequence: int
    status: int
    force: Vector
    torque: Vector
    counts: tuple[int, int, int, int, int, int] | None = None


@dataclass(frozen=True, slots=True)
class PositionRecord:
    """One position of the actuator, as it reported it; a message of `/depth`.

    Parameters
    ----------
    time : float
        Monotonic clock, s.
    depth : float
        Position from where depth is zero, m, positive into the tissue.
    counts : int, optional
        The board's own reading, 0 to 1023.
    target : float, optional
        The position commanded at that time, m.
    """

    time: float
    depth: float
    counts: int | None = None
    target: float | None = None


@dataclass(frozen=True, slots=True)
class FrameRecord:
    """One picture of the camera, as the camera encoded it.

    Parameters
    ----------
    time : float
        Monotonic clock, s.
    frame : int
        Number of the frame since the camera was opened; a number that is skipped is a lost frame. A driver
        whose camera gives no numbers counts up and skips what it knows it has dropped.
    data : bytes
        The encoded picture.
    format : str
        `jpeg`, `png` or `webp`.
    """

    time: float
    frame: int
    data: bytes
    format: str = "jpeg"


@dataclass(frozen=True, slots=True)
class EventRecord:
    """Something that happened: a segment that began, a touch, a fault.

    Parameters
    ----------
    time : float
        Monotonic clock, s.
    kind : str
        A short name without spaces: `segment`, `touch`, `force_limit`, `force_stale`, `unplugged`...
    message : str
        One sentence with values and units.
    level : str
        `info`, `warning` or `fault`; a fault shows in `inspect`.
    """

    time: float
    kind: str
    message: str
    level: Level = "info"


class TrialWriter(Protocol):
    """Where a capture puts its records, in any order between the devices, from any thread.

    Every method raises `bench_hw.errors.TrialFileError` when the disk refuses; what was written until then
    stays in `NAME.mcap.part`. Leaving the context closes the file, whatever the reason for leaving.
    """

    @property
    def path(self) -> Path:
        """The file being written: `NAME.mcap.part` until `close`, then `NAME.mcap`."""
        ...

    def write_force(self, record: ForceRecord) -> None:
        """Take one force sample; never waits for the disk."""
        ...

    def write_position(self, record: PositionRecord) -> None:
        """Take one position; never waits for the disk."""
        ...

    def write_frame(self, record: FrameRecord) -> None:
        """Take one picture; never waits for the disk."""
        ...

    def write_event(self, record: EventRecord) -> None:
        """Take one event; never waits for the disk."""
        ...

    def close(self) -> Path:
        """Write the rest, end and sync the file, rename it to `NAME.mcap` and return that; twice is fine."""
        ...

    def __enter__(self) -> Self: ...

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None: ...
