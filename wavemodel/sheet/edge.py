"""The elastic edges of a sheet: where a support that holds one of its faces ends.

A clamp on the lower face outside a hole, or a tool on the upper face, holds a face and not the section: behind the edge
the sheet still turns, slides and sinks. In small strain that is exact layered elasticity: waves that decay on both
sides of the edge are matched to the plate between tool and clamp, with no displacement of the held face and no traction
on what is free. What follows is the compliance of the edge, the (u, phi, w) of the plate's end under the loads that it
puts on the edge; the plate in between is then clamped elastically instead of stiffly.

At large turns the sheet turns about the corner of its support, on the face that is held, so what the edge's compliance
C relates is the displacement of the section's point there,

    c(u, phi, w) = (u + z sin(phi), phi, w + z (cos(phi) - 1)) = C p + psi(m) k,

and the loads p that do work on it. The second term is the softening of the material at the corner of a bonded tool,
that no small-strain theory has: an extra turn psi about a ring inside the tool, k = (0, 1, -x) about the neutral plane,
that grows as the cube of the moment m = k . p there,

    psi = A m^3 / (1 + (m / M)^2),      m in units of D / h.

A, M and x / h are three numbers without dimension, identified once from finite elements: `TOOL_SOFTENING`.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.sheet.end_waves import ComplexArray, EndWaves, Strip, strip
from wavemodel.sheet.section import SheetSection
from wavemodel.specimen import WaveLayer


@dataclass(frozen=True)
class Edge:
    """An edge of the support.

    Attributes
    ----------
    radius
        In m.
    compliance
        (3, 3) of (u, phi, w) under loads along them, each per metre of edge.
    strip
        Nodes through the thickness.
    sheet, held
        Waves in the free part (on top of the plate's displacement) and behind the edge.
    sheet_amplitude, held_amplitude
        (m, 3) of the waves per load.
    stretch
        (3,) in-plane stretch u / r of the disc under a tool without friction, per load; zero elsewhere.
    """

    radius: float
    compliance: FloatArray
    strip: Strip
    sheet: EndWaves
    held: EndWaves
    sheet_amplitude: ComplexArray
    held_amplitude: ComplexArray
    stretch: FloatArray

    def behind(self, node: int, load: FloatArray, radius: FloatArray) -> FloatArray:
        """(2, R) outward and downward displacement of a node behind the edge under a load (3,) per metre."""
        moved = self.held.displacement(node, radius, self.held_amplitude @ load)
        moved[0] += self.stretch @ load * radius
        moved[1] += self.stretch @ load * _stretched(self.strip)[2 * node + 1]
        return moved

    def before(self, node: int, load: FloatArray, radius: FloatArray) -> FloatArray:
        """(2, R) what the waves add to the plate's displacement in the free part."""
        return self.sheet.displacement(node, radius, self.sheet_amplitude @ load)


def clamp(layers: Sequence[WaveLayer], section: SheetSection, radius: float) -> Edge:
    """Lower face held outside a hole of the given radius, m."""
    through = strip(layers, section.faces, "bottom")
    last = 2 * through.z.size - 1
    return _edge(through, radius, 1.0, np.array([last - 1, last]))


def tool_edge(layers: Sequence[WaveLayer], section: SheetSection, radius: float, contact: str) -> Edge:
    """Upper face under a flat tool of the given radius (m), "rigid_bonded" or "rigid_frictionless"."""
    through = strip(layers, section.faces, "top")
    return _edge(through, radius, -1.0, np.array([0, 1] if contact == "rigid_bonded" else [1]))


def _edge(through: Strip, radius: float, sign: float, fixed: IntArray) -> Edge:
    """Match both sides; `sign` is 1 where the free part lies inside (a clamp), -1 where it lies outside (a tool)."""
    size, slides = 2 * through.z.size, fixed.size == 1
    free = np.setdiff1d(np.arange(size), fixed)
    sheet = EndWaves(*through.end_waves(np.arange(size), 3), radius, sign < 0.0)
    held = EndWaves(*through.end_waves(free, 1 if slides else 0), radius, sign > 0.0)
    plate, before, behind = plate_at(through, radius), sheet.at_edge(through), held.at_edge(through)
    if slides:
        stretched = _stretch_at(through, radius)
        behind = np.column_stack([behind[0], stretched[0]]), np.column_stack([behind[1], stretched[1]])
    # Displacements agree everywhere, nodal forces where the face is not held; loads act on the edge.
    unknown = np.block(
        [[plate[0][:, :3], before[0], -behind[0]], [plate[1][free, :3], before[1][free], -behind[1][free]]]
    )
    known = sign * np.concatenate([plate[0][:, 3:], plate[1][free, 3:]])
    scale = np.abs(unknown).max(axis=0)
    solved = np.linalg.solve(unknown / scale, known) / scale[:, None] / through.scale
    waves, compliance = 3 + sheet.root.size, solved[:3].real
    return Edge(
        radius=radius,
        compliance=0.5 * (compliance + compliance.T),
        strip=through,
        sheet=sheet,
        held=held,
        sheet_amplitude=solved[3:waves],
        held_amplitude=solved[waves : waves + held.root.size],
        stretch=solved[-1].real if slides else np.zeros(3),
    )


def plate_at(through: Strip, radius: float) -> tuple[FloatArray, FloatArray]:
    """Displacement and nodal forces (2n, 6) of the plate's solutions with one of u, phi, w, N, M, Q at the radius.

    From w = p0 S + p2 lap S, u = (p1 S + p3 lap S)' for four S with lap lap S = 0, and u = i0 S', w = i1 lap S for two
    with a constant lap S.
    """
    p0, p1, p2, p3, i0, i1 = through.chain
    bending = [(1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, radius / 2.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0)]
    moved = [p0 * s + p1 * ds + p2 * lap + p3 * dlap for s, ds, lap, dlap in bending]
    rates = [p0 * ds + p1 * lap + p2 * dlap for _, ds, lap, dlap in bending]
    for slope, lap in ((radius / 2.0, 1.0), (1.0, 0.0)):
        moved.append(i0 * slope + i1 * lap)
        rates.append(i0 * lap)
    displacement = np.stack(moved, axis=-1)
    forces = through.traction(displacement, np.stack(rates, axis=-1), radius)
    flat = through.horizontal.astype(np.float64)
    resultants = np.stack([flat, flat * np.repeat(through.z, 2), 1.0 - flat])
    ends = np.concatenate([through.resultant_weights @ displacement, resultants @ forces])
    change = np.linalg.inv(ends)
    return displacement @ change, forces @ change


def _stretched(through: Strip) -> FloatArray:
    """(2n,) displacement of a disc stretched by u = r at r = 1, its upper face at rest in w."""
    i0, i1 = through.chain[4:]
    return np.asarray(i0 + 2.0 * (i1 - i1[1] * (1.0 - i0)))


def _stretch_at(through: Strip, radius: float) -> tuple[FloatArray, FloatArray]:
    """Displacement and nodal forces (2n,) of that disc at its edge."""
    i0 = through.chain[4]
    displacement = np.where(through.horizontal, radius * i0, _stretched(through))
    return displacement, through.traction(displacement, 2.0 * i0, radius)


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
    compliance: FloatArray, corner: float, radius: float, section: SheetSection, softening: Softening | None = None
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
