"""Static answer to the sharp part of the load that the modes leave out (a mode-acceleration correction).

It is exact layered elasticity of the endless specimen: the stack's exact compliance under the share 1 - s(k) of the
load, with the half-space that it tends to at large k taken out of the integral and put back in closed form.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.domains.endless import Endless, endless
from wavemodel.domains.rectangle import Rectangle
from wavemodel.layers.compliance import compliance, exact_faces
from wavemodel.layers.laminate import Laminate
from wavemodel.loads.half_space import HalfSpace
from wavemodel.loads.traction import TractionBasis
from wavemodel.taper import Taper

SHARPEST, DEEPEST = 2000.0, 12.0
"""The integral stops at k = DEEPEST / thickness of the first layer, where it is a half-space and nothing below it moves
(to exp(-12)), or at SHARPEST / tool radius."""


@dataclass(frozen=True)
class Remainder:
    """The sharp part's response to the J tractions of a basis.

    Attributes
    ----------
    basis
        The radial tractions.
    spectrum
        Quadrature of q wavenumbers.
    load
        (q, J, 2) of the basis along U and W.
    faces
        (q, L, 2, 2) in m/Pa: compliance times 1 - s(k), less the half-space on the surface.
    body
        The half-space.
    reach
        Beyond this distance from the axis (m) the remainder is nothing.
    """

    basis: TractionBasis
    spectrum: Endless
    load: FloatArray
    faces: FloatArray
    body: HalfSpace
    reach: float

    def deflection(self, coefficients: FloatArray, radius: FloatArray) -> FloatArray:
        """(L, R) of each layer's top face at radii (R,) in m under coefficients (J,), m/N."""
        out = np.zeros((self.faces.shape[1], radius.size))
        near = radius < self.reach
        load = np.einsum("nji,j->ni", self.load, coefficients)
        answer = np.einsum("nli,ni->ln", self.faces[:, :, 1], load)
        out[:, near] = self.spectrum.at_radius(answer, radius[near])
        out[0, near] += self.basis.half_space_deflection(self.body, radius[near]) @ coefficients
        return out

    @cached_property
    def flexibility(self) -> FloatArray:
        """(J, J) work of each traction on the displacement under each other, m/N."""
        return work(self.load, self.faces[:, 0], self.spectrum.weight) + self.basis.half_space_flexibility(self.body)


def work(load: FloatArray, faces: FloatArray, weight: FloatArray) -> FloatArray:
    """(J, J) work of tractions on each other's displacement, summed over wavenumbers.

    Parameters
    ----------
    load
        (n, J, 2) of the tractions.
    faces
        (n, 2, 2) compliance of the surface.
    weight
        (n,) of the wavenumbers.
    """
    moved = np.matmul(load, faces * weight[:, None, None])
    return np.asarray(np.tensordot(load, moved, axes=([0, 2], [0, 2])))


def remainder(laminate: Laminate, basis: TractionBasis, taper: Taper, window: Rectangle) -> Remainder:
    """Set up the remainder of a tool on a stack.

    Parameters
    ----------
    laminate
        The stack; one sub-layer a layer is enough.
    basis
        Tractions of the tool.
    taper
        Share of the modes.
    window
        What the modes span; no wavenumber below its first belongs to the remainder, and nothing beyond its corners.
    """
    reach = min(basis.radius + taper.locality, 0.75 * max(window.width, window.height))
    limit = max(1.2 * taper.limit, min(SHARPEST / basis.radius, DEEPEST / float(laminate.thickness[0])))
    spectrum = endless(limit, reach + basis.radius)
    k = spectrum.wavenumber
    body = HalfSpace.of(float(laminate.shear_modulus[0]), float(laminate.lame_modulus[0]))
    faces = compliance(np.maximum(k, window.lowest), laminate, exact_faces).faces
    faces = faces * np.where(k < window.lowest, 0.0, taper.remainder(k))[:, None, None, None]
    faces[:, 0] -= body.matrix / k[:, None, None]
    return Remainder(basis, spectrum, basis.transform(k), faces, body, reach)
