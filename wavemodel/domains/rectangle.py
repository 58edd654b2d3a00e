"""The rectangle with sines, eq. (2) of the paper: S = sin(m pi x / a) sin(n pi y / b), zero on the border.

Here are the eigenfunctions, their wavenumbers, the projection of a load and the synthesis of a field, on a grid of
vertices as U = Sx A Sy' per layer in memory made beforehand. The origin of positions handed in is the place of the
load, by default the centre of the rectangle.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg.blas import dgemm

from wavemodel.arrays import BoolArray, FloatArray, IntArray
from wavemodel.errors import WaveError, require_positive


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


@dataclass(frozen=True)
class Rectangle:
    """Window with N x N sine modes, of which those below a wavenumber are carried.

    Attributes
    ----------
    width, height
        a and b, m.
    modes
        N: m, n = 1..N.
    symmetric
        Whether only what is symmetric about both centre lines is wanted; then only odd m and n take part.
    cutoff
        Modes with a larger wavenumber (rad/m) are left out.
    directed
        Whether modes of one wavenumber but of different directions count as different.
    place
        (x, y) of the load from the centre, m. Off the centre nothing is symmetric.

    Raises
    ------
    WaveError
        If a side is not positive or there is no mode.
    """

    width: float
    height: float
    modes: int
    symmetric: bool = True
    cutoff: float = np.inf
    directed: bool = False
    place: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        require_positive("window", self.width, "m")
        require_positive("window", self.height, "m")
        if self.modes < 1:
            raise WaveError(f"modes = {self.modes} is not allowed: at least 1")

    @cached_property
    def order(self) -> IntArray:
        """(M,) the m (and n) that take part."""
        every_other = self.symmetric and not any(self.place)
        return np.arange(1, self.modes + 1, 2 if every_other else 1, dtype=np.intp)

    @cached_property
    def _square(self) -> FloatArray:
        """(M, M) k^2 of every pair."""
        kx, ky = self.order * np.pi / self.width, self.order * np.pi / self.height
        square: FloatArray = kx[:, None] ** 2 + ky**2
        return square

    @cached_property
    def _distinct(self) -> tuple[FloatArray, IntArray]:
        square, kx = self._square, self.order * np.pi / self.width
        unit = (np.pi / max(self.width, self.height)) ** 2
        keys, along = np.round(square / unit, 6), np.round(kx[:, None] ** 2 / unit, 6)
        _, first, index = np.unique(
            keys + 1j * along if self.directed else keys, return_index=True, return_inverse=True
        )
        wavenumber = np.sqrt(square.ravel()[first])
        kept = int(np.searchsorted(wavenumber, self.cutoff, side="right"))
        return wavenumber[:kept], np.minimum(index, kept).reshape(square.shape)

    @property
    def wavenumber(self) -> FloatArray:
        """(K,) the distinct k = pi sqrt(m^2/a^2 + n^2/b^2) that are carried, rising, rad/m."""
        return self._distinct[0]

    @property
    def direction(self) -> FloatArray:
        """(K,) share kx^2 / k^2 of each carried wavenumber that runs along x (of the first such mode)."""
        share = (self.order[:, None] * np.pi / self.width) ** 2 / self._square
        index = self._distinct[1]
        out = np.empty(self.wavenumber.size + 1)
        out[index.ravel()[::-1]] = share.ravel()[::-1]
        return out[:-1]

    @property
    def lowest(self) -> float:
        """Wavenumber of the first mode, m = n = 1, rad/m."""
        return float(np.hypot(np.pi / self.width, np.pi / self.height))

    @property
    def pair_index(self) -> IntArray:
        """(M, M) which wavenumber a pair (m, n) has; K where it is not carried."""
        return self._distinct[1]

    @property
    def pairs(self) -> int:
        """How many pairs (m, n) are carried."""
        return int(np.count_nonzero(self._distinct[1] < self.wavenumber.size))

    def sines(self, position: FloatArray, axis: int = 0) -> FloatArray:
        """(P, M) table of sin(m pi x / a) at positions (P,) from the load's place, m."""
        return self.waves(position, axis)[0]

    def waves(self, position: FloatArray, axis: int) -> tuple[FloatArray, FloatArray]:
        """(P, M) sin(m pi x / a) and its slope in 1/m, at positions (P,) from the load's place, m."""
        side = (self.width, self.height)[axis]
        phase = np.outer((position + self.place[axis]) / side + 0.5, self.order * np.pi)
        return np.sin(phase), np.cos(phase) * (self.order * np.pi / side)

    def _inside(self, position: FloatArray, axis: int) -> BoolArray:
        return np.asarray(np.abs(position + self.place[axis]) <= 0.5 * (self.width, self.height)[axis])

    def holds(self, points: FloatArray) -> BoolArray:
        """(P,) whether points (P, 2) from the load's place, m, are in the window."""
        return self._inside(points[:, 0], axis=0) & self._inside(points[:, 1], axis=1)

    @property
    def reach(self) -> float:
        """From the place to the nearest point of the border, m."""
        return min(0.5 * self.width - abs(self.place[0]), 0.5 * self.height - abs(self.place[1]))

    def spread(self, amplitude: FloatArray) -> FloatArray:
        """Give every pair (m, n) the amplitude of its wavenumber: (..., K) to (..., M, M)."""
        padded = np.concatenate([amplitude, np.zeros((*amplitude.shape[:-1], 1))], axis=-1)
        spread: FloatArray = padded[..., self._distinct[1]]
        return spread

    def participation(self, x: float = 0.0, y: float = 0.0) -> FloatArray:
        """(M, M) of S / int S^2 dA in 1/m2: the share of each mode in a unit load (x, y) away from the place."""
        share: FloatArray = np.outer(self.sines(np.array([x]))[0], self.sines(np.array([y]), axis=1)[0])
        return share * (4.0 / (self.width * self.height))

    @cached_property
    def share(self) -> FloatArray:
        """(M, M) share of each mode in a unit load at the place, 1/m2."""
        return self.participation()

    def at(self, amplitude: FloatArray, points: FloatArray) -> FloatArray:
        """(L, P) field of amplitudes (L, K) under a unit load, at points (P, 2) from the place, m."""
        modes = self.spread(amplitude) * self.share
        along_y = self.sines(points[:, 1], axis=1)
        return np.asarray(np.einsum("lpn,pn->lp", self.sines(points[:, 0]) @ modes, along_y))

    def gradient(self, amplitude: FloatArray, points: FloatArray) -> FloatArray:
        """(P, 2) slope along x and y of the field of amplitudes (K,), at points (P, 2) from the place, m."""
        modes = self.spread(amplitude) * self.share
        (sine_x, slope_x), (sine_y, slope_y) = (self.waves(points[:, axis], axis) for axis in (0, 1))
        along_x = np.einsum("pm,pm->p", slope_x @ modes, sine_y)
        along_y = np.einsum("pm,pm->p", sine_x @ modes, slope_y)
        return np.stack([along_x, along_y], axis=1)

    def tables(self, x: FloatArray, y: FloatArray, layers: int) -> SineTables:
        """Tables for vertices at all pairs of x (P,) and y (Q,) from the place, m.

        Raises
        ------
        WaveError
            If a vertex lies outside the window.
        """
        for axis, name, position, side in ((0, "x", x, self.width), (1, "y", y, self.height)):
            if not self._inside(position, axis).all():
                place = f" of a point {-self.place[axis] * 1e3:g} mm from it" if any(self.place) else ""
                raise WaveError(
                    f"surface: {name} reaches {np.abs(position).max() * 1e3:g} mm from the tool axis, outside the "
                    f"window of {side * 1e3:g} mm (half of it to each side{place})"
                )
        sines = self.sines(x), self.sines(y, axis=1)
        return sine_tables(sines, self.pair_index, self.wavenumber.size, self.share, layers)

    @cached_property
    def axis_weight(self) -> FloatArray:
        """(K,) in 1/m2: a field with amplitudes A(k) under a centred unit load has the value A . weight there."""
        index = self._distinct[1]
        weight = self.share * np.outer(self.sines(np.zeros(1))[0], self.sines(np.zeros(1), axis=1)[0])
        kept = self.wavenumber.size
        return np.asarray(np.bincount(index.ravel(), weight.ravel(), kept + 1)[:kept], dtype=np.float64)
