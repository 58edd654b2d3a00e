"""The numbers printed in the paper (Table 1 and eqs. 5 to 8), lengths in mm as there."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray

DEPTH_FACTOR = 14.3321
"""d of eq. (4), mm."""
SIDE = 23.6053
"""a = b, mm."""
SPEED_SQUARED = 85.56
"""c^2, printed without unit; m2/s2."""
SPEED = 9.2496
"""c as printed; it is the root of 85.555 to 85.556, not of 85.56 (9.24986)."""
FREQUENCY = 1.7409
"""lambda_11 as printed: c in m/s over a side in mm, so that its unit is rad/ms."""
COEFFICIENT = 39.2012
"""B_11 as printed, mm."""


@dataclass(frozen=True)
class Parabola:
    """second x^2 + first x + constant, x in mm.

    Attributes
    ----------
    second, first, constant
        In 1/mm2, 1/mm and without unit.
    """

    second: float
    first: float
    constant: float

    def __call__(self, position: FloatArray) -> FloatArray:
        """Value at positions in mm."""
        return np.asarray((self.second * position + self.first) * position + self.constant)


PARABOLA_X = Parabola(-8.393e-6, 0.002, 1.3322)
"""O(x), eq. (5). It was fitted against frame numbers, with its vertex at frame 119, and is used as if x were mm."""
PARABOLA_Y = Parabola(-8.1904e-6, 0.002, 0.9876)
"""p(y), eq. (6), likewise with its vertex at 122."""
