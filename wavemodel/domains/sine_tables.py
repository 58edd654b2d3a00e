"""The rectangle's modes at the vertices of a grid: U = Sx A Sy' per layer, in memory made beforehand."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg.blas import dgemm

from wavemodel.arrays import FloatArray, IntArray


@dataclass(frozen=True)
class SineTables:
    """Tables of P by Q vertices for L layers.

    Attributes
    ----------
    sines_x, sines_y
        (P, M) and (M, Q).
    place, share
        (M, L M) where in the amplitudes each mode of each layer is, and its share; nought where it is not carried.
    modal
        (M, L M) amplitudes of the modes.
    half, rows
        (P, L M) half-way sums, and the same memory as (P L, M).
    """

    sines_x: FloatArray
    sines_y: FloatArray
    place: IntArray
    share: FloatArray
    modal: FloatArray
    half: FloatArray
    rows: FloatArray

    def write(self, amplitude: FloatArray, out: FloatArray, *, add: bool) -> None:
        """See `Tables.write`."""
        np.take(amplitude.ravel(), self.place, out=self.modal, mode="clip")
        np.multiply(self.modal, self.share, out=self.modal)
        np.dot(self.sines_x, self.modal, out=self.half)
        # Column-major BLAS sees everything transposed: out' = Sy' half' + out', in one pass over the result.
        dgemm(1.0, self.sines_y.T, self.rows.T, float(add), out.T, overwrite_c=1)


def sine_tables(
    sines: tuple[FloatArray, FloatArray], pair_index: IntArray, kept: int, share: FloatArray, layers: int
) -> SineTables:
    """Prepare tables.

    Parameters
    ----------
    sines
        (P, M) and (Q, M) of the two directions.
    pair_index
        (M, M) which of the `kept` amplitudes each mode has; `kept` where it is not carried.
    kept
        K.
    share
        (M, M) share of each mode in a unit load, 1/m2.
    layers
        L.
    """
    count = pair_index.shape[0]
    place = np.arange(layers)[:, None] * kept + np.minimum(pair_index, kept - 1)[:, None, :]
    shares = np.broadcast_to((share * (pair_index < kept))[:, None, :], place.shape)
    half = np.empty((sines[0].shape[0], layers * count))
    return SineTables(
        sines[0],
        np.ascontiguousarray(sines[1].T),
        np.ascontiguousarray(place.reshape(count, -1)),
        np.ascontiguousarray(shares.reshape(count, -1)),
        np.empty((count, layers * count)),
        half,
        half.reshape(-1, count),
    )
