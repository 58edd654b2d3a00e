"""Equilibrium of the modes under a force: Newton's method, each step by conjugate gradients, and the path to a depth.

The linear wave's stiffness, inverted mode by mode, is the preconditioner; forces are measured by the energy of their
linear answer. A step is shortened until the potential falls.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.equilibrium_path import EquilibriumState, follow, straight_on
from wavemodel.layered.finite_strain.deformation_state import Deformed
from wavemodel.layered.finite_strain.modal_body import StackBody
from wavemodel.layered.finite_strain.tool_contact import ToolContact

TOLERANCE = 1e-4
"""Of the load, in the energy norm; the depth, which is stationary, is then right to its square."""
MOST_STEPS, MOST_DIRECTIONS, MOST_HALVINGS = 20, 60, 12
FORCING = 0.1
"""How far a Newton step is solved for, at least."""
DESCENT = 1e-4
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
class ModalEquilibrium:
    """A body, its contact, and the potential of both under a force."""

    body: StackBody
    contact: ToolContact

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


@dataclass(frozen=True)
class PressPath:
    """M load steps, the first without any load.

    Attributes
    ----------
    force, depth
        (M,) in N and m, rising.
    deflection, outward
        (M, L, N) amplitudes of the layers' top faces, down and in plane, m.
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

    def first(self, steps: int) -> "PressPath":
        """Return its first steps."""
        kept = {name: getattr(self, name)[:steps] for name in ("force", "depth", "deflection", "outward")}
        return replace(self, **kept)


@dataclass(frozen=True)
class _Pressed(EquilibriumState):
    """Equilibrium under a force; its depth and what that gained on the one before, m."""

    depth: float = 0.0
    gained: float = 0.0


@dataclass(frozen=True)
class _ToDepth:
    """Loading by force until the depth is `reach` (m), about every `spacing` (m) of depth (a `Loading`)."""

    body: ModalEquilibrium
    linear: FloatArray
    compliance: float
    spacing: float
    reach: float

    def next_load(self, path: Sequence[_Pressed], step: float) -> float:
        return path[-1].load + step

    def advance(self, path: Sequence[_Pressed], load: float) -> _Pressed | None:
        last = path[-1]
        state = self.body.solve(load, self._start(path, load))
        if state is None:
            return None
        slope = self.compliance if len(path) == 1 else (last.depth - path[-2].depth) / (last.load - path[-2].load)
        gained, expected = self.body.contact.depth(state, load) - last.depth, (load - last.load) * slope
        surprising = abs(gained - expected) > SURPRISE * expected
        return None if surprising else _Pressed(load, state, last.depth + gained, gained)

    def next_step(self, path: Sequence[_Pressed], step: float) -> float:
        return min(FASTEST * step, self.spacing * step / path[-1].gained)

    def reached(self, path: Sequence[_Pressed]) -> bool:
        return path[-1].depth >= self.reach

    def _start(self, path: Sequence[_Pressed], load: float) -> FloatArray:
        """Go straight on, unless that crushes matter."""
        ahead = load * self.linear if len(path) == 1 else straight_on(path, load)
        return path[-1].state if self.body.body.state(ahead) is None else ahead


def press_path(equilibrium: ModalEquilibrium, height: float, reach: float) -> PressPath:
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
    spacing = SPACING * height
    step = spacing / compliance
    loading = _ToDepth(equilibrium, linear, compliance, spacing, reach)
    path = follow(loading, [_Pressed(0.0, np.zeros_like(linear))], step, SHORTEST * step)
    tops, nodes = equilibrium.body.thickness.faces, equilibrium.body.nodes
    outward, deflection = (np.stack([one.state[:, tops + shift].T for one in path]) for shift in (0, nodes))
    return PressPath(
        force=np.array([one.load for one in path]),
        depth=np.array([one.depth for one in path]),
        deflection=deflection,
        outward=outward,
        linear_depth=compliance,
        linear_deflection=linear[:, tops + nodes].T,
        linear_outward=linear[:, tops].T,
    )
