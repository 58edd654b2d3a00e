"""What sequence numbers and time stamps say: records lost, late or duplicated, restarts, usual intervals and gaps.

The rule of the RDT protocol: the step from one number to the next, modulo 2^32, is 1 when all is well, 0 for a
duplicate, below 2^31 a gap, and otherwise backwards. A step backwards by more than `LATEST` numbers is no late
datagram but a restart of the counter; so is a step back to 1 or 0 whose sample is newer. The same rule counts the live
stream in `bench_hw.devices.rdt`; here it judges whole columns.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

IntArray = NDArray[np.int64]

MODULUS = 2**32
LATEST = 256
"""How many numbers back a record may come and still count as late."""
FloatArray = NDArray[np.float64]
GAP_PERIODS = 1.5
"""An interval longer than this many periods is a gap in the frames of a camera."""
SHORTEST_GAP = 0.05
"""No interval shorter than this (s) is called a gap in force or depth: it is how old force data may be."""


@dataclass(frozen=True, eq=False)
class SequenceCheck:
    """The verdict on a column of sequence numbers.

    Parameters
    ----------
    lost : int
        Numbers that never came, between the first and the last of each run.
    gaps : int
        Places at which numbers are missing.
    reordered : int
        Records that came after a later one.
    duplicates : int
        Records that came twice.
    restarts : int
        Restarts of the counter; what was lost there is unknown.
    in_order : ndarray of bool, shape (n,)
        Rows that are neither late nor duplicates.
    step : ndarray of int, shape (n,)
        Numbers since the row before; 1 where all is well, and in the first row.
    """

    lost: int
    gaps: int
    reordered: int
    duplicates: int
    restarts: int
    in_order: NDArray[np.bool_]
    step: IntArray


def check_sequence(numbers: IntArray, samples: IntArray | None = None) -> SequenceCheck:
    """Judge sequence numbers in the order of their arrival.

    Parameters
    ----------
    numbers : ndarray of int, shape (n,)
        Modulo 2^32.
    samples : ndarray of int, shape (n,), optional
        The device's own count of its samples, modulo 2^32, where it has one.
    """
    step = _signed_steps(numbers)
    restart = step < -LATEST
    if samples is not None:
        restart |= (step < 0) & (numbers <= 1) & (_signed_steps(samples) > 0)
    runs = np.split(np.arange(len(numbers)), np.flatnonzero(restart))
    in_order = np.zeros(len(numbers), dtype=bool)
    lost = gaps = reordered = duplicates = 0
    for rows in runs:
        if not len(rows):
            continue
        unwrapped = np.cumsum(np.where(rows == rows[0], 0, step[rows]))
        arrived, first = np.unique(unwrapped, return_index=True)
        late = unwrapped < np.maximum.accumulate(unwrapped)
        is_first = np.zeros(len(rows), dtype=bool)
        is_first[first] = True
        in_order[rows] = is_first & ~late
        missing = np.diff(arrived) - 1
        lost += int(missing.sum())
        gaps += int(np.count_nonzero(missing))
        reordered += int(np.count_nonzero(is_first & late))
        duplicates += len(rows) - len(arrived)
    return SequenceCheck(lost, gaps, reordered, duplicates, int(restart.sum()), in_order, step)


def _signed_steps(numbers: IntArray) -> IntArray:
    """Give the steps modulo 2^32, from -2^31 up to 2^31 - 1; 1 in the first row."""
    step: IntArray = np.diff(numbers, prepend=numbers[:1] - 1)
    return (step + MODULUS // 2) % MODULUS - MODULUS // 2


def usual_interval(time: FloatArray) -> float:
    """Give the median interval of time stamps of shape (n,), s; NaN for fewer than two."""
    return float(np.median(np.diff(time))) if len(time) > 1 else float("nan")


def longest_allowed(time: FloatArray, shortest_gap: float = SHORTEST_GAP) -> float:
    """Give the interval (s) above which two neighbours of a channel are not neighbours any more."""
    return max(GAP_PERIODS * usual_interval(time), shortest_gap) if len(time) > 1 else shortest_gap
