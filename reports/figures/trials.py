"""Measured trials as figures take them, and their median over depth."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from reports.figures.arrays import Floats, column, optional_column


@dataclass(frozen=True)
class TrialCurve:
    """One trial: force over depth as measured, and what the models say at the same depths.

    Attributes
    ----------
    trial, condition
        Its name and the condition it was made under.
    depth_mm, force_N
        Measured, shape (n,), press positive.
    fem_force_N, wave_force_N
        The models' forces at the same instants, shape (n,), NaN where there is none; None without the model.

    Raises
    ------
    ValueError
        For arrays of other shapes, or infinite values.
    """

    trial: str
    condition: str
    depth_mm: Any
    force_N: Any
    fem_force_N: Any = None
    wave_force_N: Any = None

    def __post_init__(self) -> None:
        depth = column(f"{self.trial}: depth_mm", self.depth_mm)
        size = len(depth)
        checked = {
            "depth_mm": depth,
            "force_N": column(f"{self.trial}: force_N", self.force_N, size),
            "fem_force_N": optional_column(f"{self.trial}: fem_force_N", self.fem_force_N, size),
            "wave_force_N": optional_column(f"{self.trial}: wave_force_N", self.wave_force_N, size),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    def loading(self) -> slice:
        """Return the rows of the first loading: up to where depth first comes within 0.5 % of its largest."""
        reach = self.depth_mm >= self.depth_mm.min() + 0.995 * np.ptp(self.depth_mm)
        return slice(0, int(np.argmax(reach)) + 1)


Series = Callable[[TrialCurve], Floats | None]


def loading_median(trials: Sequence[TrialCurve], series: Series, points: int = 80) -> tuple[Floats, Floats]:
    """Return the median over trials of a series during the first loading.

    It is taken to the depth that four fifths of the trials reach, over just these, so that it does not jump
    where a trial ends.

    Parameters
    ----------
    trials
        The trials; those without the series, or with less than two depths, are left out.
    series
        Returns the values of a trial, shape (n,), or None.
    points
        Number of depths to take the median at.

    Returns
    -------
    depth_mm, median
        Shape (points,) each; empty without a trial that has the series.
    """
    branches = [branch for trial in trials if (branch := _branch(trial, series)) is not None]
    if not branches:
        return np.empty(0), np.empty(0)
    end = float(np.quantile([depth[-1] for depth, _ in branches], 0.2, method="lower"))
    start = min(end, float(np.median([depth[0] for depth, _ in branches])))
    grid = np.linspace(start, end, points)
    return grid, np.median([np.interp(grid, *branch) for branch in branches if branch[0][-1] >= end], axis=0)


def by_condition(trials: Sequence[TrialCurve]) -> dict[str, list[TrialCurve]]:
    """Return the trials of each condition, conditions in order of appearance."""
    groups: dict[str, list[TrialCurve]] = {}
    for trial in trials:
        groups.setdefault(trial.condition, []).append(trial)
    return groups


def _branch(trial: TrialCurve, series: Series) -> tuple[Floats, Floats] | None:
    """Return depth (strictly increasing) and values of the first loading; None where that is no curve."""
    values = series(trial)
    if values is None:
        return None
    rows = trial.loading()
    depth, values = trial.depth_mm[rows], values[rows]
    farther = np.isfinite(depth) & np.isfinite(values)
    depth, values = depth[farther], values[farther]
    ahead = depth > np.concatenate(([-np.inf], np.maximum.accumulate(depth)[:-1]))
    return (depth[ahead], values[ahead]) if ahead.sum() > 1 else None
