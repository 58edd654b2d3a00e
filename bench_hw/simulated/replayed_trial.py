"""A recorded trial replayed as a bench: its force sensor, actuator and camera give again what they gave.

`Replay` is the record and its place in time; the drivers beside it have the faces of `devices.protocols`. From
`rewind` on every sample comes when it came in the record, with the numbers it had: lost packets, dropped frames,
saturation, silence and jitter are those of the record. The tool does not obey then; it goes where it went, until it is
told to retract. Before and after the record the sensor stands at its first sample, and the tool goes where it is sent.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench_hw.clock import Clock
from bench_hw.devices.protocols import CameraFrame, CameraHealth, Connection, DeviceInfo, ForceBlock, StreamHealth
from bench_hw.devices.rdt import MODULUS, SequenceTracker
from bench_hw.errors import DeviceError
from bench_hw.trial_file.encoding import (
    CAMERA,
    DEPTH,
    FORCE,
    NANOSECONDS,
    decode_depth,
    decode_force,
    decode_frame,
    nanoseconds,
)
from bench_hw.trial_file.records import ForceRecord, FrameRecord, PositionRecord, TrialHeader
from bench_hw.trial_file.scan import Scan, read_messages, scan_trial, trial_header
from bench_hw.trial_file.sequence import usual_interval

MODEL = "replay of a recorded trial"
AFTER_END = 0.02
"""How long a capture may go on after the end of the record before the sensor says that it has ended, s."""
_BETWEEN = 1e-3
"""Two readings this near in time are one instant, s: the loop that replays turns no more often."""


@dataclass
class Replay:
    """A recorded trial and where in it the replay is.

    Parameters
    ----------
    path : pathlib.Path
        The trial, closed well or recovered.
    clock : Clock
        The clock on which it is replayed.

    Raises
    ------
    DeviceError
        The file has no readable metadata, force or depth.
    TrialFileError
        It cannot be read.
    """

    path: Path
    clock: Clock
    scan: Scan = field(init=False)
    header: TrialHeader = field(init=False)
    force: list[ForceRecord] = field(init=False)
    depth: list[PositionRecord] = field(init=False)
    began: float | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        self.scan = scan_trial(self.path)
        header = trial_header(self.scan)
        if header is None:
            raise DeviceError(f"{self.path}: its metadata are lost, so it cannot be replayed; give another trial")
        self.header = header
        self.force = [decode_force(time, data) for time, data in self._messages(FORCE.topic)]
        self.depth = [decode_depth(time, data) for time, data in self._messages(DEPTH.topic)]
        for name, rows in (("force", self.force), ("depth", self.depth)):
            if len(rows) < 2:
                raise DeviceError(f"{self.path}: {len(rows)} samples of {name}; a replay needs 2 or more")

    @property
    def zero(self) -> float:
        """Position of the actuator that was depth zero, m; 0 where the file does not say."""
        text = self.header.settings.get("depth_zero", "0 mm").removesuffix("mm")
        return float(text) * 1e-3

    @property
    def end(self) -> float:
        """Time of the last sample of force or depth, s since the trial's start."""
        return max(self.force[-1].time, self.depth[-1].time)

    def rewind(self, now: float) -> None:
        """Begin at the record's beginning; `now` (s of the clock) is its time zero."""
        self.began = now

    def time(self) -> float | None:
        """Time in the record, s; None before the first `rewind`."""
        return None if self.began is None else self.clock.now() - self.began + 1e-9

    def frames(self) -> Iterator[FrameRecord]:
        """Go through the pictures, in the file's order; one is in memory at a time."""
        return (decode_frame(time, data) for time, data in self._messages(CAMERA.topic))

    def info(self, device: str) -> DeviceInfo:
        """What a replayed device says of itself: which record it is, and the serial number it had there."""
        settings = {"replayed": self.path.name, "recorded": self.header.started}
        return DeviceInfo(MODEL, self.header.serials.get(device, ""), settings=settings)

    def _messages(self, topic: str) -> Iterator[tuple[float, bytes]]:
        epoch = nanoseconds(self.header.clock_epoch)
        for message in read_messages(self.scan, (topic,)):
            yield (message.time - epoch) / NANOSECONDS, message.data


