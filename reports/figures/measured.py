"""Measured force over depth against FEM and wave model, with residuals, a panel a condition; medians over trials."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, Panel
from reports.figures.arrays import Floats, column, optional_column, thinned
from reports.figures.style import (
    DEFAULT,
    MEASURED,
    SMALL,
    TRIAL,
    WIDE,
    Pair,
    Stroke,
    draw,
    heading,
    legend_above,
    zero_line,
)
from reports.formatting import counted, format_number, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


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


def measured(trials: Sequence[TrialCurve], synthetic: bool = False, pair: Pair = DEFAULT) -> Figure:
    """Draw all trials thin, their median thick, the models over them, and measured minus model below.

    Medians are taken over the first loading, to the depth that four fifths of the trials reach.

    Parameters
    ----------
    trials
        At least one; each condition gets a panel, in order of appearance.
    synthetic
        Whether the trials are synthetic; then each panel says so.
    pair
        What the two models are called.

    Raises
    ------
    ValueError
        Without a trial.
    """
    if not trials:
        raise ValueError("trials is empty; at least one trial is needed")
    groups = by_condition(trials)
    conditions = [
        _Condition(name, group, place if len(groups) > 1 else None, synthetic, pair)
        for place, (name, group) in enumerate(groups.items())
    ]
    width, height = (WIDE, 470) if len(groups) == 1 else (SMALL, 400)
    panels = [Panel(draw(item.paint, width, height), item.words(), item.name) for item in conditions]
    modelled = any(_models_of(group, pair) for group in groups.values())
    caption = "Force over depth as measured"
    if len(trials) > len(groups):
        caption = "Force over depth of every trial (thin grey lines) and their median while loading (thick)"
    caption += ", with the models driven by the measured depth. Below, measured minus model" if modelled else ""
    caption += ", thin for each trial and thick for the median." if modelled else "."
    return Figure(panels, ("Synthetic trials. " if synthetic else "") + caption, "Measured against models")


@dataclass(frozen=True)
class _Condition:
    """One panel."""

    name: str
    trials: Sequence[TrialCurve]
    place: int | None
    synthetic: bool
    pair: Pair

    def paint(self, drawing: Drawing) -> None:
        """Draw forces and, under them, residuals."""
        models = _models_of(self.trials, self.pair)
        if models:
            top, bottom = drawing.subplots(2, 1, sharex=True, height_ratios=(2.2, 1))
            self._paint_residuals(bottom, models)
        else:
            top = bottom = drawing.subplots()
        self._paint_forces(top, models)
        top.set_ylabel("force (N)")
        bottom.set_xlabel("depth (mm)")
        count = counted(len(self.trials), "synthetic trial" if self.synthetic else "trial")
        name = shortened(self.name, 36 if self.place is None else 14)
        heading(top, f"{name}, {count}", self.place, room=24)
        legend_above(top, 3 if self.place is not None else 4)

    def _paint_forces(self, axes: Axes, models: Sequence[tuple[Stroke, Series]]) -> None:
        alone = len(self.trials) == 1
        look: dict[str, Any] = {"color": MEASURED.colour, "linewidth": 2.6, "label": MEASURED.label}
        thin: dict[str, Any] = {"color": TRIAL.colour, "linewidth": 0.8, "alpha": self._alpha(6)}
        for trial in self.trials:
            axes.plot(*thinned(trial.depth_mm, trial.force_N), **(look if alone else thin))
        if not alone:
            axes.plot(*self._median(_force), **look | {"label": "Median"})
        for stroke, series in models:
            axes.plot(*self._median(series), color=stroke.colour, linestyle=stroke.line, label=stroke.label)

    def _paint_residuals(self, axes: Axes, models: Sequence[tuple[Stroke, Series]]) -> None:
        zero_line(axes)
        for stroke, series in models:
            residual = _residual(series)
            for trial in self.trials:
                values = residual(trial)
                if values is not None:
                    points = thinned(trial.depth_mm, values)
                    axes.plot(*points, color=stroke.colour, alpha=self._alpha(4), linewidth=0.7)
            axes.plot(*self._median(residual), color=stroke.colour, linestyle=stroke.line)
        axes.set_ylabel("residual (N)")

    def _alpha(self, ink: float) -> float:
        """Return the opacity of a trial's line: the more trials, the fainter."""
        return float(np.clip(ink / len(self.trials), 0.15, 0.7))

    def _median(self, series: Series) -> tuple[Floats, Floats]:
        return loading_median(self.trials, series)

    def words(self) -> str:
        """Say what the panel shows."""
        depth, force = self._median(_force)
        text = f"{self.name}: {len(self.trials)} trials"
        if depth.size:
            text += f", median force {_read(force[-1])} N at {_read(depth[-1])} mm"
        for stroke, series in _models_of(self.trials, self.pair):
            deep, value = self._median(series)
            if deep.size:
                text += f"; {stroke.label} {_read(value[-1])} N at {_read(deep[-1])} mm"
        return text + "."


def _models_of(trials: Sequence[TrialCurve], pair: Pair) -> list[tuple[Stroke, Series]]:
    """Return the models that have values for any of the trials."""
    models: list[tuple[Stroke, Series]] = [
        (pair.fem, lambda trial: trial.fem_force_N),
        (pair.wave, lambda trial: trial.wave_force_N),
    ]
    return [(stroke, series) for stroke, series in models if any(series(trial) is not None for trial in trials)]


def _force(trial: TrialCurve) -> Floats:
    return np.asarray(trial.force_N)


def _residual(model: Series) -> Series:
    """Return the series of measured minus model in N."""

    def residual(trial: TrialCurve) -> Floats | None:
        values = model(trial)
        return None if values is None else np.asarray(trial.force_N - values)

    return residual


def _read(value: float) -> str:
    return format_number(float(value), 3)
