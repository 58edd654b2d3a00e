"""Reading a trial file: every record of every device as columns on one clock, and the trial as force over depth.

The rows of the trial table are the force sensor's own samples at their own time stamps; nothing is resampled and no
force is made up. Depth, which the actuator reports more slowly, is interpolated linearly between the two positions
around each force sample, and only where they are neighbours: over a gap in the positions, before the first and after
the last there is no row. Late, duplicate, saturated or faulty rows are left out and leave a gap in the table.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench_hw.devices.rdt import HARMLESS
from bench_hw.errors import TrialFileError
from bench_hw.tables import MINIMUM_ROWS, TrialTable
from bench_hw.tables.columns import LARGEST
from bench_hw.trial_file.encoding import (
    CAMERA,
    DEPTH,
    EVENTS,
    FORCE,
    NANOSECONDS,
    decode_depth,
    decode_event,
    decode_force,
    decode_frame,
    nanoseconds,
)
from bench_hw.trial_file.mcap_records import RawMessage
from bench_hw.trial_file.records import EventRecord, ForceRecord, PositionRecord, PressAxis, TrialHeader
from bench_hw.trial_file.scan import Scan, read_messages, scan_trial, trial_header
from bench_hw.trial_file.sequence import check_sequence, longest_allowed

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
    header = trial_header(scan)
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


def _depth_row(time: float, message: RawMessage) -> tuple[PositionRecord, int]:
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


def _depth_columns(rows: Sequence[tuple[PositionRecord, int]]) -> DepthColumns:
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


def read_trial_mcap(path: Path | str) -> TrialTable:
    """Read a native trial file.

    Parameters
    ----------
    path : path-like
        A trial that was closed well, or the result of `recover`.

    Returns
    -------
    TrialTable
        One row per usable force sample: `time` s since the trial's start, `depth` m, `force` N along the file's
        press axis, positive when pressing; the six raw components as extras `force_x` (N) to `torque_z` (N m),
        in the sensor's axes.

    Raises
    ------
    TrialFileError
        The file cannot be read, is damaged or cut, lacks its metadata, has fewer than 20 usable rows, or larger values
        than a bench measures.
    """
    contents = read_contents(Path(path), (FORCE.topic, DEPTH.topic))
    if not contents.scan.whole:
        recover = f"python -m bench_hw recover {shlex.quote(str(path))} --out NEW.mcap"
        problem = (
            f"the trial is damaged or cut ({contents.scan.damages[0]}); save what is whole and read that: {recover}"
        )
        raise TrialFileError(contents.scan.path, problem)
    table = trial_rows(contents)
    if len(table.time) < MINIMUM_ROWS:
        problem = f"the trial has {len(table.time)} rows with force and depth; allowed: at least {MINIMUM_ROWS}"
        raise TrialFileError(contents.scan.path, problem)
    for name, values, unit in (("time", table.time, "s"), ("depth", table.depth, "m"), ("force", table.force, "N")):
        if not np.abs(values).max() <= LARGEST[unit]:
            problem = f"{name} reaches {np.abs(values).max():g} {unit}; allowed: at most {LARGEST[unit]:g} {unit}"
            raise TrialFileError(contents.scan.path, problem)
    return table


@dataclass(frozen=True, slots=True)
class Ending:
    """How a recording ended.

    Parameters
    ----------
    fault : str
        What ended it before its protocol was over, with kind and time; empty where nothing did.
    recovered : str
        What the recording had lost that this file was recovered from; empty where it is the recording itself.
    """

    fault: str
    recovered: str


def ending_of_trial(path: Path) -> Ending:
    """Say whether a native trial came to its end.

    Raises
    ------
    TrialFileError
        As `read_contents`.
    """
    contents = read_contents(path, (EVENTS.topic,))
    faults = [
        f"{event.kind} at {event.time:.3f} s: {event.message}" for event in contents.events if event.level == "fault"
    ]
    return Ending("; ".join(faults), (contents.scan.recovery or {}).get("reason", ""))


def trial_rows(contents: TrialContents, press_axis: PressAxis | None = None) -> TrialTable:
    """Join force and depth of a trial; as `read_trial_mcap`, for any number of rows of any file.

    Parameters
    ----------
    contents : TrialContents
        What the file holds.
    press_axis : str, optional
        Instead of the file's own.

    Raises
    ------
    TrialFileError
        No press axis given and the file's own is lost.
    """
    axis = press_axis or (contents.header.press_axis if contents.header else None)
    if axis is None:
        problem = "no copy of the metadata is whole, so the press axis is not known; give it"
        raise TrialFileError(contents.scan.path, problem)
    force = contents.force
    rows = np.flatnonzero(usable_rows(force))
    depth, between = _depth_at(contents.depth, force.time[rows])
    rows, depth = rows[between], depth[between]
    names = [f"{kind}_{axis_name}" for kind in ("force", "torque") for axis_name in "xyz"]
    components = np.hstack([force.force, force.torque])[rows].T
    return TrialTable(
        time=force.time[rows],
        depth=depth,
        force=press_force(force, axis)[rows],
        extra=dict(zip(names, components, strict=True)),
        source=str(contents.scan.path),
        extra_units={name: "N" if name.startswith("force") else "Nm" for name in names},
        readings=_readings(contents.depth),
    )


def press_force(force: ForceColumns, axis: PressAxis) -> FloatArray:
    """Give the force along a press axis, N, positive when pressing, shape (n,)."""
    component = force.force[:, "xyz".index(axis[1])]
    return component if axis[0] == "+" else -component


def usable_rows(force: ForceColumns) -> NDArray[np.bool_]:
    """Say which samples are measurements: in order, healthy, finite, later than every one before; shape (n,)."""
    finite = np.isfinite(force.force).all(axis=1) & np.isfinite(force.torque).all(axis=1)
    healthy = np.isin(force.status, HARMLESS)
    usable = check_sequence(force.rdt_sequence, force.ft_sequence).in_order & finite & healthy
    return _and_later(usable, force.time)


def _and_later(good: NDArray[np.bool_], time: FloatArray) -> NDArray[np.bool_]:
    """Keep of the good rows those that are later than every good row before."""
    kept = good.copy()
    kept[good] = time[good] > np.concatenate([[-np.inf], np.maximum.accumulate(time[good])])[:-1]
    return kept


def _readings(depth: DepthColumns) -> tuple[FloatArray, FloatArray]:
    """Times and depths of the usable readings."""
    good = _and_later(np.isfinite(depth.depth), depth.time)
    return depth.time[good], depth.depth[good]


def _depth_at(depth: DepthColumns, time: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Interpolate depth; the second array says where there are neighbours to do so between."""
    at, value = _readings(depth)
    if len(at) < 2:
        return np.full(len(time), np.nan), np.zeros(len(time), dtype=bool)
    after = np.clip(np.searchsorted(at, time, side="left"), 1, len(at) - 1)
    inside = (time >= at[after - 1]) & (time <= at[after])
    neighbours = at[after] - at[after - 1] <= longest_allowed(at)
    measured = (time == at[after - 1]) | (time == at[after])
    return np.interp(time, at, value), inside & (neighbours | measured)
