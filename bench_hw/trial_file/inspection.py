"""How good a recording is: rate, jitter, gaps and losses of each channel, and everything that went wrong in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench_hw.devices.rdt import HARMLESS, Status, describe
from bench_hw.trial_file.reading import TrialContents, read_contents, trial_rows
from bench_hw.trial_file.sequence import SHORTEST_GAP, check_sequence, longest_allowed, usual_interval

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
SCHEMA = 1
DRIFT_WINDOW = 0.5
"""Time at the start and at the end of a trial over which the force is compared, s."""
DRIFT_ROWS = 10
"""Fewest rows at either end from which a drift is told."""
SAME_DEPTH = 0.2e-3
"""Depths at start and end that are this close (m) count as the same: the actuator's own accuracy."""
STAMP_DIGITS = 9
"""Decimals of a time stamp in s, which a file holds in whole nanoseconds: a scatter below them is rounding."""


@dataclass(frozen=True)
class ChannelReport:
    """One channel's figures.

    Parameters
    ----------
    rows : int
        Records in the file.
    first_time, last_time : float or None
        s since the trial's start.
    rate : float or None
        Records per second as the device sent them, lost ones included, Hz.
    jitter : float or None
        Standard deviation of the intervals between neighbours, s; 0 where it is below the stamps' nanosecond.
    longest_interval : float or None
        s.
    lost : int
        Records that never came between the first and the last row.
    gaps : int
        Places where records are lost, or where none came for longer than 1.5 periods (and 50 ms, but for the
        camera).
    reordered, duplicates, restarts : int
        Late records, duplicates, and restarts of the device's counter.
    details : Mapping[str, int | float | None]
        What only this kind of channel has, under names with units.
    """

    rows: int
    first_time: float | None
    last_time: float | None
    rate: float | None
    jitter: float | None
    longest_interval: float | None
    lost: int
    gaps: int
    reordered: int
    duplicates: int
    restarts: int
    details: Mapping[str, int | float | None] = field(default_factory=dict)

    def to_dict(self) -> dict[str, int | float | None]:
        """Give the figures as they stand in the JSON of `inspect`."""
        return {
            "rows": self.rows,
            "first_time_s": self.first_time,
            "last_time_s": self.last_time,
            "rate_hz": self.rate,
            "lost": self.lost,
            "gaps": self.gaps,
            "reordered": self.reordered,
            "duplicates": self.duplicates,
            "restarts": self.restarts,
            "jitter_ms": None if self.jitter is None else self.jitter * 1e3,
            "longest_interval_s": self.longest_interval,
            **self.details,
        }


def report_channel(
    time: FloatArray,
    numbers: IntArray,
    *,
    samples: IntArray | None = None,
    camera: bool = False,
    details: Mapping[str, int | float | None] | None = None,
) -> ChannelReport:
    """Judge a channel by its time stamps and its sequence numbers.

    Parameters
    ----------
    time : ndarray, shape (n,)
        s, in the order of arrival.
    numbers : ndarray of int, shape (n,)
        Sequence numbers, modulo 2^32.
    samples : ndarray of int, shape (n,), optional
        The device's own count of its samples, modulo 2^32.
    camera : bool
        A camera may drop frames without saying so: an interval over 1.5 periods without a number skipped is
        then frames lost, as many as would have fitted in. A frame that only came late, so that the next one
        follows sooner, is not lost.
    details : Mapping, optional
        Further figures to carry along.
    """
    if not len(time):
        return ChannelReport(0, None, None, None, None, None, 0, 0, 0, 0, 0, details or {})
    check = check_sequence(numbers, samples)
    ordered = time[check.in_order]
    step = _steps(numbers[check.in_order])
    interval = np.diff(ordered)
    neighbours = step == 1
    long = neighbours & (interval > longest_allowed(ordered, 0.0 if camera else SHORTEST_GAP))
    unseen = _unseen(interval, long, usual_interval(ordered)) if camera else np.zeros(len(interval))
    if camera:
        long &= unseen > 0
    return ChannelReport(
        rows=len(time),
        first_time=float(time.min()),
        last_time=float(time.max()),
        rate=_rate(ordered, step),
        jitter=round(float(interval[neighbours].std()), STAMP_DIGITS) if neighbours.any() else None,
        longest_interval=float(interval.max()) if len(interval) else None,
        lost=check.lost + int(unseen.sum()),
        gaps=check.gaps + int(long.sum()),
        reordered=check.reordered,
        duplicates=check.duplicates,
        restarts=check.restarts,
        details=details or {},
    )


def _unseen(interval: FloatArray, long: NDArray[np.bool_], usual: float) -> FloatArray:
    """Give the frames missing in each long interval (n,), judged together with the one that follows it."""
    pair = np.append(interval[:-1] + interval[1:] - usual, interval[-1:])
    return np.where(long, np.maximum(np.rint(pair / usual) - 1, 0), 0)


def _steps(numbers: IntArray) -> IntArray:
    """Give the steps between numbers in order; after a restart 1, as the true one is not known."""
    step: IntArray = np.diff(numbers) % 2**32
    return np.where(step < 2**31, step, 1)