class ReplayedForce(Connection):
    """The record's force sensor."""

    def __init__(self, replay: Replay) -> None:
        self._replay = replay
        self._time = np.array([record.time for record in replay.force])
        self._block = _block_of(replay.force)
        self._began: float | None = None
        self._next = self._idle = 0
        self._tracker = SequenceTracker()

    @property
    def info(self) -> DeviceInfo:
        """The record, and the serial number of its sensor."""
        return self._replay.info("force")

    @property
    def rate(self) -> float:
        """Samples per second as most of them came, Hz."""
        return 1.0 / usual_interval(self._time)

    @property
    def latency(self) -> float:
        """Time between two samples, s."""
        return usual_interval(self._time)

    @property
    def ranges(self) -> NDArray[np.float64]:
        """Unknown: a record does not hold them."""
        return np.full(6, np.nan)

    @property
    def health(self) -> StreamHealth:
        """What the record's own numbers say was lost, so far."""
        return self._tracker.health

    def connect(self) -> None:
        """Nothing is behind it."""

    def close(self) -> None:
        """Nothing is behind it."""

    def start(self) -> None:
        """Stand at the first sample until the record begins."""

    def stop(self) -> None:
        """Nothing streams."""

    def bias(self) -> None:
        """The record was zeroed, or not, when it was made."""

    def read(self) -> ForceBlock:
        """Give the samples whose time has come.

        Raises
        ------
        DeviceError
            The record has ended.
        """
        replay, now = self._replay, self._replay.time()
        if now is None:
            return self._standing()
        if self._began != replay.began:
            self._began, self._next, self._tracker = replay.began, 0, SequenceTracker()
        first, self._next = self._next, int(np.searchsorted(self._time, now, side="right"))
        if now > replay.end + AFTER_END:
            raise DeviceError(f"the record {replay.path.name} ends at {replay.end:.2f} s, and the protocol goes on")
        assert replay.began is not None
        block = _rows(self._block, slice(first, self._next), replay.began)
        self._tracker.accept(block.rdt_sequence, block.ft_sequence)
        return block

    def _standing(self) -> ForceBlock:
        """One sample now, as the first was."""
        self._idle += 1
        first, number = _rows(self._block, slice(0, 1), 0.0), np.array([self._idle % MODULUS], np.uint32)
        return ForceBlock(np.array([self._replay.clock.now()]), first.wrench, number, number, np.zeros(1, np.uint32))


def _block_of(records: list[ForceRecord]) -> ForceBlock:
    counted = all(record.counts is not None for record in records)
    return ForceBlock(
        np.array([record.time for record in records]),
        np.array([record.force + record.torque for record in records]),
        np.array([record.rdt_sequence for record in records], np.uint32),
        np.array([record.ft_sequence for record in records], np.uint32),
        np.array([record.status for record in records], np.uint32),
        np.array([record.counts for record in records], np.int32) if counted else None,
    )


def _rows(block: ForceBlock, rows: slice, began: float) -> ForceBlock:
    counts = None if block.counts is None else block.counts[rows]
    return ForceBlock(
        block.time[rows] + began,
        block.wrench[rows],
        block.rdt_sequence[rows],
        block.ft_sequence[rows],
        block.status[rows],
        counts,
    )


