"""The disc with Bessel modes: S = J_n(k r) cos(n theta), zero on the border, theta counted from the load's place.

Under a load in the middle only n = 0 takes part: one mode where the rectangle needs a row of them, and a vertex of a
grid is looked up by its distance, so that the eight vertices that symmetry makes alike are worked out once. Off the
middle every n does. Under a load in the middle the disc has the face of `Endless`, whose integral over k it replaces by
the sum over the roots of J_0(k R) = 0; with R to infinity they are the same.
"""

from dataclasses import dataclass
from functools import cached_property
from math import atan2, hypot

import numpy as np
from scipy.special import jn_zeros, jv

from wavemodel.arrays import BoolArray, FloatArray, IntArray
from wavemodel.errors import NotCoveredError, WaveError, require_positive

MOST_NUMBERS = 1.5e8
"""Of a table: 1.2 GB."""
SAME = 12
"""Decimals of a metre to which vertices equally far from the middle count as one."""


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


@dataclass(frozen=True)
class Disc:
    """Round window with N modes along a radius.

    Attributes
    ----------
    border
        R, m.
    modes
        N: the roots of J_0; of the other n those up to the last of these.
    place
        (x, y) of the load from the middle, m.

    Raises
    ------
    WaveError
        If the border is not positive or there is no mode.
    """

    border: float
    modes: int
    place: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        require_positive("border", self.border, "m")
        if self.modes < 1:
            raise WaveError(f"modes = {self.modes} is not allowed: at least 1")

    @property
    def width(self) -> float:
        """2 R, m."""
        return 2.0 * self.border

    @property
    def reach(self) -> float:
        """From the place to the nearest point of the border, m."""
        return self.border - hypot(*self.place)

    @cached_property
    def _roots(self) -> tuple[IntArray, FloatArray]:
        """(K,) order n and root of J_n of each mode, by rising root."""
        first = jn_zeros(0, self.modes)
        orders, roots = [np.zeros(self.modes, dtype=np.intp)], [first]
        while any(self.place) and roots[-1].size:
            order = len(roots)
            found = jn_zeros(order, self.modes)
            roots.append(found[found <= first[-1]])
            orders.append(np.full(roots[-1].size, order, dtype=np.intp))
        root = np.concatenate(roots)
        rising = np.argsort(root, kind="stable")
        return np.concatenate(orders)[rising], root[rising]

    @property
    def order(self) -> IntArray:
        """(K,) the n of each mode."""
        return self._roots[0]

    @cached_property
    def wavenumber(self) -> FloatArray:
        """(K,) the k with J_n(k R) = 0, rising, rad/m."""
        return np.asarray(self._roots[1] / self.border, dtype=np.float64)

    @property
    def lowest(self) -> float:
        """Wavenumber of the first mode, rad/m."""
        return float(self.wavenumber[0])

    @property
    def pairs(self) -> int:
        """How many modes are carried."""
        return int(self.wavenumber.size)

    @property
    def direction(self) -> FloatArray:
        """Of no mode: a Bessel mode runs in all directions.

        Raises
        ------
        NotCoveredError
            Always.
        """
        raise NotCoveredError(
            "the domain 'disc' does not cover a pretension that differs along x and y; 'rectangle' does"
        )

    @cached_property
    def weight(self) -> FloatArray:
        """(K,) in 1/m2 of S(place) / int S^2 dA: the share of each mode in a unit load."""
        order, k = self._roots[0], self.wavenumber
        area = np.where(order == 0, 1.0, 0.5) * np.pi * (self.border * jv(order + 1, k * self.border)) ** 2
        return np.asarray(jv(order, k * hypot(*self.place)) / area)

    @cached_property
    def axis_weight(self) -> FloatArray:
        """(K,) in 1/m2: a field with amplitudes A(k) under a unit load has the value A . weight at the place."""
        return np.asarray(self.weight * jv(self.order, self.wavenumber * hypot(*self.place)))

    def _polar(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(P, 1) distance from the middle, m, and angle from the direction of the place."""
        x, y = points[:, :1] + self.place[0], points[:, 1:] + self.place[1]
        return np.hypot(x, y), np.arctan2(y, x) - self._turn

    @property
    def _turn(self) -> float:
        return atan2(self.place[1], self.place[0])

    def holds(self, points: FloatArray) -> BoolArray:
        """(P,) whether points (P, 2) from the place, m, are in the disc."""
        return np.asarray(self._polar(points)[0][:, 0] <= self.border)

    def at(self, amplitude: FloatArray, points: FloatArray) -> FloatArray:
        """(L, P) field of amplitudes (L, K) under a unit load, at points (P, 2) from the place, m.

        Raises
        ------
        WaveError
            If a point is outside the disc.
        """
        self._require_inside("disc: a point", points)
        return np.asarray(amplitude @ self._modes(points).T)

    def _modes(self, points: FloatArray) -> FloatArray:
        """(P, K) share of each mode in a unit load times its value, 1/m2."""
        radius, angle = self._polar(points)
        return np.asarray(self.weight * jv(self.order, radius * self.wavenumber) * np.cos(self.order * angle))

    def gradient(self, amplitude: FloatArray, points: FloatArray) -> FloatArray:
        """(P, 2) slope along x and y of the field of amplitudes (K,), at points (P, 2) from the place, m."""
        radius, angle = self._polar(points)
        phase, order, scale = radius * self.wavenumber, self.order, 0.5 * self.weight * self.wavenumber * amplitude
        below, above = jv(order - 1, phase), jv(order + 1, phase)
        outward = ((below - above) * np.cos(order * angle)) @ scale
        around = -((below + above) * np.sin(order * angle)) @ scale
        turn = angle[:, 0] + self._turn
        x, y = np.cos(turn), np.sin(turn)
        return np.stack([outward * x - around * y, outward * y + around * x], axis=1)

    def tables(self, x: FloatArray, y: FloatArray, layers: int) -> BesselTables:
        """Tables for vertices at all pairs of x (P,) and y (Q,) from the place, m.

        Raises
        ------
        WaveError
            If a vertex is outside the disc, or there are too many for a load off the middle.
        """
        points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        self._require_inside("surface: a vertex", points)
        spot = np.arange(points.shape[0])
        if not any(self.place):
            radius, spot = np.unique(np.round(np.hypot(*points.T), SAME), return_inverse=True)
            points = np.stack([radius, np.zeros_like(radius)], axis=1)
        require_room(self.pairs, points.shape[0])
        return bessel_tables(np.ascontiguousarray(self._modes(points).T), spot.reshape(x.size, y.size), layers)

    def _require_inside(self, what: str, points: FloatArray) -> None:
        radius = self._polar(points)[0]
        if not np.all(radius <= self.border * (1.0 + 1e-12)):
            raise WaveError(
                f"{what} is {1e3 * float(radius.max()):g} mm from the middle of the disc, whose border is at "
                f"{self.border * 1e3:g} mm"
            )
