"""What an edge gives way under its loads, at large turns of the sheet's end.

The sheet turns about the corner of its support, on the face that is held, so what the edge's compliance C relates is
the displacement of the section's point there,

    c(u, phi, w) = (u + z sin(phi), phi, w + z (cos(phi) - 1)) = C p + psi(m) k,

and the loads p that do work on it. The first term is exact layered elasticity of small strain (`edge`). The second is
the softening of the material at the corner of a bonded tool, that no small-strain theory has: an extra turn psi about a
ring inside the tool, k = (0, 1, -x) about the neutral plane, that grows as the cube of the moment m = k . p there,

    psi = A m^3 / (1 + (m / M)^2),      m in units of D / h.

A, M and x / h are three numbers without dimension. They are identified once from finite elements, see
`TOOL_SOFTENING`.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.plate.section import Section


@dataclass(frozen=True)
class Softening:
    """Extra turn of an edge.

    Attributes
    ----------
    rate, moment
        A and M.
    reach
        x over the thickness.
    """

    rate: float
    moment: float
    reach: float

    def turn(self, m: float) -> tuple[float, float, float]:
        """Its potential, psi and the derivative of psi at a moment m."""
        square = (m / self.moment) ** 2
        potential = 0.5 * self.rate * self.moment**2 * (m**2 - self.moment**2 * float(np.log1p(square)))
        psi = self.rate * m**3 / (1.0 + square)
        return potential, psi, self.rate * m**2 * (3.0 + square) / (1.0 + square) ** 2


TOOL_SOFTENING = Softening(rate=1.2, moment=0.5, reach=0.28)
"""Identified from finite-strain finite elements (neo-Hookean, bonded tool, up to 5 N at 400 kPa) of sheets of 1 to 6 mm
over holes of 15 to 30 mm with tools of 2.5 to 10 mm; the same three numbers for all. Without them a 4 mm sheet is 3.5 %
too stiff at 11 mm of depth."""


@dataclass(frozen=True)
class EdgeLaw:
    """Edge of given length, with its loads P as unknowns (over the whole edge: N, N m, N).

    Attributes
    ----------
    compliance
        (3, 3) of the corner's (u, phi, w) per load.
    corner
        z of the held face below the neutral plane, m.
    softening
        Or None.
    lever
        (3,) the moment m per load; psi times it over `unit` is the displacement of the corner.
    unit
        D / h times the length of the edge, N m.
    """

    compliance: FloatArray
    corner: float
    softening: Softening | None
    lever: FloatArray
    unit: float

    def place(self, end: FloatArray, load: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        """Corner (3,) of a sheet's end (u, phi, w), its derivatives (3, 3), and the curvature of load . c by phi."""
        u, phi, w = end
        sin, cos = self.corner * np.sin(phi), self.corner * np.cos(phi)
        slope = np.array([[1.0, cos, 0.0], [0.0, 1.0, 0.0], [0.0, -sin, 1.0]])
        return np.array([u + sin, phi, w + cos - self.corner]), slope, float(-load[0] * sin - load[2] * cos)

    def give(self, load: FloatArray) -> tuple[float, FloatArray, FloatArray]:
        """Complementary energy of loads (3,), the corner's displacement (3,) and its derivatives (3, 3)."""
        moved = self.compliance @ load
        energy, slope = 0.5 * float(load @ moved), self.compliance
        if self.softening is not None:
            potential, psi, rate = self.softening.turn(float(self.lever @ load) / self.unit)
            energy += potential * self.unit
            moved = moved + psi * self.lever
            slope = slope + rate / self.unit * np.outer(self.lever, self.lever)
        return energy, moved, slope


def edge_law(
    compliance: FloatArray, corner: float, radius: float, section: Section, softening: Softening | None = None
) -> EdgeLaw:
    """From the compliance (3, 3) of the neutral plane's end per metre of edge.

    Parameters
    ----------
    compliance
        As in `Edge`.
    corner
        z of the held face below the neutral plane, m.
    radius
        Of the edge, m.
    section
        Of the sheet.
    softening
        Of the material at the corner.
    """
    length = 2.0 * np.pi * radius
    shift = np.array([[1.0, corner, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    lever = shift @ np.array([0.0, 1.0, -softening.reach * section.thickness if softening else 0.0])
    return EdgeLaw(
        shift @ compliance @ shift.T / length, corner, softening, lever, section.bending / section.thickness * length
    )
