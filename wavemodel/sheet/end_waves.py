"""Waves along a strip and round an edge: the layered sheet in exact small-strain elasticity.

Through the thickness it is quadratic in thin sub-layers. For an in-plane function S with lap S = s^2 S the displacement
is u = U(z) grad S / s, w = W(z) S, the vector waves of the layered model at imaginary wavenumber. Stacked over the
sub-layers, phi = (U, W) obeys

    (s^2 E0 + s (E1' - E1) - E2) phi = 0,

whose roots with Re s > 0 are end effects: they decay within the sheet's thickness. Roots at zero are the plate's own
solutions (`Strip.chain`). Round the axis S is a modified Bessel function of s r, inwards I_0, outwards K_0.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.special import ive, kve

from wavemodel.arrays import FloatArray, IntArray
from wavemodel.specimen import WaveLayer

ComplexArray: TypeAlias = NDArray[np.complex128]

Field = TypeVar("Field", FloatArray, ComplexArray)

GROWTH, FINEST = 1.6, 0.02
"""Sub-layers grow by this factor from the corner on, the first ones about FINEST of the thickness."""


@dataclass(frozen=True)
class Strip:
    """Matrices of n nodes through the thickness, two unknowns (U, W) each, moduli over `scale`.

    Attributes
    ----------
    z
        (n,) position of the nodes below the neutral plane, m.
    along, mixed, across
        E0, E1, E2 (2n, 2n).
    hoop
        (2n, 2n) 2 G in the measure of E0: what a stress along r is less by per u / r.
    scale
        Pa.
    """

    z: FloatArray
    along: FloatArray
    mixed: FloatArray
    across: FloatArray
    hoop: FloatArray
    scale: float

    @property
    def horizontal(self) -> NDArray[np.bool_]:
        """(2n,) which unknowns are U."""
        return np.asarray(np.arange(2 * self.z.size) % 2 == 0)

    def nodes(self, faces: FloatArray) -> IntArray:
        """(L + 1,) node on each face of the layers."""
        return np.asarray(np.abs(self.z - faces[:, None]).argmin(axis=1), dtype=np.intp)

    def traction(self, displacement: Field, rate: Field, radius: float) -> Field:
        """Nodal forces (2n, ..) per metre on a cylinder about the axis.

        `rate` is what a straight strip has as d(u, w)/dx: here the lap of u's potential, and dw/dr. The stress along r
        is less by 2 G u / r than that of the strip.
        """
        return self.along @ rate + self.mixed.T @ displacement - self.hoop @ displacement / radius

    def end_waves(self, free: IntArray, zeros: int) -> tuple[ComplexArray, ComplexArray]:
        """Roots s (m,) with Re s > 0 and shapes (2n, m) when only the unknowns `free` move.

        `zeros` roots on each side of the imaginary axis belong to the plate's own solutions and are left out.
        """
        e0, e1, e2 = (matrix[np.ix_(free, free)] for matrix in (self.along, self.mixed, self.across))
        inverse = np.linalg.inv(e0)
        first_order = np.block([[-inverse @ e1.T, inverse], [e2 - e1 @ inverse @ e1.T, e1 @ inverse]])
        roots, vectors = np.linalg.eig(first_order)
        kept = np.argsort(-roots.real)[: free.size - zeros]
        shapes = np.zeros((2 * self.z.size, kept.size), dtype=np.complex128)
        shapes[free] = vectors[: free.size, kept]
        return roots[kept], shapes

    @cached_property
    def chain(self) -> tuple[FloatArray, ...]:
        """(2n,) each: p0, p1, p2, p3, i0, i1 of the plate's own solutions at s = 0, for S with lap lap S = 0.

        Bending: w = p0 S + p2 lap S, u = (p1 S + p3 lap S)'. Stretching: u = i0 S', w = i1 lap S.
        """
        flat, skew = self.horizontal, self.mixed.T - self.mixed

        def solve(right: FloatArray) -> FloatArray:
            return np.asarray(np.linalg.lstsq(self.across, right, rcond=1e-11)[0])

        p0, i0, p1 = (~flat).astype(np.float64), flat.astype(np.float64), np.zeros(flat.size)
        p1[flat] = -self.z
        p2 = solve(self.along @ p0 + skew @ p1)
        p3 = solve(self.along @ p1 + skew @ p2)
        return p0, p1, p2, p3, i0, solve(skew @ i0)

    @cached_property
    def resultant_weights(self) -> FloatArray:
        """(3, 2n): with a displacement the u, phi and w that unit N, M and Q do work on."""
        p0, p1, p2, p3, i0, i1 = self.chain
        forces = (self.along @ i0 + self.mixed.T @ i1, self.along @ p1 + self.mixed.T @ p2)
        shear = self.along @ p2 + self.mixed.T @ p3
        return np.stack([forces[0] / (i0 @ forces[0]), -forces[1] / (p1 @ forces[1]), shear / (p0 @ shear)])


def strip(layers: Sequence[WaveLayer], faces: FloatArray, corner: str) -> Strip:
    """Cut layers into sub-layers that are fine at one face.

    Parameters
    ----------
    layers
        L layers from the surface down.
    faces
        (L + 1,) position of their faces below the neutral plane, m.
    corner
        "top" or "bottom": the face on which a support ends.
    """
    edges, layer = _sublayers(faces, corner)
    shear = np.array([layers[i].shear_modulus for i in layer])
    lame = np.array([layers[i].lame_modulus for i in layer])
    scale = float(shear.mean())
    nodes = np.empty(2 * layer.size + 1)
    nodes[::2], nodes[1::2] = edges, 0.5 * (edges[1:] + edges[:-1])
    matrices = np.zeros((4, 2 * nodes.size, 2 * nodes.size))
    for i, thickness in enumerate(np.diff(edges)):
        unknowns = slice(4 * i, 4 * i + 6)
        matrices[:, unknowns, unknowns] += _element(float(thickness), shear[i] / scale, lame[i] / scale)
    return Strip(nodes, matrices[0], matrices[1], matrices[2], matrices[3], scale)


def _sublayers(faces: FloatArray, corner: str) -> tuple[FloatArray, IntArray]:
    """Edges (S + 1,) and layer (S,) of sub-layers that are even in the logarithm of the distance from the corner."""
    floor = FINEST * (faces[-1] - faces[0])
    sign, origin = (1.0, faces[0]) if corner == "top" else (-1.0, faces[-1])
    position = np.log(sign * (faces - origin) + floor)
    edges, layer = [faces[:1]], []
    for i, (start, end) in enumerate(pairwise(position.tolist())):
        count = max(1, int(np.ceil(abs(end - start) / np.log(GROWTH))))
        inner = origin + sign * (np.exp(np.linspace(start, end, count + 1)) - floor)
        edges.append(np.concatenate([inner[1:-1], faces[i + 1 : i + 2]]))
        layer += [i] * count
    return np.concatenate(edges), np.array(layer, dtype=np.intp)


def _element(thickness: float, shear: float, lame: float) -> FloatArray:
    """E0, E1, E2 and the hoop matrix (4, 6, 6) of a sub-layer; the terms in lam take two Gauss points."""
    out = np.zeros((4, 6, 6))
    stiff = np.diag([2.0 * shear, 2.0 * shear, shear]), lame * np.outer([1.0, 1.0, 0.0], [1.0, 1.0, 0.0])
    for count, law in zip((3, 2), stiff, strict=True):
        for xi, share in zip(*np.polynomial.legendre.leggauss(count), strict=True):
            shape = np.array([0.5 * xi * (xi - 1.0), 1.0 - xi * xi, 0.5 * xi * (xi + 1.0)])
            slope = np.array([xi - 0.5, -2.0 * xi, xi + 0.5]) * 2.0 / thickness
            weight = 0.5 * share * thickness
            horizontal, vertical = np.zeros((3, 6)), np.zeros((3, 6))
            horizontal[0, 0::2] = horizontal[2, 1::2] = shape
            vertical[1, 1::2] = vertical[2, 0::2] = slope
            out[0] += weight * horizontal.T @ law @ horizontal
            out[1] += weight * vertical.T @ law @ horizontal
            out[2] += weight * vertical.T @ law @ vertical
            if count == 3:
                out[3, 0::2, 0::2] += weight * 2.0 * shear * np.outer(shape, shape)
    return out


@dataclass(frozen=True)
class EndWaves:
    """m waves on one side of an edge.

    Attributes
    ----------
    root
        (m,) s in 1/m, Re s > 0.
    shape
        (2n, m) of the strip's unknowns (U, W).
    edge
        Radius of the edge, m.
    outwards
        Whether they decay outwards.
    """

    root: ComplexArray
    shape: ComplexArray
    edge: float
    outwards: bool

    def functions(self, radius: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """S / S(edge) and S' / (s S(edge)) at radii (R,) on the waves' side: (m, R) each."""
        far, near = self.root[:, None] * radius, self.root[:, None] * self.edge
        if self.outwards:
            decay = np.exp(near - far) / kve(0, near)
            return kve(0, far) * decay, -kve(1, far) * decay
        decay = np.exp(far.real - near.real) / ive(0, near)
        return ive(0, far) * decay, ive(1, far) * decay

    def at_edge(self, section: Strip) -> tuple[ComplexArray, ComplexArray]:
        """Displacement and nodal forces (2n, m) each on the cylinder through the edge."""
        flat = section.horizontal[:, None]
        value, slope = (part[:, 0] for part in self.functions(np.array([self.edge])))
        displacement = np.where(flat, self.shape * slope, self.shape * value)
        rate = np.where(flat, self.shape * value, self.shape * slope) * self.root
        return displacement, section.traction(displacement, rate, self.edge)

    def displacement(self, node: int, radius: FloatArray, amplitude: ComplexArray) -> FloatArray:
        """(2, R) u and w of a node at radii (R,) for amplitudes (m,) of the waves."""
        value, slope = self.functions(radius)
        u = (self.shape[2 * node] * amplitude) @ slope
        w = (self.shape[2 * node + 1] * amplitude) @ value
        return np.stack([u.real, w.real])