class ReplayedActuator(Connection):
    """The record's actuator; `uncertainty` (m) and `max_speed` (m/s) are the rig's."""

    def __init__(self, replay: Replay, uncertainty: float, max_speed: float) -> None:
        self._replay, self.uncertainty, self._max_speed = replay, uncertainty, max_speed
        self._time = np.array([record.time for record in replay.depth])
        self._low = 0.0
        self._obeys: float | None = None
        self._counts: int | None = None
        start = replay.depth[0].depth + replay.zero
        self._way = (replay.clock.now(), start, start, max_speed)

    @property
    def info(self) -> DeviceInfo:
        """The record, and the serial number of its board."""
        return self._replay.info("actuator")

    @property
    def counts(self) -> int | None:
        """The board's own reading in the record; None outside it."""
        return self._counts

    def connect(self) -> None:
        """Nothing is behind it."""

    def close(self) -> None:
        """Nothing is behind it."""

    def set_limits(self, low: float, high: float) -> tuple[float, float]:
        """Keep the lower limit (m), to which `retract` goes."""
        self._low = low
        return low, high

    def position(self) -> float:
        """Position in the record, m, as it was last read there; outside it, on the way to where it was sent."""
        now = self._in_record()
        if now is None:
            self._counts = None
            return self._on_the_way()
        row = max(0, int(np.searchsorted(self._time, now + _BETWEEN, side="right")) - 1)
        record = self._replay.depth[row]
        self._counts = record.counts
        return record.depth + self._replay.zero

    def move_to(self, position: float, speed: float) -> None:
        """Go to `position` (m) at `speed` (m/s) before the record begins; while it is replayed, go where it went."""
        if self._in_record() is None:
            self._way = (self._replay.clock.now(), self._on_the_way(), position, speed)

    def halt(self) -> None:
        """Stand, outside the record."""
        if self._in_record() is None:
            here = self._on_the_way()
            self._way = (self._replay.clock.now(), here, here, self._max_speed)

    def retract(self) -> None:
        """Leave the record and go to the lower limit at full speed."""
        here = self.position()
        self._obeys = self._replay.began
        self._way = (self._replay.clock.now(), here, self._low, self._max_speed)

    def _in_record(self) -> float | None:
        """Time in the record, s; None outside it or once the tool was sent back."""
        return None if self._obeys == self._replay.began else self._replay.time()

    def _on_the_way(self) -> float:
        began, start, target, speed = self._way
        gone = speed * (self._replay.clock.now() - began)
        return start + float(np.clip(target - start, -gone, gone))


class ReplayedCamera(Connection):
    """The record's camera; `rate` (Hz) is the rig's."""

    def __init__(self, replay: Replay, rate: float) -> None:
        self._replay, self.rate = replay, rate
        self._began: float | None = None
        self._first: FrameRecord | None = None
        self._coming: Iterator[FrameRecord] = iter(())
        self._ahead: FrameRecord | None = None
        self._last = -1
        self._shown = -np.inf
        self.health = CameraHealth()

    @property
    def info(self) -> DeviceInfo:
        """The record, and the serial number of its camera."""
        return self._replay.info("camera")

    def connect(self) -> None:
        """See that there are pictures.

        Raises
        ------
        DeviceError
            The record has none.
        """
        self._first = next(self._replay.frames(), None)
        if self._first is None:
            raise DeviceError(f"camera: {self._replay.path} has no pictures; leave [camera] out of the rig")

    def close(self) -> None:
        """Nothing is behind it."""

    def start(self) -> None:
        """Stand at the first picture until the record begins."""

    def stop(self) -> None:
        """Nothing streams."""

    def read(self) -> list[CameraFrame]:
        """Give the pictures whose time has come, with the numbers they had."""
        now = self._replay.time()
        if now is None:
            return self._standing()
        if self._began != self._replay.began:
            self._began, self._coming, self.health, self._last = (
                self._replay.began,
                self._replay.frames(),
                CameraHealth(),
                -1,
            )
            self._ahead = next(self._coming, None)
        taken = []
        while self._ahead is not None and self._ahead.time <= now:
            taken.append(self._counted(self._ahead))
            self._ahead = next(self._coming, None)
        return taken

    def _counted(self, record: FrameRecord) -> CameraFrame:
        assert self._began is not None
        dropped = max(0, record.frame - self._last - 1) if self._last >= 0 else 0
        self._last = record.frame
        self.health = CameraHealth(self.health.received + 1, self.health.dropped + dropped)
        return CameraFrame(self._began + record.time, record.frame, record.data, record.format)

    def _standing(self) -> list[CameraFrame]:
        now, first = self._replay.clock.now(), self._first
        if first is None or now - self._shown < 1.0 / self.rate:
            return []
        self._shown = now
        return [CameraFrame(now, first.frame, first.data, first.format)]
