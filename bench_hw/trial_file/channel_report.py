"""The figures of one channel of a recording: rate, jitter, gaps, losses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from bench_hw.trial_file.intervals import SHORTEST_GAP, longest_allowed, usual_interval
from bench_hw.trial_file.sequence import check_sequence

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


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
        Standard deviation of the intervals between neighbours, s.
    longest_interval : float or None
        s.
    lost : int
        Records that never came between the first and the last row.
    gaps : int
        Places where records are lost, or where none came for longer than 1.5 periods (and 50 ms, but for the
        camera).
    reordered, duplicates, restarts : int
        Records that came late, came twice; places where the device began to count anew.
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
        jitter=float(interval[neighbours].std()) if neighbours.any() else None,
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
