"""What a uniform pressure works on: the mean deflection of the upper face over a disc.

The face lies above the neutral plane: as the section turns and thins it comes down further than the plane does, and
where the sheet is bent it bulges.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.plate.radial import RadialFunctions
from wavemodel.plate.section import Section
from wavemodel.plate.strain_energy import vertical_span


@dataclass(frozen=True)
class Pressure:
    """A pressure of unit force.

    Attributes
    ----------
    radius, share
        (p,) points in the disc, m, and their shares of its area.
    strains
        (5, p, n) table.
    linear
        (n,) mean of w and of the bulge per coefficient.
    face
        z of the upper face below the neutral plane, m (negative).
    thinning
        Exponent of the thickness stretch.
    """

    radius: FloatArray
    share: FloatArray
    strains: FloatArray
    linear: FloatArray
    face: float
    thinning: float

    def mean_deflection(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Its derivatives (n,) and (n, n) by the coefficients (n,)."""
        upright = vertical_span(self.thinning, self.radius, self.strains @ q)
        weight = self.face * self.share
        turned = np.einsum("ijp,jpn->ipn", upright.hessian * weight, self.strains)
        first = self.linear + np.einsum("ip,ipn->n", upright.gradient * weight, self.strains)
        return first, self.strains.reshape(-1, q.size).T @ turned.reshape(-1, q.size)


def pressure(functions: RadialFunctions, radius: float, section: Section, bulge: float) -> Pressure:
    """Set up a pressure.

    Parameters
    ----------
    functions
        Of the sheet.
    radius
        Of the disc, m.
    section
        Of the sheet.
    bulge
        Deflection of the upper face per curvature, m2.
    """
    point, weight = np.polynomial.legendre.leggauss(2 * functions.count)
    r = 0.5 * radius * (point + 1.0)
    share = weight * r / (weight @ r)
    value, strain = functions.displacement(r), functions.strains(r)
    linear = share @ (value[2] + bulge * (strain[4] + value[1] / r[:, None]))
    return Pressure(r, share, strain, linear, float(section.faces[0]), section.thinning)
