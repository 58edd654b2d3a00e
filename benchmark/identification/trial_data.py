"""One measured trial as the fit takes it, and its reduction to a bearable number of rows.

Neighbouring rows are averaged together, and in a trial of many cycles never across a turn: a mean over a good part of a
cycle is a depth and a force that were never measured together. Where a trial has more strokes (from one turn of the
depth to the next) than an even share of rows can follow, some of its cycles stand for all, evenly over the record, each
followed closely.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from benchmark.identification.model_error import ModelError
from benchmark.response.force_curve import Array, ForceCurve, ResponseError

LEAST_ROWS = 20

IntArray = NDArray[np.int64]

TURN: Final = 0.2
"""Share of the travel by which the depth goes back before that counts as a turn."""
PER_STROKE: Final = 40
"""Rows with which a stroke is followed: each a fortieth of the travel."""
SAMPLES: Final = 200_000
"""Means over the record in which turns are looked for."""


class FittingError(ResponseError):
    """Trials or curves that cannot be fitted; the message names which, the value and what is allowed."""


class NoContactError(FittingError):
    """A trial without motion or without a force that rises over the noise: it tells no stiffness."""


@dataclass(frozen=True)
class TrialData:
    """A measured trial with the elastic curve of its tool and support.

    Attributes
    ----------
    name, condition : str
        Together unique in a session.
    time, depth, force : (n,) arrays
        s increasing, m press positive (zero near first contact), N press positive; n >= 20.
    curve : ForceCurve
        Force of the specimen at stiffness factor 1.
    error : ModelError or None
        How the curve may be wrong by itself; None where it is taken as exact.

    Raises
    ------
    FittingError
        Shapes that differ, fewer than 20 rows, a value that is not finite, time that does not increase.
    """

    name: str
    condition: str
    time: Array
    depth: Array
    force: Array
    curve: ForceCurve
    error: ModelError | None = None

    def __post_init__(self) -> None:
        for channel in ("time", "depth", "force"):
            values = np.asarray(getattr(self, channel), dtype=float)
            object.__setattr__(self, channel, values)
            if values.ndim != 1 or values.shape != np.shape(self.time):
                raise FittingError(
                    f"{self.label}: {channel} has shape {values.shape}; each channel needs the same (n,)"
                )
            if not np.isfinite(values).all():
                raise FittingError(
                    f"{self.label}: {channel} has a value that is not finite in row {_first_bad(values)}"
                )
        if self.rows < LEAST_ROWS:
            raise FittingError(f"{self.label}: {self.rows} rows; at least {LEAST_ROWS} are needed")
        if (np.diff(self.time) <= 0.0).any():
            raise FittingError(f"{self.label}: time does not increase at row {int(np.argmin(np.diff(self.time))) + 2}")

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(self.time)

    @property
    def label(self) -> str:
        """How messages call the trial."""
        return f"trial {self.name} ({self.condition})"

    @property
    def key(self) -> tuple[str, str]:
        """Condition and name, which identify the trial."""
        return self.condition, self.name


def _first_bad(values: Array) -> int:
    return int(np.argmin(np.isfinite(values))) + 1


def reduced(trial: TrialData, rows: int) -> TrialData:
    """Return the trial with about `rows` rows (>= 40) or fewer, each the mean of equally many neighbouring rows.

    The last rows that do not fill a group are averaged too. A short enough trial is returned as it is; of one with more
    cycles than so many rows can follow some stand for all.
    """
    if trial.rows <= rows:
        return trial
    starts, ends = group_bounds(trial.depth, rows)
    whole = bool((starts[1:] == ends[:-1]).all()) and ends[-1] == trial.rows

    def means(values: Array) -> Array:
        if whole:
            return np.asarray(np.add.reduceat(values, starts) / (ends - starts))
        return np.array([values[start:end].mean() for start, end in zip(starts, ends, strict=True)])

    return replace(trial, time=means(trial.time), depth=means(trial.depth), force=means(trial.force))


def up_to_depth(trial: TrialData, depth: float) -> TrialData | None:
    """Return the trial's rows with a depth of at most `depth` (m); None where fewer than 20 are left."""
    kept = trial.depth <= depth
    if int(kept.sum()) < LEAST_ROWS:
        return None
    return rows_of(trial, kept)


def rows_of(trial: TrialData, rows: slice | NDArray[np.bool_]) -> TrialData:
    """Return the trial with some of its rows, at least 20."""
    return replace(trial, time=trial.time[rows], depth=trial.depth[rows], force=trial.force[rows])


def group_bounds(depth: Array, rows: int) -> tuple[IntArray, IntArray]:
    """First rows of the groups to average and the rows after their last, at most about `rows` groups.

    Parameters
    ----------
    depth : (n,)
        m, n above `rows`.
    rows : int
        At least 40.
    """
    turns = turning_rows(depth)
    if (len(turns) - 1) * PER_STROKE <= rows:
        starts = np.arange(0, len(depth), -(-len(depth) // rows))
        return starts, np.append(starts[1:], len(depth))
    first, last = _chosen_strokes(turns, max(rows // PER_STROKE, 2))
    shares = np.linspace(0.0, 1.0, PER_STROKE + 1)
    edges = np.unique(np.round(first[:, None] + shares * (last - first)[:, None]).astype(np.int64), axis=1)
    starts, ends = edges[:, :-1].ravel(), edges[:, 1:].ravel()
    return starts[ends > starts], ends[ends > starts]


def turning_rows(depth: Array) -> IntArray:
    """Rows in which strokes begin and end: the first, each turn of the depth (n,) m, and the one after the last."""
    size = -(-len(depth) // SAMPLES)
    starts = np.arange(0, len(depth), size)
    means = np.add.reduceat(depth, starts) / np.diff(np.append(starts, len(depth)))
    least = TURN * float(np.ptp(means))
    turns, extreme, sign = [0], 0, 0
    for at, value in enumerate(means.tolist()):
        gone = value - float(means[extreme])
        if sign * gone >= 0.0 and (sign or abs(gone) >= least):
            sign, extreme = sign or (1 if gone > 0.0 else -1), at
        elif sign and abs(gone) >= least:
            turns.append(extreme * size)
            sign, extreme = -sign, at
    return np.array([*turns, len(depth)], dtype=np.int64)


def _chosen_strokes(turns: IntArray, most: int) -> tuple[IntArray, IntArray]:
    """First and last rows of `most` strokes: pairs of neighbours, evenly over the record.

    Each pair begins as the first one does, so that depths follow one another without a leap from pair to pair.
    """
    strokes = len(turns) - 1
    pairs = 2 * np.unique(np.round(np.linspace(0, strokes // 2 - 1, most // 2)).astype(np.int64))
    chosen = np.unique(np.concatenate([pairs, pairs + 1]))
    return turns[chosen], turns[chosen + 1]
