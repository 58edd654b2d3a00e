"""Static answer to the sharp part of the load that the modes leave out (a mode-acceleration correction).

It is exact layered elasticity of the endless specimen: the stack's exact compliance under the share 1 - s(k) of the
load, with the half-space that it tends to at large k taken out of the integral and put back in closed form.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.domains.domain import Endless, WaveDomain, endless
from wavemodel.layered.stack.compliance import compliance, exact_faces
from wavemodel.layered.stack.laminate import Laminate
from wavemodel.layered.tractions import HalfSpace, TractionBasis
from wavemodel.layered.window import Taper

DEEP = 24.0
"""Thickness of a layer that is as good as endless, times the wavenumber."""
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
    share
        (q,) share of the load that belongs to the remainder.
    """

    basis: TractionBasis
    spectrum: Endless
    load: FloatArray
    faces: FloatArray
    body: HalfSpace
    reach: float
    share: FloatArray

    def deflection(self, coefficients: FloatArray, radius: FloatArray) -> FloatArray:
        """(L, R) of each layer's top face at radii (R,) in m under coefficients (J,), m/N."""
        return np.asarray(deflections((self,), coefficients, radius)[0])

    @cached_property
    def flexibility(self) -> FloatArray:
        """(J, J) work of each traction on the displacement under each other, m/N."""
        return work(self.load, self.faces[:, 0], self.spectrum.weight) + self.basis.half_space_flexibility(self.body)


def deflections(fields: Sequence[Remainder], coefficients: FloatArray, radius: FloatArray) -> FloatArray:
    """(B, L, R) of each layer's top face for B remainders of one tool that differ in what answers, m/N."""
    one = fields[0]
    out = np.zeros((len(fields), one.faces.shape[1], radius.size))
    near = radius < one.reach
    load = np.einsum("nji,j->ni", one.load, coefficients)
    answer = np.stack([np.einsum("nli,ni->ln", field.faces[:, :, 1], load) for field in fields])
    out[..., near] = one.spectrum.at_radius(answer, radius[near])
    for index, field in enumerate(fields):
        out[index, 0, near] += one.basis.half_space_deflection(field.body, radius[near]) @ coefficients
    return out


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


def remainder(laminate: Laminate, basis: TractionBasis, taper: Taper, window: WaveDomain) -> Remainder:
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
    reach = min(basis.radius + taper.locality, 0.75 * window.width)
    limit = max(1.2 * taper.limit, min(SHARPEST / basis.radius, DEEPEST / float(laminate.thickness[0])))
    spectrum = endless(limit, reach + basis.radius)
    k = spectrum.wavenumber
    body = _half_space(laminate)
    faces = compliance(np.maximum(k, window.lowest), laminate, exact_faces).faces
    share = np.where(k < window.lowest, 0.0, taper.remainder(k))
    return Remainder(basis, spectrum, basis.transform(k), less_half_space(faces, share, body, k), body, reach, share)


def _half_space(laminate: Laminate) -> HalfSpace:
    """What the stack looks like at large wavenumbers: an endless first layer."""
    if laminate.tension is None:
        return HalfSpace.of(float(laminate.shear_modulus[0]), float(laminate.lame_modulus[0]))
    deep = Laminate(
        thickness=np.array([DEEP]),
        shear_modulus=laminate.shear_modulus[:1],
        lame_modulus=laminate.lame_modulus[:1],
        density=laminate.density[:1],
        top_of_layer=np.zeros(1, dtype=np.intp),
        base="bonded",
        tension=laminate.tension[:1],
    )
    surface = compliance(np.ones(1), deep, exact_faces).faces[0, 0]
    return HalfSpace(float(surface[1, 1]), float(surface[0, 1]), float(surface[0, 0]))


def less_half_space(faces: FloatArray, share: FloatArray, body: HalfSpace, wavenumber: FloatArray) -> FloatArray:
    """(q, L, 2, 2) what is integrated: compliance (q, L, 2, 2) times share (q,), less the half-space on the surface."""
    out: FloatArray = faces * share[:, None, None, None]
    out[:, 0] -= body.matrix / wavenumber[:, None, None]
    return out
