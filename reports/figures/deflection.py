"""Deflection of each layer, FEM against wave: on the tool axis over the load history (Fig. 12), and over the radius."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.blocks import Figure, LiveAxes, LiveLine, LivePlot, Panel
from reports.figures.arrays import Floats, column, layer_of, matrix, optional_matrix, peak, shared_limits, stopped_at
from reports.figures.style import (
    DEFAULT,
    INK,
    SMALL,
    Pair,
    draw,
    edge_line,
    heading,
    legend_above,
    model_line,
    model_lines,
    zero_line,
)
from reports.formatting import format_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing


Limits = tuple[float, float] | None
LOAD_STEP = "load step"


def max_deformation(
    layer_names: Sequence[str],
    x: Any,
    fem_mm: Any,
    wave_mm: Any = None,
    percent_error: Any = None,
    pair: Pair = DEFAULT,
) -> Figure:
    """Draw the deflection of each layer's top face on the tool axis, a panel a layer.

    Parameters
    ----------
    layer_names
        Names from the surface down, L of them.
    x
        Load steps, shape (n,).
    fem_mm, wave_mm
        Deflection in mm, press positive, shape (n, L), NaN where a model has no value (it stopped there);
        `wave_mm` is None where the wave model does not cover the case.
    percent_error
        Error of wave against FEM in percent, shape (n, L), NaN where it has no meaning; None leaves it out.
    pair
        What the two models are called.

    Raises
    ------
    ValueError
        For arrays of other shapes, or infinite values.
    """
    x = column("x", x)
    shape = (len(x), len(layer_names))
    fem = matrix("fem_mm", fem_mm, shape)
    wave = optional_matrix("wave_mm", wave_mm, shape)
    error = None if wave is None else optional_matrix("percent_error", percent_error, shape)
    scale = shared_limits([*fem.T, *([] if wave is None else wave.T)])
    error_scale = None if error is None else shared_limits(list(error.T))
    errors = [(layer_of(error, place), error_scale) for place in range(len(layer_names))]
    layers = [
        _LoadPanel(name, place, x, fem[:, place], layer_of(wave, place), scale, pair, *errors[place])
        for place, name in enumerate(layer_names)
    ]
    height = 290 if error is None else 380
    panels = [Panel(draw(layer.paint, SMALL, height), layer.words(), layer.name, layer.live()) for layer in layers]
    caption = _load_caption(pair, wave is not None, error is not None, scale is not None)
    return Figure(panels, caption, "Maximum deformation")


def deformation_bands(
    layer_names: Sequence[str],
    force_n: Any,
    fem_mm: Any,
    fem_factor: Any,
    wave_mm: Any = None,
    wave_factor: Any = None,
    pair: Pair = DEFAULT,
) -> Figure:
    """Draw each layer's deflection over the force with the bands that uncertain parameters leave, a panel a layer.

    Parameters
    ----------
    layer_names
        Names from the surface down, L of them.
    force_n
        Shape (n,), N.
    fem_mm, wave_mm
        Deflection in mm, shape (n, L), NaN where a model has no value.
    fem_factor, wave_factor
        Upper end of the band over the value, shape (n, L); the lower end is the value over it.
    pair
        What the two models are called.
    """
    x = column("force_n", force_n)
    shape = (len(x), len(layer_names))
    models = [(pair.fem, matrix("fem_mm", fem_mm, shape), matrix("fem_factor", fem_factor, shape))]
    if wave_mm is not None and wave_factor is not None:
        models.append((pair.wave, matrix("wave_mm", wave_mm, shape), matrix("wave_factor", wave_factor, shape)))
    panels = []
    for place, name in enumerate(layer_names):
        own = [(style, values[:, place], factor[:, place]) for style, values, factor in models]
        panel = _BandPanel(name, place, x, own)
        panels.append(Panel(draw(panel.paint, SMALL, 300), f"{name}: both models with their bands.", name))
    caption = "Deflection over force with 95 % bands of uncertain parameters; both models move together within them."
    return Figure(panels, caption, "What the parameters leave")


@dataclass(frozen=True)
class _BandPanel:
    """One panel: a layer's name, forces (n,) N, and each model's style, deflections mm and factors, (n,) each."""

    name: str
    place: int
    x: Floats
    models: Sequence[tuple[Any, Floats, Floats]]

    def paint(self, drawing: Drawing) -> None:
        """Draw bands below lines."""
        axes = drawing.subplots()
        for style, values, factor in self.models:
            axes.fill_between(self.x, values / factor, values * factor, color=style.colour, alpha=0.2, linewidth=0)
            model_line(axes, self.x, values, style, False)
        axes.set(xlabel="force (N)", ylabel="deflection (mm)")
        heading(axes, self.name, self.place, room=24)
        legend_above(axes)


@dataclass(frozen=True)
class _LayerPanel:
    """One panel: a layer's name, its abscissa and both models' deflections, shape (n,) each."""

    name: str
    place: int
    x: Floats
    fem: Floats
    wave: Floats | None
    scale: Limits
    pair: Pair

    def paint_models(self, axes: Axes, stops: bool = True) -> None:
        """Draw both models' lines on the vertical scale that the panels share."""
        model_line(axes, self.x, self.fem, self.pair.fem, stops)
        if self.wave is not None:
            model_line(axes, self.x, self.wave, self.pair.wave, stops)
        axes.set_ylim(*(self.scale or (None, None)))

    def name_panel(self, axes: Axes) -> None:
        """Write the layer's name and the legend above."""
        heading(axes, self.name, self.place, room=24)
        legend_above(axes)


