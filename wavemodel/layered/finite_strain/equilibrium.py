"""Equilibrium of the modes under a force: Newton's method, each step by conjugate gradients.

The linear wave's stiffness, inverted mode by mode, is the preconditioner; forces are measured by the energy of their
linear answer. A step is shortened until the potential falls.
"""

from dataclasses import dataclass, replace

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.layered.finite_strain.modal_body import Deformed, ModalBody
from wavemodel.layered.finite_strain.tool_contact import Contact

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


SPACING = 0.025
"""Of depth between levels, in heights of the stack."""
FASTEST = 1.6
"""A step of force is at most so many times the one before."""
SHORTEST = 1.0 / 32.0
"""A step of force below this share of the first ends the path."""
SURPRISE = 0.5
"""A step that goes so much further, or less far, than the one before led to expect is cut: a soft block under pressure
comes to a largest force and then sinks in, and must not be followed to another branch."""


@dataclass(frozen=True)
class PressPath:
    """M levels of load, the first without any.

    Attributes
    ----------
    force, depth
        (M,) in N and m, rising.
    deflection
        (M, L, N) amplitudes of the layers' top faces, m.
    outward
        (M, L, N) amplitudes in plane of the layers' top faces, m.
    linear_depth, linear_deflection, linear_outward
        The same per force by the linear body: m/N, and (L, N) in m/N.
    """

    force: FloatArray
    depth: FloatArray
    deflection: FloatArray
    outward: FloatArray
    linear_depth: float
    linear_deflection: FloatArray
    linear_outward: FloatArray

    def first(self, levels: int) -> "PressPath":
        """Return its first levels."""
        kept = {name: getattr(self, name)[:levels] for name in ("force", "depth", "deflection", "outward")}
        return replace(self, **kept)


def follow(equilibrium: Equilibrium, height: float, reach: float) -> PressPath:
    """Load a body until its depth is `reach`, or until it has no equilibrium near the one before.

    Parameters
    ----------
    equilibrium
        The body and its contact.
    height
        Of the stack, m.
    reach
        Depth to come to, m.
    """
    linear = equilibrium.answer(equilibrium.contact.load)
    compliance = equilibrium.contact.depth(linear, 1.0)
    first = step = SPACING * height / compliance
    forces, depths, states = [0.0], [0.0], [np.zeros_like(linear)]
    while depths[-1] < reach:
        force = forces[-1] + step
        state = equilibrium.solve(force, _start(equilibrium, forces, states, linear, force))
        gained = -np.inf if state is None else equilibrium.contact.depth(state, force) - depths[-1]
        expected = step * (compliance if len(forces) == 1 else (depths[-1] - depths[-2]) / (forces[-1] - forces[-2]))
        if state is None or abs(gained - expected) > SURPRISE * expected:
            step *= 0.5
            if step < SHORTEST * first:
                break
            continue
        depth = depths[-1] + gained
        step = min(FASTEST * step, SPACING * height * step / gained)
        forces.append(force)
        depths.append(depth)
        states.append(state)
    tops, nodes = equilibrium.body.thickness.top, equilibrium.body.nodes
    outward, deflection = (np.stack([state[:, tops + shift].T for state in states]) for shift in (0, nodes))
    return PressPath(
        force=np.array(forces),
        depth=np.array(depths),
        deflection=deflection,
        outward=outward,
        linear_depth=compliance,
        linear_deflection=linear[:, tops + nodes].T,
        linear_outward=linear[:, tops].T,
    )


def _start(
    equilibrium: Equilibrium, forces: list[float], states: list[FloatArray], linear: FloatArray, force: float
) -> FloatArray:
    """Go on straight from the last two states, unless that crushes matter."""
    if len(forces) == 1:
        ahead = force * linear
    else:
        share = (force - forces[-1]) / (forces[-1] - forces[-2])
        ahead = states[-1] + share * (states[-1] - states[-2])
    return states[-1] if equilibrium.body.state(ahead) is None else ahead
