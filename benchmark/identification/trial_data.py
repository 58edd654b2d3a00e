"""One measured trial as the fit takes it, and its reduction to a bearable number of rows."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmark.identification.errors import FittingError
from benchmark.identification.reduction import group_bounds
from benchmark.response.force_curve import Array, ForceCurve

LEAST_ROWS = 20


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
    cycles than so many rows can follow some stand for all (see `reduction`).
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
