"""The whole sheet and what its unknowns must fulfil: the free part, its edges, and the force on it.

Unknowns are the coefficients q of u, w and phi and the loads P on the edges. With the sheet's energy V and the edges'
complementary energy G they make, w being the mean deflection under a pressure,

    V(q) + sum over edges P . (c(q) - support) - G(P) - force * w(q)

stationary. No compliance is inverted, so an edge may also be stiff. A uniform pressure works on the mean deflection of
the upper face over a disc. That face lies above the neutral plane: as the section turns and thins it comes down further
than the plane does, and where the sheet is bent it bulges.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.sheet.edge import TOOL_SOFTENING, Edge, EdgeLaw, clamp, edge_law, tool_edge
from wavemodel.sheet.radial import RadialFunctions
from wavemodel.sheet.section import SheetSection, section
from wavemodel.sheet.strain_energy import energy_density, vertical_span
from wavemodel.specimen import DiscTool, WaveLayer


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


def pressure(functions: RadialFunctions, radius: float, section: SheetSection, bulge: float) -> Pressure:
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


@dataclass(frozen=True)
class Sheet:
    """A sheet over a hole under one tool.

    Attributes
    ----------
    section
        Its cross-section.
    functions
        Radial functions of the free part, n unknowns in all.
    clamp, tool
        Edges; no `tool` under a pressure.
    laws
        What the edges give way, the clamp first.
    pretension
        In N/m.
    radius, weight
        (p,) points of quadrature, m, and their areas, m2.
    strains
        (5, p, n) table.
    ends
        (E, 3, n) table of (u, phi, w) at the E edges.
    pressure
        Where it acts; None under a rigid tool.
    """

    section: SheetSection
    functions: RadialFunctions
    clamp: Edge
    tool: Edge | None
    laws: tuple[EdgeLaw, ...]
    pretension: float
    radius: FloatArray
    weight: FloatArray
    strains: FloatArray
    ends: FloatArray
    pressure: Pressure | None

    @property
    def unknowns(self) -> int:
        """Coefficients and three loads an edge."""
        return self.functions.unknowns + 3 * len(self.laws)

    def residual(self, state: FloatArray, depth: float, force: float) -> tuple[FloatArray, FloatArray]:
        """Gradient (N,) and its derivatives (N, N) for unknowns (N,).

        Parameters
        ----------
        state
            Coefficients, then the loads on the edges.
        depth
            Of a rigid tool, m.
        force
            Of a pressure, N.
        """
        n = self.functions.unknowns
        q = state[:n]
        density = energy_density(self.section, self.radius, self.strains @ q, self.pretension)
        moduli = np.einsum("ijp,jpn->ipn", density.hessian * self.weight, self.strains)
        gradient, jacobian = np.zeros(self.unknowns), np.zeros((self.unknowns, self.unknowns))
        gradient[:n] = np.einsum("ip,ipn->n", density.gradient * self.weight, self.strains)
        jacobian[:n, :n] = self.strains.reshape(-1, n).T @ moduli.reshape(-1, n)
        if self.pressure is not None:
            pressed, turned = self.pressure.mean_deflection(q)
            gradient[:n] -= force * pressed
            jacobian[:n, :n] -= force * turned
        for i, (law, end) in enumerate(zip(self.laws, self.ends, strict=True)):
            part = slice(n + 3 * i, n + 3 * i + 3)
            place, slope, curve = law.place(end @ q, state[part])
            _, moved, given = law.give(state[part])
            turned = slope @ end
            gradient[:n] += turned.T @ state[part]
            gradient[part] = place - moved
            gradient[n + 3 * i + 2] -= depth * i
            jacobian[part, :n], jacobian[:n, part], jacobian[part, part] = turned, turned.T, -given
            jacobian[:n, :n] += curve * np.outer(end[1], end[1])
        return gradient, jacobian

    def untensioned(self) -> "Sheet":
        """The same sheet without its pretension."""
        return replace(self, pretension=0.0)


def sheet(layers: Sequence[WaveLayer], tool: DiscTool, hole: float, count: int, pretension: float = 0.0) -> Sheet:
    """Set up a sheet over a hole.

    Parameters
    ----------
    layers
        From the surface down.
    tool
        Uniform pressure, or rigid and flat.
    hole
        Radius of the hole, m.
    count
        Radial functions for each of u, w and phi.
    pretension
        In N/m.
    """
    across = section(layers)
    rim = clamp(layers, across, hole)
    laws = [edge_law(rim.compliance, float(across.faces[-1]), hole, across)]
    held, places = None, [hole]
    if tool.rigid:
        held = tool_edge(layers, across, tool.radius, tool.contact)
        softening = TOOL_SOFTENING if tool.contact == "rigid_bonded" else None
        laws.append(edge_law(held.compliance, float(across.faces[0]), tool.radius, across, softening))
        places.append(tool.radius)
    functions = RadialFunctions(tool.radius if tool.rigid else 0.0, hole, count)
    radius, weight = functions.quadrature()
    return Sheet(
        across,
        functions,
        rim,
        held,
        tuple(laws),
        pretension,
        radius,
        weight,
        functions.strains(radius),
        np.swapaxes(functions.displacement(np.array(places)), 0, 1),
        None if tool.rigid else pressure(functions, tool.radius, across, face_bulge(rim, across)[0]),
    )


def face_bulge(edge: Edge, section: SheetSection) -> FloatArray:
    """(L + 1,) deflection of the faces per curvature phi' + phi / r, m2, against the mean that Q works on.

    A bent sheet thins on one side: (z^2 / 2 - mean) nu / (1 - nu).
    """
    bulge = edge.strip.chain[2]
    mean = float(edge.strip.resultant_weights[2] @ bulge)
    return np.asarray(mean - bulge[2 * edge.strip.nodes(section.faces) + 1])
