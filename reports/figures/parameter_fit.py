"""A fit of several parameters: profiles of the likelihood, pairs of parameters, measured forces in their bands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from reports.blocks import Figure, Panel
from reports.figures.arrays import Floats, thinned
from reports.figures.style import FEM, INK, MEASURED, MUTED, SMALL, WIDE, draw, heading, legend_above, planned_line
from reports.formatting import format_number, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

TWO_DEGREES = (2.2789, 5.9915)
"""Chi squared with two degrees of freedom: ellipses that hold 68 and 95 %."""
MOST_DOTS = 1500


@dataclass(frozen=True)
class ProfileCurve:
    """A parameter's profile: values (m,) in `unit`, rises of -2 log likelihood (m,), and whether it is determined."""

    name: str
    unit: str
    value: Floats
    rise: Floats
    best: float
    threshold: float
    determined: bool


def profile_curves(curves: Sequence[ProfileCurve]) -> Figure:
    """Draw the profile of each parameter with the height at which its 95 % interval ends.

    Raises
    ------
    ValueError
        Without a curve.
    """
    if not curves:
        raise ValueError("curves is empty; at least one profile is needed")
    panels = [
        Panel(draw(_ProfilePanel(one, k if len(curves) > 1 else None).paint, SMALL, 260), _profile_words(one), one.name)
        for k, one in enumerate(curves)
    ]
    caption = (
        "How much worse the trials are followed (-2 log likelihood) with one parameter held at a value and all others "
        "at their best. The interval ends where the curve crosses the line."
    )
    return Figure(panels, caption, "Profiles of the likelihood")


def _profile_words(one: ProfileCurve) -> str:
    state = "ends on both sides" if one.determined else "does not end: not determined"
    return f"{one.name}, best {format_number(one.best)} {one.unit}; its interval {state}."


@dataclass(frozen=True)
class _ProfilePanel:
    curve: ProfileCurve
    place: int | None

    def paint(self, drawing: Drawing) -> None:
        """Draw the curve, its threshold and the best value."""
        axes, one = drawing.subplots(), self.curve
        colour = FEM.colour if one.determined else MUTED
        axes.plot(one.value, one.rise, color=colour, marker="o", markersize=4)
        planned_line(axes, one.threshold, "95 %")
        axes.axvline(one.best, color=MUTED, linewidth=0.9, zorder=1)
        axes.set_ylim(0.0, 2.2 * one.threshold)
        axes.set(xlabel=shortened(one.name, 30) + (f" ({one.unit})" if one.unit else ""), ylabel="rise")
        axes.locator_params(axis="x", nbins=4)
        heading(axes, one.name, self.place)


def corner(names: Sequence[str], values: Floats, covariance: Floats, samples: Floats | None = None) -> Figure:
    """Draw each pair of parameters as ellipses that hold 68 and 95 %, over draws of the posterior where there are any.

    Parameters
    ----------
    names
        Of the parameters with their units, (p,), p of 2 or more.
    values, covariance
        (p,) and (p, p) of the values' natural logarithms' estimate.
    samples
        (s, p) draws of the logarithms, or None.

    Raises
    ------
    ValueError
        With fewer than two parameters.
    """
    count = len(names)
    if count < 2:
        raise ValueError("names has fewer than two parameters; a pair is needed")

    def paint(drawing: Drawing) -> None:
        grid = drawing.subplots(count - 1, count - 1, squeeze=False, sharex="col", sharey="row")
        for i in range(1, count):
            for j in range(count - 1):
                if j < i:
                    _pair(grid[i - 1, j], values[[j, i]], covariance[np.ix_([j, i], [j, i])], _two(samples, j, i))
                else:
                    grid[i - 1, j].set_axis_off()
        for k in range(count - 1):
            grid[-1, k].set_xlabel(shortened(names[k], 22), color=INK)
            grid[k, 0].set_ylabel(shortened(names[k + 1], 22), color=INK)

    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    unit = covariance / np.outer(spread, spread)
    words = "; ".join(f"{names[j]} and {names[i]}: {unit[i, j]:.2f}" for i in range(count) for j in range(i))
    caption = "Pairs of parameters: ellipses hold 68 and 95 %. A narrow slanted one is a trade that trials leave open."
    if samples is not None:
        caption += " Dots: draws of the posterior."
    return Figure.of(
        draw(paint, WIDE, 150 * (count - 1) + 60), caption, f"Correlations: {words}.", "Pairs of parameters"
    )


