"""What the faces of the layers do in a state of the sheet: from unknowns to numbers at points.

A pressure dents the face that it acts on beyond the bending and shear of the sheet. In small strain that is the layered
elasticity of the sheet with both faces free, less what the plate already has:

    w_face(k) - (1 + top k^2) (1 + bulge k^2) / (D k^4) - 1 / (S k^2),

with the bulge of that face and of the top one, on which the pressure works. The plate's terms cancel at small k; what
is left is as local as the sheet is thin.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.domains.domain import Endless, endless
from wavemodel.layered.stack.compliance import every_face, exact_faces
from wavemodel.layered.stack.laminate import laminate
from wavemodel.layered.tractions import HalfSpace, UniformPressure
from wavemodel.sheet.edge import Edge
from wavemodel.sheet.section import SheetSection
from wavemodel.sheet.sheet import Sheet, face_bulge
from wavemodel.specimen import DiscTool, WaveLayer

SMALLEST = 0.15
"""k h below which the difference is taken as constant: it is, and the digits of its terms cancel."""
SHARPEST, REACH = 400.0, 3.0


@dataclass(frozen=True)
class Indentation:
    """Answer to a pressure of unit force.

    Attributes
    ----------
    spectrum
        q wavenumbers.
    faces
        (q, L + 1) deflection of the faces, m/Pa, less the half-space's on the surface.
    load
        UniformPressure of the tool.
    body
        The half-space.
    reach
        Beyond this radius (m) there is none.
    """

    spectrum: Endless
    faces: FloatArray
    load: UniformPressure
    body: HalfSpace
    reach: float

    def deflection(self, radius: FloatArray) -> FloatArray:
        """(L + 1, R) per force at radii (R,), m/N."""
        near = np.minimum(radius, self.reach)
        transform = self.load.transform(self.spectrum.wavenumber)[:, 0, 1]
        out = self.spectrum.at_radius(self.faces.T * transform, near)
        out[0] += self.load.half_space_deflection(self.body, near)[:, 0]
        out[:, radius > self.reach] = 0.0
        return out


def indentation(layers: Sequence[WaveLayer], section: SheetSection, bulge: FloatArray, radius: float) -> Indentation:
    """Set up the indentation under a pressure on a disc.

    Parameters
    ----------
    layers, section
        The sheet.
    bulge
        (L + 1,) deflection of the faces per curvature, m2.
    radius
        Of the disc, m.
    """
    stack = laminate(layers, [(1.0,)] * len(layers), "free")
    reach = radius + REACH * section.thickness
    spectrum = endless(max(SHARPEST / radius, 30.0 / section.thickness), reach + radius)
    k = spectrum.wavenumber
    resolved = np.maximum(k, SMALLEST / section.thickness)
    exact = every_face(stack, exact_faces(resolved, stack))[:, :, 1, 1]
    square = resolved[:, None] ** 2
    bent = (1.0 + bulge[0] * square) * (1.0 + bulge * square) / (section.bending * square**2)
    faces = exact - bent - 1.0 / (section.shear * square)
    body = HalfSpace.of(float(stack.shear_modulus[0]), float(stack.lame_modulus[0]))
    faces[:, 0] -= body.normal / k
    return Indentation(spectrum, faces, UniformPressure(radius), body, reach)


@dataclass(frozen=True)
class Faces:
    """Displacement of the L + 1 faces of the layers, from the surface to the lower face.

    To the sheet's own displacement come the thinning by bending, which bulges a face by (z^2 / 2 - mean) nu / (1 - nu)
    times the curvature, and the waves that decay from the edges. Under a bonded tool there are only such waves.

    Attributes
    ----------
    sheet
        The sheet.
    dent
        What a pressure adds; None under a rigid tool.
    """

    sheet: Sheet
    dent: Indentation | None = None

    def displacement(self, state: FloatArray, depth: float, radius: FloatArray, force: float = 0.0) -> FloatArray:
        """(2, L + 1, R): outwards and downwards, m, at radii (R,) from nought to the hole's edge.

        Parameters
        ----------
        state
            Unknowns of the sheet.
        depth, force
            Of a rigid tool (m), and of a pressure (N).
        radius
            In m.
        """
        inner = self.sheet.functions.inner
        free = radius >= inner
        out = np.empty((2, self.sheet.section.faces.size, radius.size))
        out[..., free] = self._free(state, radius[free])
        out[..., ~free] = self._under_tool(state, depth, radius[~free])
        if self.dent is not None:
            out[1] += force * (self.dent.deflection(radius) if radius.any() else self._axis_dent)
        return out

    @cached_property
    def _axis_dent(self) -> FloatArray:
        """(L + 1, 1) per force on the axis, m/N."""
        return np.zeros((1, 1)) if self.dent is None else self.dent.deflection(np.zeros(1))

    def linear(self, radius: FloatArray) -> FloatArray:
        """(2, L + 1, R, N + 1): the same for small deflections, per unknown and, last, per depth of a rigid tool."""
        sheet, n = self.sheet, self.sheet.functions.unknowns
        free = radius >= sheet.functions.inner
        r = np.maximum(radius, 1e-9 * sheet.functions.outer)
        out = np.zeros((2, sheet.section.faces.size, radius.size, sheet.unknowns + 1))
        u, phi, w = sheet.functions.displacement(r)
        along, ring, _, _, bend = sheet.functions.strains(r)
        z = sheet.section.faces[:, None, None]
        thinned = z * sheet.section.thinning * (along + ring)
        bulged = self.bulge[:, None, None] * (bend + phi / r[:, None])
        out[0, ..., :n], out[1, ..., :n] = u + z * phi, w + bulged - thinned
        out[:, :, ~free] = 0.0
        out[1, :, ~free, -1] = 1.0
        for i, edge in enumerate(self._edges):
            sides = ((free, edge.before), (~free, edge.behind)) if i == 1 else ((free, edge.before),)
            for j, load in enumerate(self._unit_loads(i)):
                for side, field in sides:
                    for k, node in enumerate(self._nodes[i].tolist()):
                        out[:, k, side, n + 3 * i + j] += field(node, load, radius[side])
        return out

    def _unit_loads(self, edge: int) -> FloatArray:
        """(3, 3): loads per metre on the neutral plane's end for each unit load on the corner of a flat sheet."""
        slope = self.sheet.laws[edge].place(np.zeros(3), np.zeros(3))[1]
        return np.asarray(slope / (2.0 * np.pi * self._edges[edge].radius))

    def _free(self, state: FloatArray, radius: FloatArray) -> FloatArray:
        sheet = self.sheet
        r = np.maximum(radius, 1e-9 * sheet.functions.outer)
        q = state[: sheet.functions.unknowns]
        u, phi, w = sheet.functions.displacement(r) @ q
        along, ring, fall, _, bend = sheet.functions.strains(r) @ q
        thin = (((1.0 + along) * np.cos(phi) - fall * np.sin(phi)) * (1.0 + ring)) ** -sheet.section.thinning
        z = sheet.section.faces[:, None]
        bulge = self.bulge[:, None] * (bend + phi / r)
        out = np.stack([u + z * thin * np.sin(phi), w + z * (thin * np.cos(phi) - 1.0) + bulge])
        for i, edge in enumerate(self._edges):
            load = self._load(state, i)
            for j, node in enumerate(self._nodes[i].tolist()):
                out[:, j] += edge.before(node, load, radius)
        return out

    def _under_tool(self, state: FloatArray, depth: float, radius: FloatArray) -> FloatArray:
        """Stuck to the tool above, moved by the waves of the edge below."""
        out = np.zeros((2, self.sheet.section.faces.size, radius.size))
        if self.sheet.tool is None or radius.size == 0:
            return out
        out[1] = depth
        load = self._load(state, 1)
        for j, node in enumerate(self._nodes[1].tolist()):
            out[:, j] += self.sheet.tool.behind(node, load, radius)
        return out

    def _load(self, state: FloatArray, edge: int) -> FloatArray:
        """(3,) loads per metre of edge along (u, phi, w) of the neutral plane's end."""
        n = self.sheet.functions.unknowns
        q, load = state[:n], state[n + 3 * edge : n + 3 * edge + 3]
        slope = self.sheet.laws[edge].place(self.sheet.ends[edge] @ q, load)[1]
        return np.asarray(slope.T @ load / (2.0 * np.pi * self._edges[edge].radius))

    @property
    def _edges(self) -> tuple[Edge, ...]:
        both = (self.sheet.clamp, self.sheet.tool)
        return tuple(edge for edge in both if edge is not None)

    @cached_property
    def _nodes(self) -> tuple[IntArray, ...]:
        """For each edge the nodes of its strip on the faces."""
        return tuple(edge.strip.nodes(self.sheet.section.faces) for edge in self._edges)

    @cached_property
    def bulge(self) -> FloatArray:
        """(L + 1,) deflection of the faces per curvature, m2."""
        return face_bulge(self.sheet.clamp, self.sheet.section)


def faces_of(layers: Sequence[WaveLayer], tool: DiscTool, sheet: Sheet) -> Faces:
    """The faces of a sheet under a tool."""
    plain = Faces(sheet)
    return plain if tool.rigid else Faces(sheet, indentation(layers, sheet.section, plain.bulge, tool.radius))
