"""Measured force over depth against FEM and wave model, with residuals, a panel a condition."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, Panel
from reports.figures.arrays import Floats, thinned
from reports.figures.pair import DEFAULT, Pair
from reports.figures.style import (
    MEASURED,
    SMALL,
    TRIAL,
    WIDE,
    Stroke,
    draw,
    heading,
    legend_above,
    zero_line,
)
from reports.figures.trials import Series, TrialCurve, by_condition, loading_median
from reports.formatting import format_number, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


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
        count = f"{len(self.trials)} {'synthetic ' if self.synthetic else ''}trial{'s' * (len(self.trials) > 1)}"
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
