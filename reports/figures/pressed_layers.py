"""Pressed bodies: a section through the tool's axis (to turn where JavaScript runs), and a surface that moves."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from reports.blocks import Figure, LiveBody, LiveFace, Panel
from reports.figures.arrays import Floats, column, optional_matrix
from reports.figures.style import DEFAULT, INK, SMALL, Pair, Stroke, draw, heading
from reports.formatting import format_number
from reports.palette import PALETTE

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing


HEIGHT = 230
AXES_WIDTH, TICK_ROOM = 270.0, 22.0
"""Of the section in CSS pixels: about how wide it is, and how much of its height a tick's number needs."""
SURFACE_WIDTH, SURFACE_HEIGHT, DPI = 4.2, 3.4, 80
FRAMES_PER_SECOND = 12


def pressed_layers(
    layer_names: Sequence[str],
    top_mm: Any,
    base_mm: float | None,
    radius_mm: Any,
    fem_mm: Any,
    wave_mm: Any,
    tool_radius_mm: float,
    pair: Pair = DEFAULT,
) -> Figure | None:
    """Draw the layers as they lie under the press, without magnification; None where no model has a profile.

    Faces move by their deflection alone: no model's sideways displacement is drawn.

    Parameters
    ----------
    layer_names
        Names from the surface down, L of them.
    top_mm
        Depth of each layer's top face at rest in mm, shape (L,).
    base_mm
        Depth of a lower face that stays where it is; None where it moves or there is none. The last layer is a
        face then.
    radius_mm
        Reference radii in mm, shape (m,), rising.
    fem_mm, wave_mm
        Deflection of the top faces at peak load in mm, shape (L, m), NaN where there is no value; None for a model
        without any.
    tool_radius_mm
        Radius of the tool.
    pair
        What the two models are called.

    Raises
    ------
    ValueError
        For arrays of other shapes, or infinite values.
    """
    radius = column("radius_mm", radius_mm)
    shape = (len(layer_names), len(radius))
    top = column("top_mm", top_mm, shape[0])
    deflections = [
        (stroke, optional_matrix(name, values, shape))
        for name, stroke, values in (("fem_mm", pair.fem, fem_mm), ("wave_mm", pair.wave, wave_mm))
    ]
    bodies = [
        _Body(stroke, tuple(layer_names), *_known(radius, values), top, base_mm, tool_radius_mm)
        for stroke, values in deflections
        if values is not None and np.isfinite(values).all(axis=0).sum() > 1
    ]
    if not bodies:
        return None
    limit = max(float(body.deflection.max()) for body in bodies)
    bodies = [replace(body, limit=limit) for body in bodies]
    panels = [Panel(draw(body.paint, SMALL, HEIGHT), body.words(), body.stroke.label, body.live()) for body in bodies]
    return Figure(panels, _caption(base_mm is None), "Pressed layers")


