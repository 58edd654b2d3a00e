"""The half-space that every stack looks like at large wavenumbers."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray


@dataclass(frozen=True)
class HalfSpace:
    """Surface compliance of a half-space.

    A traction (T_U, T_W) at wavenumber k moves the surface by [[shear, cross], [cross, normal]] (T_U, T_W) / k
    (Johnson, Contact mechanics, chapter 3).

    Attributes
    ----------
    normal, cross
        (1 - nu) / G and (1 - 2 nu) / (2 G), 1/Pa.
    along
        What stands for `normal` along U where a stress in the plane makes it another, 1/Pa; None: the same.
    """

    normal: float
    cross: float
    along: float | None = None

    @classmethod
    def of(cls, shear_modulus: float, lame_modulus: float) -> "HalfSpace":
        """From the elastic constants, Pa."""
        poisson = 0.5 * lame_modulus / (lame_modulus + shear_modulus)
        return cls((1.0 - poisson) / shear_modulus, (0.5 - poisson) / shear_modulus)

    def times(self, factor: float) -> "HalfSpace":
        """A body so many times as compliant."""
        return HalfSpace(factor * self.normal, factor * self.cross, factor * self.shear)

    @property
    def shear(self) -> float:
        """Along U, 1/Pa."""
        return self.normal if self.along is None else self.along

    @property
    def matrix(self) -> FloatArray:
        """(2, 2) k times the compliance, 1/Pa."""
        return np.array([[self.shear, self.cross], [self.cross, self.normal]])
