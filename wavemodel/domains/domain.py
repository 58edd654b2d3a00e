"""What a domain is: a window in the plane with eigenfunctions S, lap S = -k^2 S, zero on its border.

Points are counted from the load's place, which need not be the middle of the window.
"""

from typing import Protocol

from wavemodel.arrays import BoolArray, FloatArray


class Tables(Protocol):
    """From amplitudes to the vertices of a grid, by tables made beforehand."""

    def write(self, amplitude: FloatArray, out: FloatArray, *, add: bool) -> None:
        """Write, or add, the deflection under amplitudes (L, K) to `out` (P L, Q), m."""
        ...


class Domain(Protocol):
    """Eigenfunctions with K distinct amplitudes under a load at the place."""

    @property
    def width(self) -> float:
        """How wide the window is, m."""
        ...

    @property
    def modes(self) -> int:
        """N: as many modes in one direction."""
        ...

    @property
    def place(self) -> tuple[float, float]:
        """(x, y) of the load from the middle of the window, m."""
        ...

    @property
    def reach(self) -> float:
        """From the place to the nearest point of the border, m."""
        ...

    @property
    def wavenumber(self) -> FloatArray:
        """(K,) rising, rad/m."""
        ...

    @property
    def lowest(self) -> float:
        """Wavenumber of the first mode, rad/m."""
        ...

    @property
    def pairs(self) -> int:
        """How many eigenfunctions are carried."""
        ...

    @property
    def direction(self) -> FloatArray:
        """(K,) share of each k^2 that runs along x."""
        ...

    @property
    def axis_weight(self) -> FloatArray:
        """(K,) in 1/m2: a field with amplitudes A(k) under a unit load has the value A . weight at the place."""
        ...

    def holds(self, points: FloatArray) -> BoolArray:
        """(P,) whether points (P, 2) are in the window."""
        ...

    def at(self, amplitude: FloatArray, points: FloatArray) -> FloatArray:
        """(L, P) field of amplitudes (L, K) under a unit load, at points (P, 2)."""
        ...

    def gradient(self, amplitude: FloatArray, points: FloatArray) -> FloatArray:
        """(P, 2) slope along x and y of the field of amplitudes (K,), at points (P, 2)."""
        ...

    def tables(self, x: FloatArray, y: FloatArray, layers: int) -> Tables:
        """Tables for vertices at all pairs of x (P,) and y (Q,).

        Raises
        ------
        WaveError
            If a vertex is outside the window.
        """
        ...