def _known(radius: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Radii at which every layer has a value, and the values there."""
    there = np.isfinite(values).all(axis=0)
    return radius[there], values[:, there]


@dataclass(frozen=True)
class _Body:
    """One panel: a model's layers."""

    stroke: Stroke
    layers: tuple[str, ...]
    radius: Floats
    deflection: Floats
    top: Floats
    base: float | None
    tool_radius: float
    limit: float = 0.0

    def _heights(self) -> Floats:
        """(L, m) or, above a base that rests, (L + 1, m): heights of the faces in mm, the surface at rest at zero."""
        faces = -self.top[:, None] - self.deflection
        return faces if self.base is None else np.vstack([faces, np.full(self.radius.size, -self.base)])

    def paint(self, drawing: Drawing) -> None:
        """Draw both halves of the section, equal scales on both axes."""
        axes = drawing.subplots()
        heights = self._heights()
        across = np.concatenate([-self.radius[::-1], self.radius])
        both = np.concatenate([heights[:, ::-1], heights], axis=1)
        for place in range(len(both) - 1):
            tint = 0.65 * (1.0 - 0.8 * place / len(self.layers))
            axes.fill_between(
                across, both[place], both[place + 1], color=PALETTE["tissue"].light, alpha=tint, linewidth=0.0
            )
        for line in both:
            axes.plot(across, line, color=INK, linewidth=0.8)
        axes.plot(
            [-self.tool_radius, self.tool_radius], [float(heights.max())] * 2, color=PALETTE["tool"].light, linewidth=4
        )
        axes.set_aspect("equal")
        axes.grid(visible=False)
        axes.set(xlabel="distance from the tool axis (mm)", ylabel="height (mm)")
        tall = np.ptp(heights) / (2.0 * self.radius[-1]) * AXES_WIDTH
        if tall < 2.0 * TICK_ROOM:
            axes.set_yticks([float(f"{heights.min():.2g}")])
        else:
            axes.locator_params(axis="y", nbins=int(tall / TICK_ROOM))
        heading(axes, self.stroke.label)

    def live(self) -> LiveBody:
        """The same layers, turned about the axis."""
        heights = self._heights()
        faces = [
            LiveFace(name, heights[place], self.deflection[place], below)
            for place, (name, below) in enumerate(zip(self.layers, self._below(heights), strict=True))
        ]
        return LiveBody(self.radius, faces, "deflection (mm)", self.limit, self.tool_radius)

    def _below(self, heights: Floats) -> list[Floats | None]:
        lower: list[Floats | None] = [*heights[1:]]
        return lower if self.base is not None else [*lower, None]

    def words(self) -> str:
        """Say what the panel shows."""
        parts = [
            f"{name} by {format_number(float(values[0]), 4)} mm on the axis and "
            f"{format_number(float(values[-1]), 2)} mm at {format_number(float(self.radius[-1]), 3)} mm"
            for name, values in zip(self.layers, self.deflection, strict=True)
        ]
        return f"{self.stroke.name}: the top faces are pressed down, {'; '.join(parts)}."


def _caption(endless: bool) -> str:
    text = "The layers at peak load without magnification, the tool's width above them; to turn where JavaScript runs, "
    text += "with faces coloured by deflection and layers taken off by their names. Sideways displacement is not drawn."
    return text + (" Of the last layer only the top face is drawn." if endless else "")


def moving_surface(
    x_mm: NDArray[np.float64], y_mm: NDArray[np.float64], frames_mm: Sequence[NDArray[np.float64]]
) -> bytes:
    """Draw frames of a surface, up is up.

    Parameters
    ----------
    x_mm, y_mm
        (P,) and (Q,) positions in mm.
    frames_mm
        (P, Q) heights in mm, one array a frame.

    Returns
    -------
    bytes
        An animated GIF that repeats.

    Raises
    ------
    ValueError
        If there is no frame, or one of another shape.
    """
    shape = (len(x_mm), len(y_mm))
    if not frames_mm or any(np.shape(frame) != shape for frame in frames_mm):
        raise ValueError(f"a moving surface needs frames of {shape[0]} x {shape[1]} heights")
    from matplotlib.animation import FuncAnimation, PillowWriter
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(SURFACE_WIDTH, SURFACE_HEIGHT), dpi=DPI)
    FigureCanvasAgg(drawing)
    axes = drawing.add_subplot(projection="3d")
    heights = np.stack(frames_mm)
    low, high = min(float(heights.min()), -1e-9), max(float(heights.max()), 0.0)

    def paint(index: int) -> None:
        axes.clear()
        axes.plot_surface(x_mm[:, None], y_mm[None, :], heights[index], cmap="viridis", vmin=low, vmax=high)
        axes.set(xlabel="x, mm", ylabel="y, mm", zlabel="z, mm", zlim=(low, high))

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "surface.gif"
        movie = FuncAnimation(drawing, paint, frames=len(heights), blit=False)
        movie.save(path, writer=PillowWriter(fps=FRAMES_PER_SECOND))
        return path.read_bytes()
