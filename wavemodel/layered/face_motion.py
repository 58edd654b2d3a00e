"""Displacement of the layers' faces at any step of a run: deflection, and in the plane u_h = U grad S / k.

In the plane too the modes of the window give the smooth part and exact layered elasticity of the endless specimen the
sharp rest (see `wavemodel.layered.remainder`).
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import j1

from wavemodel.arrays import FloatArray
from wavemodel.errors import NotCoveredError
from wavemodel.integrators.load_history import History
from wavemodel.layered.field import ModalState
from wavemodel.layered.press import Press
from wavemodel.layered.remainder import Remainder
from wavemodel.layered.stack.compliance import FaceStiffness, every_face, exact_faces, quadratic_faces
from wavemodel.layered.stack.laminate import Laminate
from wavemodel.layered.tractions import UniformPressure
from wavemodel.solution import radially


@dataclass(frozen=True)
class LayeredFaces:
    """Faces of L layers in a run (a `FaceMotion`).

    Attributes
    ----------
    press
        The set-up.
    history
        The run.
    """

    press: Press
    history: History

    def snapshot(self, step: int) -> ModalState:
        """State of the modes after a step (0..n-1), for `Field` and `Surface`."""
        force = self.history.static_force[step]
        elastic = 0.0 if self.history.elastic is None else float(self.history.elastic[step])
        return ModalState(self.history.amplitude(step), float(force[0]) if force.size == 1 else force, elastic)

    def deflection(self, step: int, radius: FloatArray) -> FloatArray:
        """See `FaceMotion.deflection`."""
        return self.press.field.along_x(self.snapshot(step), radius)

    def in_plane(self, step: int, points: FloatArray, face: int) -> FloatArray:
        """See `FaceMotion.in_plane`; what is not covered is said at `marker_motion`."""
        field, history = self.press.field, self.history
        inside = field.domain.holds(points)
        out = np.where(inside[:, None], 0.0, np.nan) * np.ones(2)
        if face == self.press.unit.shape[0] and self.press.stack.base == "bonded":
            return out
        force = history.static_force[step]
        if force.size > 1:
            raise NotCoveredError(
                "marker motion of the layered wave does not cover layers that relax each in its own way"
            )
        plane, places = InPlane(self.press, face), points[inside]
        amplitude = force[0] * plane.amplitude() if history.outward is None else history.outward(step)[face]
        out[inside] = plane.smooth(amplitude, places) + force[0] * plane.sharp(places)
        if field.large is not None and history.elastic is not None:
            distance = np.hypot(places[:, 0], places[:, 1])
            out[inside] += radially(field.large.outward(float(history.elastic[step]), face, distance), places)
        return out


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
        return radially(outward, points)

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
