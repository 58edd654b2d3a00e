"""What a frame costs beside its load step: a picture of every layer's deflected face."""

from __future__ import annotations

import statistics
import time
from typing import Protocol, runtime_checkable

import numpy as np

from benchmark.models.model_result import Array, Drive, Picture, PreparedModel

VERTICES = 81
REACH = 4.0
"""The faces are squares of 81 x 81 vertices, four tool radii to each side of the axis, or to the model's border."""
FRAMES = 50


@runtime_checkable
class Pictured(Protocol):
    """A model that can draw its faces again and again from tables made beforehand."""

    def picture(self, drive: Drive) -> Picture | None:
        """Make ready to draw the faces at the peak of a load history; None where the model in use cannot."""
        ...


def frame_seconds(prepared: PreparedModel, drive: Drive) -> float | None:
    """Median wall s of a picture at the peak of a load history, tables made before; None of a model without one."""
    picture = prepared.picture(drive) if isinstance(prepared, Pictured) else None
    return None if picture is None else statistics.median(_seconds(picture) for _ in range(FRAMES))


def vertices(tool_radius: float, border: float) -> Array:
    """Positions (P,) of the vertices along one side, m from the tool axis, none beyond the border (m from it)."""
    reach = min(REACH * tool_radius, border)
    return np.linspace(-reach, reach, VERTICES)


def _seconds(picture: Picture) -> float:
    started = time.perf_counter()
    picture()
    return time.perf_counter() - started
