"""Bodies that a tool presses interactively; here the one whose patch is round, a sum of radial fields.

A body gives depth and elastic force, each from the other, and the patch of vertices that they move.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol, TypeAlias

import numpy as np

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.errors import WaveError

RADII = 2048
Number: TypeAlias = Callable[[float], float]


class Body(Protocol):
    """One tool on one tissue; L layers. Depths in m and positive, elastic forces in N."""

    @property
    def layers(self) -> int:
        """L."""
        ...

    @property
    def tool_radius(self) -> float:
        """In m; nought where the tool is a point."""
        ...

    @property
    def reach(self) -> float:
        """Half of the patch's side: vertices further from the contact do not move, m."""
        ...

    @property
    def deepest(self) -> float:
        """Largest depth that the model answers, m."""
        ...

    def elastic(self, depth: float) -> float:
        """Elastic force at a depth."""
        ...

    def depth(self, elastic: float) -> float:
        """Depth under an elastic force."""
        ...

    def reaction(self, elastic: float) -> float:
        """Force on the tool where nothing relaxes, N; NaN where the model has none."""
        ...

    def between(self, distance: float) -> float:
        """Depth that one newton on one tool adds under another so far away, m/N; nought where they do not add up."""
        ...

    def returning(self, elastic: float, share: float) -> float:
        """Elastic force after a share of the way back to rest, 0 to 1."""
        ...

    def return_time(self, elastic: float) -> float | None:
        """Time that the body takes to return by itself, s; None where its relaxation decides."""
        ...

    def add(self, elastic: float, dx: FloatArray, dy: FloatArray, out: FloatArray) -> None:
        """Add the patch to `out` (L, p, q), vertices at dx (p,) and dy (q,) from the contact, m; allocates nothing."""
        ...


def radii_of(reach: float) -> FloatArray:
    """(R,) where a patch is tabulated, m."""
    return np.linspace(0.0, reach, RADII)


@dataclass(frozen=True)
class _Memory:
    table: FloatArray
    slope: FloatArray
    index: IntArray
    distance: FloatArray
    value: FloatArray
    change: FloatArray


class RadialPatch:
    """Sum of B fields with their weights, linear between `RADII` radii, nothing beyond the last.

    Parameters
    ----------
    fields
        (B, L, R) deflection at `radii_of(reach)`, m per weight.
    reach
        In m.
    vertices
        At most so many in a patch.
    """

    def __init__(self, fields: FloatArray, reach: float, vertices: int) -> None:
        count, layers, radii = fields.shape
        whole = fields.copy()
        whole[..., -1] = 0.0
        self._fields = whole.reshape(count, layers * radii)
        self._scale, self._layers = (radii - 1) / reach, layers
        self._memory = _Memory(
            np.empty((layers, radii)),
            np.zeros((layers, radii)),
            np.empty(vertices, dtype=np.intp),
            np.empty(vertices),
            np.empty(layers * vertices),
            np.empty(layers * vertices),
        )

    @property
    def fields(self) -> FloatArray:
        """(B, L, R) at `radii_of(reach)`, m per weight."""
        return self._fields.reshape(-1, self._layers, RADII)

    def add(self, weights: FloatArray, dx: FloatArray, dy: FloatArray, out: FloatArray) -> None:
        """Add the fields times the weights (B,) to `out` (L, p, q); see `Body.add`.

        Raises
        ------
        WaveError
            If there are more vertices than the patch was made for.
        """
        memory, size = self._memory, dx.size * dy.size
        if size > memory.index.size:
            raise WaveError(f"patch: {size} vertices are more than the {memory.index.size} that it was made for")
        np.dot(weights, self._fields, out=memory.table.reshape(-1))
        np.subtract(memory.table[:, 1:], memory.table[:, :-1], out=memory.slope[:, :-1])
        distance, index = memory.distance[:size], memory.index[:size]
        square = distance.reshape(dx.size, dy.size)
        np.multiply(dx[:, None], dx[:, None], out=square)
        square += dy * dy
        np.sqrt(distance, out=distance)
        distance *= self._scale
        np.minimum(distance, RADII - 1.0, out=distance)
        whole = memory.change[:size]
        np.floor(distance, out=whole)
        distance -= whole
        np.copyto(index, whole, casting="unsafe")
        shape = (self._layers, size)
        value, change = (work[: self._layers * size].reshape(shape) for work in (memory.value, memory.change))
        np.take(memory.table, index, axis=1, out=value, mode="clip")
        np.take(memory.slope, index, axis=1, out=change, mode="clip")
        change *= distance
        value += change
        out += value.reshape(out.shape)


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
        """See `Body.return_time`: its relaxation decides."""
        del elastic
        return None

    def add(self, elastic: float, dx: FloatArray, dy: FloatArray, out: FloatArray) -> None:
        """See `Body.add`."""
        self.weigh(elastic, self._weights)
        self.patch.add(self._weights, dx, dy, out)
