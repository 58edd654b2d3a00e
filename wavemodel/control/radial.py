"""A patch that is round: looked up by the distance from the contact, in memory made beforehand."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.errors import WaveError

RADII = 2048


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