def _two(samples: Floats | None, j: int, i: int) -> Floats | None:
    return None if samples is None else samples[:: max(len(samples) // MOST_DOTS, 1)][:, [j, i]]


def _pair(axes: Axes, at: Floats, covariance: Floats, samples: Floats | None) -> None:
    if samples is not None:
        axes.plot(*np.exp(samples).T, ".", color=MEASURED.colour, markersize=1.5, alpha=0.4)
    sizes, vectors = np.linalg.eigh(covariance)
    turn = np.linspace(0.0, 2.0 * np.pi, 121)
    round_ = vectors @ (np.sqrt(np.maximum(sizes, 0.0))[:, None] * np.array([np.cos(turn), np.sin(turn)]))
    for size, width in zip(TWO_DEGREES, (1.8, 0.9), strict=True):
        axes.plot(*np.exp(at[:, None] + np.sqrt(size) * round_), color=FEM.colour, linewidth=width)
    axes.locator_params(nbins=3)


@dataclass(frozen=True)
class BandedTrial:
    """A trial in its band, (n,) each: depth mm, measured, predicted, lower and upper end of the 95 % band, N."""

    name: str
    group: str
    depth: Floats
    measured: Floats
    predicted: Floats
    low: Floats
    high: Floats


def fitted_bands(trials: Sequence[BandedTrial], synthetic: bool = False) -> Figure:
    """Draw measured force over depth against what the fit predicts of one more trial, a panel a group.

    Raises
    ------
    ValueError
        Without a trial.
    """
    if not trials:
        raise ValueError("trials is empty; at least one trial is needed")
    groups = list(dict.fromkeys(one.group for one in trials))
    panels = []
    for k, group in enumerate(groups):
        own = [one for one in trials if one.group == group]
        panel = _BandPanel(group, own, k if len(groups) > 1 else None, synthetic)
        size = (WIDE, 380) if len(groups) == 1 else (SMALL, 320)
        panels.append(Panel(draw(panel.paint, *size), f"{group}: {len(own)} trials against their band.", group))
    caption = "Measured (thin) against the fit (thick), with the 95 % band of one more trial: parameters, gain, noise."
    return Figure(panels, ("Synthetic trials. " if synthetic else "") + caption, "Fitted against measured")


@dataclass(frozen=True)
class _BandPanel:
    name: str
    trials: Sequence[BandedTrial]
    place: int | None
    synthetic: bool

    def paint(self, drawing: Drawing) -> None:
        """Draw the trials, and fit and band of the one that goes deepest, while loading."""
        axes = drawing.subplots()
        for k, one in enumerate(self.trials):
            x, y = thinned(one.depth, one.measured)
            axes.plot(x, y, color=MEASURED.colour, linewidth=0.8, alpha=0.6, label="" if k else MEASURED.label)
        deepest = max(self.trials, key=lambda one: float(one.depth.max()))
        rows = slice(0, int(np.argmax(deepest.depth)) + 1)
        order = np.argsort(deepest.depth[rows], kind="stable")
        depth, low, high, fit = (
            each[rows][order] for each in (deepest.depth, deepest.low, deepest.high, deepest.predicted)
        )
        axes.fill_between(depth, low, high, color=FEM.colour, alpha=0.25, linewidth=0, label="95 % band")
        axes.plot(depth, fit, color=FEM.colour, label="fit")
        axes.set(xlabel="depth (mm)", ylabel="force (N)")
        count = f"{len(self.trials)} {'synthetic ' if self.synthetic else ''}trials"
        heading(axes, f"{shortened(self.name, 20)}, {count}", self.place, room=24)
        legend_above(axes, 3)
