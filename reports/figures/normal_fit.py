"""Normal fits of the maximum deformations over their histograms, FEM and wave, a panel a layer (Fig. 13)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, Panel
from reports.figures.arrays import Floats, matrix, optional_matrix
from reports.figures.style import DEFAULT, SMALL, Pair, Stroke, draw, heading, legend_above
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


@dataclass(frozen=True)
class Normal:
    """A fitted normal distribution, both in mm."""

    mean: float
    std: float

    def density(self, x: Floats) -> Floats:
        """Return the probability density in 1/mm at `x` in mm, shape (n,)."""
        scaled = (x - self.mean) / self.std
        return np.asarray(np.exp(-0.5 * scaled**2) / (self.std * np.sqrt(2 * np.pi)))


def normal_fit(
    layer_names: Sequence[str],
    fem_mm: Any,
    fem_fits: Sequence[Normal],
    wave_mm: Any = None,
    wave_fits: Sequence[Normal] = (),
    pair: Pair = DEFAULT,
) -> Figure:
    """Draw each layer's maximum deformations as a histogram, and the normal distribution fitted to them.

    Parameters
    ----------
    layer_names
        Names from the surface down, L of them.
    fem_mm, wave_mm
        Observations in mm, shape (n, L), NaN where a model has none; `wave_mm` None without a wave model.
    fem_fits, wave_fits
        The normal fitted to each layer's observations, L of each.
    pair
        What the two models are called.

    Raises
    ------
    ValueError
        For arrays of other shapes, infinite values, or another number of fits.
    """
    shape = (len(np.asarray(fem_mm, dtype=np.float64)), len(layer_names))
    fem = matrix("fem_mm", fem_mm, shape)
    wave = optional_matrix("wave_mm", wave_mm, shape)
    models = [(pair.fem, fem, fem_fits)] + ([] if wave is None else [(pair.wave, wave, wave_fits)])
    for stroke, _, fits in models:
        if len(fits) != len(layer_names):
            raise ValueError(f"{len(fits)} normal fits of the {stroke.label} for {len(layer_names)} layers")
    layers = [
        _Layer(
            name,
            place,
            [_Sample(stroke, _present(values[:, place]), fits[place]) for stroke, values, fits in models],
        )
        for place, name in enumerate(layer_names)
    ]
    panels = [Panel(draw(layer.paint, SMALL, 290), layer.words(), layer.name) for layer in layers]
    caption = (
        "Observations of the maximum deformation over the load history (bars, scaled to a density) "
        "and the normal distributions fitted to them, "
        + (pair.caption(True, fem="solid line, filled bars") if wave is not None else f"{pair.fem.name} alone")
        + "."
    )
    return Figure(panels, caption, "Normal fits")


@dataclass(frozen=True)
class _Sample:
    """One model's observations and their fit."""

    stroke: Stroke
    values: Floats
    fit: Normal

    @property
    def drawable(self) -> bool:
        """Whether there is a density to draw."""
        return bool(self.values.size) and self.fit.std > 0


@dataclass(frozen=True)
class _Layer:
    """One panel."""

    name: str
    place: int
    samples: Sequence[_Sample]

    def paint(self, drawing: Drawing) -> None:
        """Draw histograms under the fitted normals."""
        axes = drawing.subplots()
        axes.grid(visible=False, axis="x")
        drawable = [sample for sample in self.samples if sample.drawable]
        if drawable:
            self._paint_samples(axes, drawable)
        else:
            axes.text(0.5, 0.5, "no spread to draw", transform=axes.transAxes, ha="center")
        axes.set(xlabel="maximum deformation (mm)", ylabel="density (1/mm)")
        axes.set_ylim(bottom=0)
        heading(axes, self.name, self.place, room=24)
        legend_above(axes)

    def _paint_samples(self, axes: Axes, samples: Sequence[_Sample]) -> None:
        edges = _edges(np.concatenate([sample.values for sample in samples]))
        low = min(edges[0], *(sample.fit.mean - 3 * sample.fit.std for sample in samples))
        high = max(edges[-1], *(sample.fit.mean + 3 * sample.fit.std for sample in samples))
        grid = np.linspace(low, high, 161)
        for sample in samples:
            stroke = sample.stroke
            filled = stroke.line == "-"
            heights, _ = np.histogram(sample.values, edges, density=True)
            axes.stairs(heights, edges, fill=filled, color=stroke.colour, alpha=0.22 if filled else 0.75, linewidth=1)
            axes.plot(grid, sample.fit.density(grid), color=stroke.colour, linestyle=stroke.line, label=stroke.label)

    def words(self) -> str:
        """Say what the panel shows."""
        parts = [
            f"{sample.stroke.label} mean {format_number(float(sample.fit.mean))} mm, "
            f"standard deviation {format_number(float(sample.fit.std))} mm, n = {sample.values.size}"
            for sample in self.samples
        ]
        return f"{self.name}: {'; '.join(parts)}."


def _edges(values: Floats) -> Floats:
    """Return histogram edges common to both models, at most 24 bins."""
    edges = np.histogram_bin_edges(values, bins="auto")
    return edges if len(edges) <= 25 else np.linspace(edges[0], edges[-1], 25)


def _present(values: Floats) -> Floats:
    return values[np.isfinite(values)]
