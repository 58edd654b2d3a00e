"""How a tool pushes the modes at finite strain: a pressure that stays as it is, or a rigid face held to the tissue.

A rigid face is held by springs: the flexibility of the contact's traction functions that the modes do not have, the
sharp part near the edge, which stays linear. At small loads the answer is then that of the linear wave.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, Self

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.layered.finite_strain.modal_body import StackBody
from wavemodel.layered.tractions import TractionBasis

STIFFEST = 1e-7
"""Springs are no stiffer than what this share of the whole flexibility gives."""


class ContactState(Protocol):
    """A tool under a force, at amplitudes of the modes."""

    @property
    def depth(self) -> float:
        """Of the tool, m."""
        ...

    @property
    def potential(self) -> float:
        """Of what holds the modes, less the work of the force, J."""
        ...

    @property
    def forces(self) -> FloatArray:
        """(N, 2 n) its slope: the forces with which the tool holds the modes, N."""
        ...

    def change(self, direction: FloatArray) -> FloatArray:
        """(N, 2 n) change of the forces with the amplitudes, to first order."""
        ...

    def relieve(self, answer: FloatArray) -> FloatArray:
        """From the linear answer of the free body to that of the held one."""
        ...


class ToolContact(Protocol):
    """How a tool holds the modes of a body."""

    @property
    def load(self) -> FloatArray:
        """(N, 2 n) forces per force on the tool, of the linear body."""
        ...

    @property
    def compliance(self) -> float:
        """Depth per force of the linear body, m/N."""
        ...

    def state(self, amplitude: FloatArray, force: float) -> ContactState:
        """Under a force, N."""
        ...

    def again(self, amplitude: FloatArray, force: float) -> "ToolContact | None":
        """The contact by what it was in an equilibrium under a force, N; None where that is what it went by."""
        ...

    def after(self, amplitude: FloatArray, force: float) -> "ToolContact":
        """The contact that remembers an equilibrium under a force, N."""
        ...


class Memoryless:
    """A contact that goes by nothing but the amplitudes."""

    def again(self, amplitude: FloatArray, force: float) -> None:
        """Nothing to go by."""

    def after(self, amplitude: FloatArray, force: float) -> Self:  # noqa: ARG002 - as other contacts
        """The same."""
        return self


class LinearContact(Protocol):
    """A contact whose forces are linear in the amplitudes."""

    @property
    def load(self) -> FloatArray:
        """(N, 2 n) forces per force on the tool."""
        ...

    def held(self, amplitude: FloatArray) -> FloatArray:
        """(N, 2 n) forces with which the tool, free to move down, holds the modes, N."""
        ...

    def relieve(self, answer: FloatArray) -> FloatArray:
        """From the linear answer of the free body to that of the held one."""
        ...

    def depth(self, amplitude: FloatArray, force: float) -> float:
        """Of the tool, m."""
        ...


@dataclass(frozen=True)
class LinearState:
    """A linear contact under a force, N, at amplitudes (N, 2 n); see `ContactState`."""

    contact: LinearContact
    amplitude: FloatArray
    force: float

    @cached_property
    def _held(self) -> FloatArray:
        return self.contact.held(self.amplitude)

    @property
    def depth(self) -> float:
        """Of the tool, m."""
        return self.contact.depth(self.amplitude, self.force)

    @property
    def potential(self) -> float:
        """Of the springs, less the work of the force, J."""
        return float(np.vdot(self.amplitude, 0.5 * self._held - self.force * self.contact.load))

    @property
    def forces(self) -> FloatArray:
        """(N, 2 n) in N."""
        return self._held - self.force * self.contact.load

    def change(self, direction: FloatArray) -> FloatArray:
        """(N, 2 n) change of the forces."""
        return self.contact.held(direction)

    def relieve(self, answer: FloatArray) -> FloatArray:
        """From the linear answer of the free body to that of the held one."""
        return self.contact.relieve(answer)


def on_surface(body: StackBody, load: FloatArray) -> FloatArray:
    """(N, 2 n, J) forces on all amplitudes from (N, J, 2) along U and W of the surface."""
    out = np.zeros((load.shape[0], 2 * body.nodes, load.shape[1]))
    out[:, 0], out[:, body.nodes] = load[..., 0], load[..., 1]
    return out


class PressureContact(Memoryless):
    """A uniform pressure on the disc as it was, straight down; the depth is that of the surface on the axis.

    Parameters
    ----------
    body
        The body.
    basis
        The pressure.
    """

    def __init__(self, body: StackBody, basis: TractionBasis) -> None:
        self._node = body.nodes
        self.load: FloatArray = on_surface(body, basis.transform(body.radial.wavenumber))[..., 0]
        self.compliance = self.depth(body.answer(self.load), 1.0)

    def state(self, amplitude: FloatArray, force: float) -> LinearState:
        """Under a force, N."""
        return LinearState(self, amplitude, force)

    def held(self, amplitude: FloatArray) -> FloatArray:
        """Nothing is held."""
        return np.zeros_like(amplitude)

    def relieve(self, answer: FloatArray) -> FloatArray:
        """The body is free."""
        return answer

    def depth(self, amplitude: FloatArray, force: float) -> float:  # noqa: ARG002
        """Of the surface on the axis, m."""
        return float(amplitude[:, self._node].sum())


class BondedContact(Memoryless):
    """A rigid flat face bonded to the disc.

    Parameters
    ----------
    body
        The body.
    basis
        J traction functions, normal and shear.
    flexibility
        (J, J) of them on the linear body, m/N.
    """

    def __init__(self, body: StackBody, basis: TractionBasis, flexibility: FloatArray) -> None:
        self._push = on_surface(body, basis.transform(body.radial.wavenumber))
        self._answer = body.linear_compliance @ self._push
        modal = np.einsum("nim,nij->mj", self._push, self._answer)
        stiffness = _springs(flexibility, modal)
        along = stiffness @ basis.net_force
        self._along, self._whole = along, float(basis.net_force @ along)
        self._spring = stiffness - np.outer(along, along) / self._whole
        both = self._spring @ np.linalg.inv(np.eye(along.size) + modal @ self._spring)
        self._both = 0.5 * (both + both.T)
        self.load: FloatArray = self._push @ (along / self._whole)
        self.compliance = self.depth(self.relieve(body.answer(self.load)), 1.0)

    def state(self, amplitude: FloatArray, force: float) -> LinearState:
        """Under a force, N."""
        return LinearState(self, amplitude, force)

    def _motion(self, amplitude: FloatArray) -> FloatArray:
        """(J,) motion of the surface weighted by each function, m."""
        return np.asarray(np.einsum("nij,ni->j", self._push, amplitude))

    def held(self, amplitude: FloatArray) -> FloatArray:
        """(N, 2 n) forces of the springs, the tool being free to move down."""
        return self._push @ (self._spring @ self._motion(amplitude))

    def relieve(self, answer: FloatArray) -> FloatArray:
        """The same with springs (Woodbury)."""
        return np.asarray(answer - self._answer @ (self._both @ self._motion(answer)))

    def depth(self, amplitude: FloatArray, force: float) -> float:
        """Of the tool, m."""
        return (force + float(self._along @ self._motion(amplitude))) / self._whole


def _springs(flexibility: FloatArray, modal: FloatArray) -> FloatArray:
    """(J, J) inverse of the flexibility that the modes do not have, which is positive but for rounding."""
    scale = 1.0 / np.sqrt(np.diag(flexibility))
    values, vectors = np.linalg.eigh((flexibility - modal) * np.outer(scale, scale))
    inverse = (vectors / np.maximum(values, STIFFEST)) @ vectors.T
    return np.asarray(inverse * np.outer(scale, scale))
