"""Equilibrium of the modes under a force: Newton's method, each step by conjugate gradients, and the path to a depth.

The linear wave's stiffness, inverted mode by mode, is the preconditioner; forces are measured by the energy of their
linear answer. A step is shortened until the potential falls.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.equilibrium_path import EquilibriumState, follow, straight_on
from wavemodel.layered.finite_strain.deformation_state import Deformed
from wavemodel.layered.finite_strain.modal_body import StackBody
from wavemodel.layered.finite_strain.tool_contact import ContactState, ToolContact

TOLERANCE = 1e-4
"""Of the load, in the energy norm; the depth, which is stationary, is then right to its square."""
MOST_STEPS, MOST_DIRECTIONS, MOST_HALVINGS = 20, 60, 12
MOST_AGAIN = 6
"""Equilibria of a force until its contact is what it went by."""
FORCING = 0.1
"""How far a Newton step is solved for, at least."""
DESCENT = 1e-4
SPACING = 0.025
"""Of depth between levels, in heights of the stack."""
LEVELS = 8
"""At least so many levels on the way."""
FASTEST = 1.6
"""A step of force is at most so many times the one before."""
SHORTEST = 1.0 / 32.0
"""A step of force below this share of the first ends the path."""
SURPRISE = 0.5
"""A step that goes so much further, or less far, than the one before led to expect is cut: a soft block under pressure
comes to a largest force and then sinks in, and must not be followed to another branch."""


@dataclass(frozen=True)
class _Balance:
    """A body and its contact at amplitudes (N, 2 n)."""

    body: StackBody
    amplitude: FloatArray
    matter: Deformed
    contact: ContactState

    @property
    def potential(self) -> float:
        """J."""
        return self.body.energy(self.matter) + self.contact.potential

    @cached_property
    def residual(self) -> FloatArray:
        """(N, 2 n) forces that are out of balance, N."""
        return -(self.body.forces(self.matter.stress) + self.contact.forces)

    def resistance(self, direction: FloatArray) -> FloatArray:
        """(N, 2 n) forces against going along a direction, to first order."""
        return self.body.force_change(self.matter, direction) + self.contact.change(direction)

    def answer(self, forces: FloatArray) -> FloatArray:
        """(N, 2 n) linear answer to forces (N, 2 n)."""
        return self.contact.relieve(self.body.answer(forces))


@dataclass(frozen=True)
class ModalEquilibrium:
    """A body, its contact, and the potential of both under a force."""

    body: StackBody
    contact: ToolContact

    @cached_property
    def linear(self) -> FloatArray:
        """(N, 2 n) amplitudes per force of the linear body."""
        rest = self.contact.state(np.zeros_like(self.contact.load), 0.0)
        return rest.relieve(self.body.answer(self.contact.load))

    def solve(self, force: float, start: FloatArray) -> FloatArray | None:
        """Amplitudes (N, 2 n) in equilibrium with a force (N), from a start near them; None where none are found."""
        goal = (TOLERANCE * force) ** 2 * _dot(self.contact.load, self.linear)
        here = self._at(start, force)
        for _ in range(MOST_STEPS):
            if here is None:
                return None
            size = _dot(here.residual, here.answer(here.residual))
            if size <= goal:
                return here.amplitude
            forcing = max(min(FORCING**2, size / goal * TOLERANCE**2), 0.25 * goal / size)
            here = self._shortened(here, _newton_step(here, forcing), force)
        return None

    def settled(self, force: float, start: FloatArray) -> tuple[FloatArray, ToolContact] | None:
        """The same, with the contact by what it is there, and that contact."""
        here = self
        for _ in range(MOST_AGAIN):
            found = here.solve(force, start)
            if found is None:
                return None
            again = here.contact.again(found, force)
            if again is None:
                return found, here.contact
            here, start = replace(here, contact=again), found
        return None

    def _at(self, amplitude: FloatArray, force: float) -> _Balance | None:
        matter = self.body.state(amplitude)
        return None if matter is None else _Balance(self.body, amplitude, matter, self.contact.state(amplitude, force))

    def _shortened(self, here: _Balance, step: FloatArray, force: float) -> _Balance | None:
        """Go along a step as far as the potential falls enough."""
        level, slope, share = here.potential, _dot(here.residual, step), 1.0
        for _ in range(MOST_HALVINGS):
            there = self._at(here.amplitude + share * step, force)
            if there is not None and level - there.potential >= DESCENT * share * slope - 1e-12 * abs(level):
                return there
            share *= 0.5
        return None


def _newton_step(here: _Balance, forcing: float) -> FloatArray:
    """Solve the linearised equilibrium to a residual whose square has fallen by `forcing`."""
    step, left = np.zeros_like(here.residual), here.residual
    answer = here.answer(left)
    direction, size = answer, _dot(left, answer)
    enough = forcing * size
    for count in range(MOST_DIRECTIONS):
        pushed = here.resistance(direction)
        curvature = _dot(direction, pushed)
        if curvature <= 0.0:
            return direction if count == 0 else step
        length = size / curvature
        step = step + length * direction
        left = left - length * pushed
        answer = here.answer(left)
        before, size = size, _dot(left, answer)
        if size <= enough:
            break
        direction = answer + size / before * direction
    return step


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
    """Equilibrium under a force; its depth and what that gained on the one before, m, and the contact from there on."""

    contact: ToolContact
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
        settled = replace(self.body, contact=last.contact).settled(load, self._start(path, load))
        if settled is None:
            return None
        state, contact = settled
        slope = self.compliance if len(path) == 1 else (last.depth - path[-2].depth) / (last.load - path[-2].load)
        gained, expected = contact.state(state, load).depth - last.depth, (load - last.load) * slope
        surprising = abs(gained - expected) > SURPRISE * expected
        remembering = contact.after(state, load)
        return None if surprising else _Pressed(load, state, remembering, last.depth + gained, gained)

    def next_step(self, path: Sequence[_Pressed], step: float) -> float:
        return min(FASTEST * step, self.spacing * step / path[-1].gained)

    def reached(self, path: Sequence[_Pressed]) -> bool:
        return path[-1].depth >= self.reach

    def _start(self, path: Sequence[_Pressed], load: float) -> FloatArray:
        """Go straight on, unless that crushes matter."""
        ahead = load * self.linear if len(path) == 1 else straight_on(path, load)
        return path[-1].state if self.body.body.state(ahead) is None else ahead


def spacing_of(height: float, reach: float) -> float:
    """Depth between the levels of a path to a depth (m) in a stack of a height (m), m."""
    return min(SPACING * height, reach / LEVELS)


def press_path(equilibrium: ModalEquilibrium, height: float, reach: float, shortest: float = SHORTEST) -> PressPath:
    """Load a body until its depth is `reach`, or until it has no equilibrium near the one before.

    Parameters
    ----------
    equilibrium
        The body and its contact.
    height
        Of the stack, m.
    reach
        Depth to come to, m.
    shortest
        Share of the first step of force below which a step ends the path.
    """
    linear, compliance = equilibrium.linear, equilibrium.contact.compliance
    spacing = spacing_of(height, reach)
    step = spacing / compliance
    loading = _ToDepth(equilibrium, linear, compliance, spacing, reach)
    path = follow(loading, [_Pressed(0.0, np.zeros_like(linear), equilibrium.contact)], step, shortest * step)
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
