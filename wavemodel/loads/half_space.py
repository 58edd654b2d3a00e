"""The half-space that every stack looks like at large wavenumbers."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray


@dataclass(frozen=True)
class HalfSpace:
    """Surface compliance of a half-space.

    A traction (T_U, T_W) at wavenumber k moves the surface by [[normal, cross], [cross, normal]] (T_U, T_W) / k
    (Johnson, Contact mechanics, chapter 3).

    Attributes
    ----------
    normal, cross
        (1 - nu) / G and (1 - 2 nu) / (2 G), 1/Pa.
    """

    normal: float
    cross: float

    @classmethod
    def of(cls, shear_modulus: float, lame_modulus: float) -> "HalfSpace":
        """From the elastic constants, Pa."""
        poisson = 0.5 * lame_modulus / (lame_modulus + shear_modulus)
        return cls((1.0 - poisson) / shear_modulus, (0.5 - poisson) / shear_modulus)

    @property
    def matrix(self) -> FloatArray:
        """(2, 2) k times the compliance, 1/Pa."""
        return np.array([[self.normal, self.cross], [self.cross, self.normal]])
