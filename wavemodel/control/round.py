"""A body whose patch is a sum of round fields, weighted by the elastic force."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.control.radial import RadialPatch

Number: TypeAlias = Callable[[float], float]


@dataclass(frozen=True)
class RoundBody:
    """A `Body` of a disc-shaped tool.

    Attributes
    ----------
    patch
        The fields.
    weigh
        Writes their weights at an elastic force.
    fields
        How many.
    layers, tool_radius, reach, deepest
        See `Body`.
    force_of, depth_of
        The elastic law and its inverse.
    surface
        (R,) the surface's deflection per newton, evenly spaced up to the reach, where tools add up; else None.
    """

    patch: RadialPatch
    weigh: Callable[[float, FloatArray], None]
    fields: int
    layers: int
    tool_radius: float
    reach: float
    deepest: float
    force_of: Number
    depth_of: Number
    surface: FloatArray | None = None
    _weights: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_weights", np.zeros(self.fields))

    def elastic(self, depth: float) -> float:
        """See `Body.elastic`."""
        return self.force_of(depth)

    def depth(self, elastic: float) -> float:
        """See `Body.depth`."""
        return self.depth_of(elastic)

    def reaction(self, elastic: float) -> float:
        """See `Body.reaction`: the elastic force itself."""
        return elastic

    def between(self, distance: float) -> float:
        """See `Body.between`."""
        if self.surface is None or distance >= self.reach:
            return 0.0
        place = distance / self.reach * (self.surface.size - 1)
        low = int(place)
        here, ahead = float(self.surface[low]), float(self.surface[min(low + 1, self.surface.size - 1)])
        return here + (place - low) * (ahead - here)

    def returning(self, elastic: float, share: float) -> float:
        """See `Body.returning`: the depth falls evenly."""
        return self.force_of((1.0 - share) * self.depth_of(elastic))

    def return_time(self, elastic: float) -> float | None:
        """See `Body.return_time`: its fading memory decides."""
        del elastic
        return None

    def add(self, elastic: float, dx: FloatArray, dy: FloatArray, out: FloatArray) -> None:
        """See `Body.add`."""
        self.weigh(elastic, self._weights)
        self.patch.add(self._weights, dx, dy, out)