@dataclass(frozen=True)
class _LoadPanel(_LayerPanel):
    """A layer's top face over the load history, the error below."""

    error: Floats | None
    error_scale: Limits

    def paint(self, drawing: Drawing) -> None:
        """Draw the deflections and, under them, the error."""
        if self.error is None:
            top = bottom = drawing.subplots()
        else:
            top, bottom = drawing.subplots(2, 1, sharex=True, height_ratios=(2.3, 1))
            self._paint_error(bottom, self.error)
        self.paint_models(top)
        top.set_ylabel("deflection (mm)")
        bottom.set_xlabel(LOAD_STEP)
        self.name_panel(top)

    def _paint_error(self, axes: Axes, error: Floats) -> None:
        zero_line(axes)
        axes.plot(self.x, error, color=INK, linewidth=1.2)
        axes.set_ylim(*(self.error_scale or (None, None)))
        axes.set_ylabel("error (%)")

    def live(self) -> LivePlot:
        """The same lines, to zoom."""
        axes = [LiveAxes("deflection (mm)", model_lines(self.pair, self.x, self.fem, self.wave))]
        if self.error is not None:
            axes.append(LiveAxes("error (%)", (LiveLine("error, %", self.x, self.error, "ink"),)))
        return LivePlot(LOAD_STEP, axes)

    def words(self) -> str:
        """Say what the panel shows."""
        fem, wave = self.pair.fem.name, self.pair.wave.name
        text = f"{self.name}: {fem} reaches {format_number(peak(self.fem))} mm"
        text += "" if self.wave is None else f", {wave} {format_number(peak(self.wave))} mm"
        if self.error is not None:
            low, high = (format_number(float(end(self.error)), 3) for end in (np.nanmin, np.nanmax))
            text += f"; the error of {wave} against {fem} lies between {low} and {high} percent"
        if stopped_at(self.fem) is not None:
            text += f"; the {fem} run stopped before the end"
        return text + "."


def _load_caption(pair: Pair, wave: bool, error: bool, shared: bool) -> str:
    """Say what is compared with what."""
    text = f"Deflection of each layer's top face on the tool axis, press positive: {pair.caption(wave)}."
    text += f" Below, the error of the {pair.wave.name} against the {pair.fem.name}." if error else ""
    return text + ("" if shared else " Each panel has its own vertical scale.")


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
        _ProfilePanel(name, place, radius, fem[place], layer_of(columns, place), scale, pair, tool_radius_mm)
        for place, name in enumerate(layer_names)
    ]
    panels = [Panel(draw(layer.paint, SMALL, 290), layer.words(), layer.name, layer.live()) for layer in layers]
    return Figure(panels, _profile_caption(pair, wave is not None, scale is not None), "Profiles at peak load")


@dataclass(frozen=True)
class _ProfilePanel(_LayerPanel):
    """A layer's top face over the radius at peak load."""

    tool_radius: float | None

    def paint(self, drawing: Drawing) -> None:
        """Draw the dent, the surface at the top."""
        axes = drawing.subplots()
        zero_line(axes)
        self.paint_models(axes, stops=False)
        axes.invert_yaxis()
        axes.set_xlim(float(self.x.min()), float(self.x.max()))
        if self.tool_radius is not None:
            edge_line(axes, self.tool_radius, "tool edge")
        axes.set(xlabel="distance from the tool axis (mm)", ylabel="deflection (mm)")
        self.name_panel(axes)

    def live(self) -> LivePlot:
        """The same dent, to zoom."""
        lines = model_lines(self.pair, self.x, self.fem, self.wave)
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


def _profile_caption(pair: Pair, wave: bool, shared: bool) -> str:
    """Say what is compared with what."""
    text = "Deflection of each layer's top face at peak load over the reference radius, press downwards"
    text += f": {pair.caption(True, wave='dashed, within its window')}." if wave else f": {pair.fem.name} alone."
    return text + ("" if shared else " Each panel has its own vertical scale.")
