"""From what the drivers give to the records of a trial file."""

from __future__ import annotations

from collections.abc import Iterable

from bench_hw.devices.protocols import ForceBlock, Frame
from bench_hw.trial_file.records import DepthRecord, EventRecord, ForceRecord, FrameRecord, Level, TrialWriter


class Recorder:
    """Writes one trial.

    Parameters
    ----------
    writer : TrialWriter
        The trial's file.
    zero : float
        Position of the actuator that is depth zero, m.
    """

    def __init__(self, writer: TrialWriter, zero: float) -> None:
        self._writer, self._zero = writer, zero

    def force(self, block: ForceBlock) -> None:
        """Write each sample of a block."""
        counts = [None] * len(block) if block.counts is None else block.counts.tolist()
        rows = zip(
            block.time.tolist(),
            block.rdt_sequence.tolist(),
            block.ft_sequence.tolist(),
            block.status.tolist(),
            block.wrench.tolist(),
            counts,
            strict=True,
        )
        for time, rdt, ft, status, wrench, raw in rows:
            self._writer.write_force(
                ForceRecord(
                    time,
                    rdt,
                    ft,
                    status,
                    tuple(wrench[:3]),
                    tuple(wrench[3:]),
                    None if raw is None else tuple(raw),
                )
            )

    def position(self, time: float, position: float, counts: int | None, target: float | None) -> None:
        """Write one position of the actuator (m) and where it was sent."""
        depth_of_target = None if target is None else target - self._zero
        self._writer.write_depth(DepthRecord(time, position - self._zero, counts, depth_of_target))

    def frames(self, frames: Iterable[Frame]) -> None:
        """Write pictures."""
        for frame in frames:
            self._writer.write_frame(FrameRecord(frame.time, frame.number, frame.data, frame.format))

    def event(self, time: float, kind: str, message: str, level: Level = "info") -> None:
        """Write something that happened."""
        self._writer.write_event(EventRecord(time, kind, message, level))
