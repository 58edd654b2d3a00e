"""The elastic edges of a sheet: where a support that holds one of its faces ends.

A clamp on the lower face outside a hole, or a tool on the upper face, holds a face and not the section: behind the edge
the sheet still turns, slides and sinks. In small strain that is exact layered elasticity: waves that decay on both
sides of the edge are matched to the plate between tool and clamp, with no displacement of the held face and no traction
on what is free. What follows is the compliance of the edge, the (u, phi, w) of the plate's end under the loads that it
puts on the edge; the plate in between is then clamped elastically instead of stiffly.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.plate.end_waves import EndWaves
from wavemodel.plate.section import Section
from wavemodel.plate.strip import ComplexArray, Strip, strip
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


def clamp(layers: Sequence[WaveLayer], section: Section, radius: float) -> Edge:
    """Lower face held outside a hole of the given radius, m."""
    through = strip(layers, section.faces, "bottom")
    last = 2 * through.z.size - 1
    return _edge(through, radius, 1.0, np.array([last - 1, last]))


def tool_edge(layers: Sequence[WaveLayer], section: Section, radius: float, contact: str) -> Edge:
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
