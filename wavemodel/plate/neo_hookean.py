"""The neo-Hookean law of a thin sheet: no stress across it.

W = G/2 (l1^2 + l2^2 + l3^2 - 3 - 2 ln J) + lam/2 (ln J)^2 with the thickness stretch l3 from dW/dl3 = 0, that is
G (l3^2 - 1) + lam ln J = 0. In small strain it is Hooke's law with the same G and lam.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray

NEWTON_STEPS = 8


@dataclass(frozen=True)
class PlaneStress:
    """Answer to the two principal stretches, arrays of one shape.

    Attributes
    ----------
    energy
        Per reference volume, Pa.
    first, second
        Nominal stresses dW/dl1 and dW/dl2, Pa.
    first_first, first_second, second_second
        Their derivatives, Pa.
    """

    energy: FloatArray
    first: FloatArray
    second: FloatArray
    first_first: FloatArray
    first_second: FloatArray
    second_second: FloatArray


def thickness_stretch(area: FloatArray, shear: FloatArray, lame: FloatArray) -> FloatArray:
    """l3 by Newton's method in ln l3, from the small-strain value; `area` is l1 l2."""
    log_area = np.log(area)
    x = -lame / (lame + 2.0 * shear) * log_area
    for _ in range(NEWTON_STEPS):
        square = np.exp(2.0 * x)
        x = x - (shear * (square - 1.0) + lame * (log_area + x)) / (2.0 * shear * square + lame)
    return np.exp(x)


def plane_stress(l1: FloatArray, l2: FloatArray, shear: FloatArray, lame: FloatArray) -> PlaneStress:
    """Energy, nominal stresses and moduli at stretches l1, l2 above zero (any one shape; the moduli broadcast)."""
    l3 = thickness_stretch(l1 * l2, shear, lame)
    log_volume = np.log(l1 * l2 * l3)
    pull = lame * log_volume - shear
    energy = 0.5 * shear * (l1**2 + l2**2 + l3**2 - 3.0 - 2.0 * log_volume) + 0.5 * lame * log_volume**2
    # ln J changes with ln l1 by 1 + d ln l3 / d ln l1 = 2 G l3^2 / (2 G l3^2 + lam).
    rate = lame * 2.0 * shear * l3**2 / (2.0 * shear * l3**2 + lame)
    return PlaneStress(
        energy=energy,
        first=shear * l1 + pull / l1,
        second=shear * l2 + pull / l2,
        first_first=shear + (rate - pull) / l1**2,
        first_second=rate / (l1 * l2),
        second_second=shear + (rate - pull) / l2**2,
    )
