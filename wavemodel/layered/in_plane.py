"""In-plane displacement of the faces, u_h = U grad S / k, from the vector modes directly.

The modes of the window give the smooth part, exact layered elasticity of the endless specimen the sharp rest, as they
do for the deflection (see `wavemodel.layered.remainder`).
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import j1

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError
from wavemodel.layered.press import Press
from wavemodel.layered.remainder import Remainder
from wavemodel.layered.stack.compliance import FaceStiffness, every_face, exact_faces, quadratic_faces
from wavemodel.layered.stack.laminate import Laminate
from wavemodel.layered.tractions import UniformPressure


@dataclass(frozen=True)
class InPlane:
    """One face's in-plane displacement under a unit force on the tool.

    Attributes
    ----------
    press
        The set-up.
    face
        0 for the surface, 1.. for the interfaces, L for the lowest face.
    """

    press: Press
    face: int

    def amplitude(self) -> FloatArray:
        """(K,) of the modes at rest under a unit force, m3/N."""
        press = self.press
        k = press.field.domain.wavenumber
        return self._along(k, press.modal_stack, quadratic_faces, press.load) * press.share

    def smooth(self, amplitude: FloatArray, points: FloatArray) -> FloatArray:
        """(P, 2) displacement along x and y of modes of amplitudes (K,), at points (P, 2): U / k times their slope."""
        domain = self.press.field.domain
        return domain.gradient(amplitude / domain.wavenumber, points)

    def sharp(self, points: FloatArray) -> FloatArray:
        """(P, 2) displacement along x and y of the sharp rest under a unit force, m/N."""
        rest = self.press.field.rest
        distance = np.hypot(points[:, 0], points[:, 1])
        outward = np.zeros_like(distance) if rest is None else self._sharp(rest, distance)
        return away(outward, points)

    def _sharp(self, rest: Remainder, distance: FloatArray) -> FloatArray:
        """(P,) outward, m/N: minus the integral of U J_1(k r), and nothing beyond its reach."""
        press, coefficients = self.press, self.press.field.traction.coefficients
        k = rest.spectrum.wavenumber
        load = np.einsum("nji,j->ni", rest.load, coefficients)
        lowest = np.maximum(k, press.field.domain.lowest)
        answer = self._along(lowest, press.stack, exact_faces, load) * rest.share
        near = distance < rest.reach
        out = np.zeros_like(distance)
        if self.face == 0:
            answer = answer - load @ rest.body.matrix[0] / k
            out[near] -= _half_space(rest, distance[near])
        out[near] -= (answer * rest.spectrum.weight) @ j1(np.outer(k, distance[near]))
        return out

    def _along(self, k: FloatArray, stack: Laminate, stiffness: FaceStiffness, load: FloatArray) -> FloatArray:
        """(K,) amplitude U of the face at wavenumbers (K,) under loads (K, 2)."""
        node = [*stack.top_of_layer.tolist(), stack.sublayers][self.face]
        faces = every_face(stack, stiffness(k, stack))[:, node]
        return np.asarray(np.einsum("kj,kj->k", faces[:, 0], load))


def away(outward: FloatArray, points: FloatArray) -> FloatArray:
    """(P, 2) along x and y of what moves points (P, 2) away from the tool's axis by (P,)."""
    distance = np.hypot(points[:, 0], points[:, 1])
    return np.asarray((outward / np.maximum(distance, 1e-300))[:, None] * points)


def _half_space(rest: Remainder, distance: FloatArray) -> FloatArray:
    """(P,) int U J_1(k r) of the half-space under a uniform pressure: Weber's and Schafheitlin's in closed form."""
    if not isinstance(rest.basis, UniformPressure):
        raise NotCoveredError(
            "marker motion does not cover the surface under a rigid tool (face 0); the interfaces and the lower face "
            "are covered"
        )
    radius = rest.basis.radius
    ratio = distance / radius
    return np.asarray(rest.body.cross / (2.0 * np.pi * radius) * np.minimum(ratio, 1.0 / np.maximum(ratio, 1e-300)))
