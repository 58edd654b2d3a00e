"""Equilibrium of the modes under a force: Newton's method, each step by conjugate gradients.

The linear wave's stiffness, inverted mode by mode, is the preconditioner; forces are measured by the energy of their
linear answer. A step is shortened until the potential falls.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.large_press.contact import Contact
from wavemodel.large_press.modal_body import ModalBody
from wavemodel.large_press.neo_hookean import Deformed

TOLERANCE = 1e-4
"""Of the load, in the energy norm; the depth, which is stationary, is then right to its square."""
MOST_STEPS, MOST_DIRECTIONS, MOST_HALVINGS = 20, 60, 12
FORCING = 0.1
"""How far a Newton step is solved for, at least."""
DESCENT = 1e-4


@dataclass(frozen=True)
class Equilibrium:
    """A body, its contact, and the potential of both under a force."""

    body: ModalBody
    contact: Contact

    def answer(self, forces: FloatArray) -> FloatArray:
        """(N, 2 n) linear answer to forces (N, 2 n)."""
        free = np.einsum("nij,nj->ni", self.body.linear_compliance, forces)
        return self.contact.relieve(free)

    def solve(self, force: float, start: FloatArray) -> FloatArray | None:
        """Amplitudes (N, 2 n) in equilibrium with a force (N), from a start near them; None where none are found."""
        load = force * self.contact.load
        goal = TOLERANCE**2 * _dot(load, self.answer(load))
        amplitude, state = start, self.body.state(start)
        for _ in range(MOST_STEPS):
            if state is None:
                return None
            residual = load - self._resistance(amplitude, state)
            size = _dot(residual, self.answer(residual))
            if size <= goal:
                return amplitude
            forcing = max(min(FORCING**2, size / goal * TOLERANCE**2), 0.25 * goal / size)
            step = self._newton_step(state, residual, forcing)
            amplitude, state = self._shortened(amplitude, state, step, load, residual)
        return None

    def _resistance(self, amplitude: FloatArray, state: Deformed) -> FloatArray:
        return self.body.forces(state.stress) + self.contact.held(amplitude)

    def _newton_step(self, state: Deformed, residual: FloatArray, forcing: float) -> FloatArray:
        """Solve the linearised equilibrium to a residual whose square has fallen by `forcing`."""
        step, left = np.zeros_like(residual), residual
        answer = self.answer(left)
        direction, size = answer, _dot(left, answer)
        enough = forcing * size
        for count in range(MOST_DIRECTIONS):
            pushed = self.body.force_change(state, direction) + self.contact.held(direction)
            curvature = _dot(direction, pushed)
            if curvature <= 0.0:
                return direction if count == 0 else step
            length = size / curvature
            step = step + length * direction
            left = left - length * pushed
            answer = self.answer(left)
            before, size = size, _dot(left, answer)
            if size <= enough:
                break
            direction = answer + size / before * direction
        return step

    def _shortened(
        self, amplitude: FloatArray, state: Deformed, step: FloatArray, load: FloatArray, residual: FloatArray
    ) -> tuple[FloatArray, Deformed | None]:
        """Go along a step as far as the potential falls enough."""
        here, slope, share = self._potential(amplitude, state, load), _dot(residual, step), 1.0
        for _ in range(MOST_HALVINGS):
            there = amplitude + share * step
            after = self.body.state(there)
            if after is not None:
                fall = here - self._potential(there, after, load)
                if fall >= DESCENT * share * slope - 1e-12 * abs(here):
                    return there, after
            share *= 0.5
        return amplitude, None

    def _potential(self, amplitude: FloatArray, state: Deformed, load: FloatArray) -> float:
        held = 0.5 * _dot(amplitude, self.contact.held(amplitude))
        return self.body.energy(state) + held - _dot(load, amplitude)


def _dot(left: FloatArray, right: FloatArray) -> float:
    return float(np.vdot(left, right))