def _rate(time: FloatArray, step: IntArray) -> float | None:
    span = float(time[-1] - time[0])
    return float(step.sum()) / span if span > 0.0 else None


@dataclass(frozen=True, eq=False)
class Inspection:
    """The verdict on a trial file.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    complete : bool
        Whether the file was closed well, nothing in it is damaged, and nothing was lost in a recovery before.
    channels : Mapping[str, ChannelReport]
        By name: `force`, `depth`, `camera`; those that have rows.
    faults : tuple of str
        One sentence each: damaged bytes, faults the capture noted, samples that are no measurements.
    trial : Mapping[str, Any]
        Name, start, protocol, serial numbers... empty where the metadata are lost.
    events : tuple of dict
        What the capture noted: `time_s`, `kind`, `level`, `message`.
    """

    path: Path
    complete: bool
    channels: Mapping[str, ChannelReport]
    faults: tuple[str, ...]
    trial: Mapping[str, Any]
    events: tuple[Mapping[str, Any], ...]

    def to_dict(self) -> dict[str, Any]:
        """Give the verdict as it stands in the JSON of `inspect`."""
        return {
            "schema": SCHEMA,
            "complete": self.complete,
            "channels": {name: report.to_dict() for name, report in self.channels.items()},
            "faults": list(self.faults),
            "trial": dict(self.trial),
            "events": [dict(event) for event in self.events],
        }


def inspect_trial(path: Path | str) -> Inspection:
    """Judge a trial file, also one that is cut or damaged.

    Raises
    ------
    TrialFileError
        The file cannot be read, or nothing in it is a trial.
    """
    contents = read_contents(Path(path))
    reports = {"force": _force(contents), "depth": _depth(contents), "camera": _camera(contents)}
    return Inspection(
        path=Path(path),
        complete=contents.scan.complete,
        channels={name: report for name, report in reports.items() if report.rows},
        faults=tuple(_faults(contents)),
        trial=_trial(contents),
        events=tuple(
            {"time_s": event.time, "kind": event.kind, "level": event.level, "message": event.message}
            for event in contents.events
        ),
    )


def _force(contents: TrialContents) -> ChannelReport:
    force = contents.force
    details = {
        "saturated": int(np.count_nonzero(force.status & Status.SATURATED)),
        "drift_N": force_drift(contents),
    }
    return report_channel(force.time, force.rdt_sequence, samples=force.ft_sequence, details=details)


def _depth(contents: TrialContents) -> ChannelReport:
    return report_channel(contents.depth.time, contents.depth.sequence)


def _camera(contents: TrialContents) -> ChannelReport:
    return report_channel(contents.camera.time, contents.camera.frame, camera=True)


def force_drift(contents: TrialContents) -> float | None:
    """Give how much the unloaded force moved during a trial, N along the press axis.

    The median over the end less that over the beginning: at most half a second of each, as long as the
    actuator stays within 0.2 mm of where it began. None where it did not come back there, or where there is
    too little to say.
    """
    if contents.header is None:
        return None
    table = trial_rows(contents)
    if not len(table.time) or table.time[-1] - table.time[0] < 2 * DRIFT_WINDOW:
        return None
    away = np.flatnonzero(np.abs(table.depth - table.depth[0]) > SAME_DEPTH)
    rows = np.arange(len(table.time))
    first = (table.time <= table.time[0] + DRIFT_WINDOW) & (rows < min(away, default=len(rows)))
    last = (table.time >= table.time[-1] - DRIFT_WINDOW) & (rows > max(away, default=-1))
    if min(first.sum(), last.sum()) < DRIFT_ROWS:
        return None
    return float(np.median(table.force[last]) - np.median(table.force[first]))


def _faults(contents: TrialContents) -> Iterator[str]:
    scan = contents.scan
    yield from map(str, scan.damages)
    if scan.recovery is not None:
        yield f"this file was recovered from one that had lost something: {scan.recovery.get('reason', '')}"
    if contents.header is None:
        yield "no copy of the trial's metadata is whole"
    yield from scan.losses()
    for event in contents.events:
        if event.level == "fault":
            yield f"{event.kind} at {event.time:.3f} s: {event.message}"
    yield from _sensor_faults(contents)


def _sensor_faults(contents: TrialContents) -> Iterator[str]:
    force = contents.force
    for status in np.unique(force.status[~np.isin(force.status, HARMLESS)]).tolist():
        rows = np.flatnonzero(force.status == status)
        first = force.time[rows[0]]
        yield f"force sensor: {describe(status)} in {len(rows)} rows, first at {first:.3f} s"


def _trial(contents: TrialContents) -> dict[str, Any]:
    header = contents.header
    if header is None:
        return {}
    return {
        "name": header.name,
        "started": header.started,
        "protocol": header.protocol,
        "press_axis": header.press_axis,
        "synthetic": header.synthetic,
        "serials": dict(header.serials),
        "calibrations": dict(header.calibrations),
        "settings": dict(header.settings),
    }
