"""A surface that moves: frames of deflection to an animated GIF."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

WIDTH, HEIGHT, DPI = 4.2, 3.4, 80
FRAMES_PER_SECOND = 12


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

    drawing = Figure(figsize=(WIDTH, HEIGHT), dpi=DPI)
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
