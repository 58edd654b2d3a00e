"""Deflection of each layer over the radius at peak load, FEM against wave, drawn as the dent it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, LiveAxes, LivePlot, Panel
from reports.figures.arrays import Floats, column, layer_of, matrix, optional_matrix, peak, shared_limits
from reports.figures.live_lines import model_lines
from reports.figures.marks import edge_line, model_line
from reports.figures.pair import DEFAULT, Pair
from reports.figures.style import SMALL, draw, heading, legend_above, zero_line
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing


def profile(
    layer_names: Sequence[str],
    radius_mm: Any,
    fem_mm: Any,
    wave_mm: Any = None,
    tool_radius_mm: float | None = None,
    pair: Pair = DEFAULT,
) -> Figure:
    """Draw the deflection of each layer's top face over the distance from the tool axis, a panel a layer.

    Parameters
    ----------
    layer_names
        Names from the surface down, L of them.
    radius_mm
        Reference radii in mm, shape (m,).
    fem_mm, wave_mm
        Deflection in mm, press positive and drawn downwards, shape (L, m), NaN where a model has no value
        (outside the wave model's window); `wave_mm` is None where the wave model does not cover the case.
    tool_radius_mm
        Radius of the tool, marked in each panel.
    pair
        What the two models are called.

    Raises
    ------
    ValueError
        For arrays of other shapes, infinite values, or no radius.
    """
    radius = column("radius_mm", radius_mm)
    if not radius.size:
        raise ValueError("radius_mm is empty; at least one radius is needed")
    shape = (len(layer_names), len(radius))
    fem = matrix("fem_mm", fem_mm, shape)
    wave = optional_matrix("wave_mm", wave_mm, shape)
    columns = None if wave is None else wave.T
    scale = shared_limits([*fem, *([] if wave is None else wave)])
    layers = [
        _Layer(name, place, radius, fem[place], layer_of(columns, place), tool_radius_mm, scale, pair)
        for place, name in enumerate(layer_names)
    ]
    panels = [Panel(draw(layer.paint, SMALL, 290), layer.words(), layer.name, layer.live()) for layer in layers]
    return Figure(panels, _caption(pair, wave is not None, scale is not None), "Profiles at peak load")


@dataclass(frozen=True)
class _Layer:
    """One panel."""

    name: str
    place: int
    radius: Floats
    fem: Floats
    wave: Floats | None
    tool_radius: float | None
    scale: tuple[float, float] | None
    pair: Pair

    def paint(self, drawing: Drawing) -> None:
        """Draw the dent, the surface at the top."""
        axes = drawing.subplots()
        zero_line(axes)
        model_line(axes, self.radius, self.fem, self.pair.fem, stops=False)
        if self.wave is not None:
            model_line(axes, self.radius, self.wave, self.pair.wave, stops=False)
        axes.set_ylim(*(self.scale or (None, None)))
        axes.invert_yaxis()
        axes.set_xlim(float(self.radius.min()), float(self.radius.max()))
        if self.tool_radius is not None:
            edge_line(axes, self.tool_radius, "tool edge")
        axes.set(xlabel="distance from the tool axis (mm)", ylabel="deflection (mm)")
        heading(axes, self.name, self.place, room=24)
        legend_above(axes)

    def live(self) -> LivePlot:
        """The same dent, to zoom."""
        lines = model_lines(self.pair, self.radius, self.fem, self.wave)
        marks = [] if self.tool_radius is None else [(self.tool_radius, "tool edge")]
        axes = LiveAxes("deflection (mm)", lines, downwards=True)
        return LivePlot("distance from the tool axis (mm)", (axes,), marks)

    def words(self) -> str:
        """Say what the panel shows."""
        text = f"{self.name}: the largest deflection is {format_number(peak(self.fem))} mm in the {self.pair.fem.name}"
        if self.wave is None:
            return text + "."
        text += f" and {format_number(peak(self.wave))} mm in the {self.pair.wave.name}"
        apart = np.abs(self.wave - self.fem)
        return text + f"; they differ by at most {format_number(peak(apart), 3)} mm along the radius."


def _caption(pair: Pair, wave: bool, shared: bool) -> str:
    """Say what is compared with what."""
    text = "Deflection of each layer's top face at peak load over the reference radius, press downwards"
    text += f": {pair.caption(True, wave='dashed, within its window')}." if wave else f": {pair.fem.name} alone."
    return text + ("" if shared else " Each panel has its own vertical scale.")
