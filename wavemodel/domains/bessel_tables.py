"""The disc's modes at the vertices of a grid, in memory made beforehand.

Under a load in the middle a vertex is looked up by its distance, so that the eight vertices that symmetry makes alike
are worked out once.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.errors import WaveError

MOST_NUMBERS = 1.5e8
"""Of a table: 1.2 GB."""


@dataclass(frozen=True)
class BesselTables:
    """Tables of P by Q vertices, U of them different, for L layers.

    Attributes
    ----------
    modes
        (K, U) share of each mode in a unit load times its value, 1/m2.
    index
        (P L, Q) which of the L U values a vertex of a layer has.
    value, part
        (L, U) and (P L, Q) work arrays.
    """

    modes: FloatArray
    index: IntArray
    value: FloatArray
    part: FloatArray

    def write(self, amplitude: FloatArray, out: FloatArray, *, add: bool) -> None:
        """See `Tables.write`."""
        np.dot(amplitude, self.modes, out=self.value)
        np.take(self.value.ravel(), self.index, out=self.part if add else out, mode="clip")
        if add:
            np.add(out, self.part, out=out)


def bessel_tables(modes: FloatArray, spot: IntArray, layers: int) -> BesselTables:
    """Prepare tables.

    Parameters
    ----------
    modes
        (K, U) of the U different vertices.
    spot
        (P, Q) which of them each vertex is.
    layers
        L.
    """
    count = modes.shape[1]
    index = spot[:, None, :] + count * np.arange(layers)[:, None]
    rows = np.ascontiguousarray(index.reshape(-1, spot.shape[1]))
    return BesselTables(modes, rows, np.empty((layers, count)), np.empty(rows.shape))


def require_room(modes: int, vertices: int) -> None:
    """Refuse a table that would not fit in memory.

    Raises
    ------
    WaveError
        If it has more than `MOST_NUMBERS`.
    """
    if modes * vertices > MOST_NUMBERS:
        raise WaveError(
            f"surface: {vertices} different vertices times {modes} modes of the disc are more than "
            f"{MOST_NUMBERS:.3g} numbers; take fewer, a tool in the middle, or the domain 'rectangle'"
        )
