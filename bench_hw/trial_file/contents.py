"""A trial file as columns: every record of every device, with its own time, on one clock."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import TrialFileError
from bench_hw.trial_file.encoding import (
    NANOSECONDS,
    decode_depth,
    decode_event,
    decode_force,
    decode_frame,
    nanoseconds,
)
from bench_hw.trial_file.messages import read_messages
from bench_hw.trial_file.metadata import read_header
from bench_hw.trial_file.parsing import RawMessage
from bench_hw.trial_file.records import DepthRecord, EventRecord, ForceRecord, TrialHeader
from bench_hw.trial_file.scan import Scan, scan_trial
from bench_hw.trial_file.schemas import CAMERA, DEPTH, EVENTS, FORCE

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

TOPICS = (FORCE.topic, DEPTH.topic, CAMERA.topic, EVENTS.topic)


@dataclass(frozen=True, eq=False)
class ForceColumns:
    """The force samples, shape (n,) or (n, 3); time in s since the trial's start, N and N m in sensor axes."""

    time: FloatArray
    rdt_sequence: IntArray
    ft_sequence: IntArray
    status: IntArray
    force: FloatArray
    torque: FloatArray


@dataclass(frozen=True, eq=False)
class DepthColumns:
    """The positions, shape (n,); s, m, NaN where there is no count or target; `sequence` is the file's."""

    time: FloatArray
    depth: FloatArray
    counts: FloatArray
    target: FloatArray
    sequence: IntArray


@dataclass(frozen=True, eq=False)
class CameraColumns:
    """The frames, shape (n,): time in s, number, size in bytes, and the name of the encoding."""

    time: FloatArray
    frame: IntArray
    size: IntArray
    format: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class TrialContents:
    """All that a trial file holds.

    Parameters
    ----------
    scan : Scan
        The state of the file.
    header : TrialHeader or None
        None where no copy of the metadata is whole; times are then the clock's own readings.
    force, depth, camera : ForceColumns, DepthColumns, CameraColumns
        Rows in the order in which they were recorded.
    events : tuple of EventRecord
        Times as in the columns.
    """

    scan: Scan
    header: TrialHeader | None
    force: ForceColumns
    depth: DepthColumns
    camera: CameraColumns
    events: tuple[EventRecord, ...]


def read_contents(path: Path, topics: Collection[str] = TOPICS) -> TrialContents:
    """Read whatever is whole in a trial file.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    topics : collection of str
        What to read; columns of other topics stay empty.

    Raises
    ------
    TrialFileError
        The file cannot be read, is no trial, or was written by another schema.
    """
    scan = scan_trial(path)
    header = _header(scan)
    epoch = 0 if header is None else nanoseconds(header.clock_epoch)
    rows: dict[str, list[Any]] = {topic: [] for topic in _DECODERS}
    for message in read_messages(scan, topics):
        topic = scan.channels[message.channel].topic
        rows[topic].append(_decoded(scan, topic, message, epoch))
    return TrialContents(
        scan,
        header,
        _force_columns(rows[FORCE.topic]),
        _depth_columns(rows[DEPTH.topic]),
        _camera_columns(rows[CAMERA.topic]),
        tuple(rows[EVENTS.topic]),
    )


def _header(scan: Scan) -> TrialHeader | None:
    if scan.header is None:
        return None
    try:
        return read_header(scan.header)
    except (ValueError, KeyError) as error:
        raise TrialFileError(scan.path, f"the trial's metadata cannot be read ({error})") from error


def _depth_row(time: float, message: RawMessage) -> tuple[DepthRecord, int]:
    return decode_depth(time, message.data), message.sequence


def _camera_row(time: float, message: RawMessage) -> tuple[float, int, int, str]:
    """Drop the picture itself: a long trial's pictures do not fit into memory."""
    frame = decode_frame(time, message.data)
    return frame.time, frame.frame, len(frame.data), frame.format


_DECODERS: Mapping[str, Callable[[float, RawMessage], Any]] = {
    FORCE.topic: lambda time, message: decode_force(time, message.data),
    DEPTH.topic: _depth_row,
    CAMERA.topic: _camera_row,
    EVENTS.topic: lambda time, message: decode_event(time, message.data),
}


def _decoded(scan: Scan, topic: str, message: RawMessage, epoch: int) -> Any:
    try:
        return _DECODERS[topic]((message.time - epoch) / NANOSECONDS, message)
    except (ValueError, KeyError, TypeError) as error:
        problem = f"message {message.sequence} of {topic} is none of this bench ({error!r})"
        raise TrialFileError(scan.path, problem) from error


def _force_columns(records: Sequence[ForceRecord]) -> ForceColumns:
    return ForceColumns(
        time=np.array([r.time for r in records], dtype=np.float64),
        rdt_sequence=np.array([r.rdt_sequence for r in records], dtype=np.int64),
        ft_sequence=np.array([r.ft_sequence for r in records], dtype=np.int64),
        status=np.array([r.status for r in records], dtype=np.int64),
        force=np.array([r.force for r in records], dtype=np.float64).reshape(-1, 3),
        torque=np.array([r.torque for r in records], dtype=np.float64).reshape(-1, 3),
    )


def _depth_columns(rows: Sequence[tuple[DepthRecord, int]]) -> DepthColumns:
    records = [record for record, _ in rows]
    return DepthColumns(
        time=np.array([r.time for r in records], dtype=np.float64),
        depth=np.array([r.depth for r in records], dtype=np.float64),
        counts=np.array([r.counts for r in records], dtype=np.float64),  # None becomes NaN
        target=np.array([r.target for r in records], dtype=np.float64),
        sequence=np.array([sequence for _, sequence in rows], dtype=np.int64),
    )


def _camera_columns(rows: Sequence[tuple[float, int, int, str]]) -> CameraColumns:
    return CameraColumns(
        time=np.array([time for time, _, _, _ in rows], dtype=np.float64),
        frame=np.array([frame for _, frame, _, _ in rows], dtype=np.int64),
        size=np.array([size for _, _, size, _ in rows], dtype=np.int64),
        format=tuple(name for _, _, _, name in rows),
    )
