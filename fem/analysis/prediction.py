"""Prediction of the next state from known ones.

Over the load: interpolation or extrapolation through the nearest known states, of second order, or of a higher one as
long as each further state changes the prediction much less than the one before: high on a smooth path, low where the
path has a kink. On the way back of a load history the states of the way up are near, so the prediction is good; it is
still corrected by Newton like any other.

Over time, for a body with a memory, whose states of the way up say nothing about the way back: while the load goes on
at one rate the last three states are extrapolated; after a change of rate the last increment is scaled with the load.

By the tangent at the last state, to judge by: right to first order where a few states are not, as behind the first
step of a thin sheet. It takes new factors.

From another mesh of the same body: its displacements at these nodes. Round a sharp edge they may turn a larger element
inside out, which then gets straight sides. Along a history the other mesh's increment is added to the last state.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np

from fem.analysis.equilibrium import Equilibrium, State
from fem.arrays import FloatArray, IntArray
from fem.linear_solver import SingularMatrixError
from fem.mesh.quads import Mesh

LOWEST_ORDER, HIGHEST_ORDER = 2, 5  # as far as there are states
SHRINKAGE = 0.5  # of the change by each further state; where it is less, the order rises no further
LEAST_SPACING = 0.3
KEPT = 3
SAME_RATE = 1e-6
LEAST_STEP = 0.05
"""Of a step of the load, the least that the one before must be to tell its direction: what fades in time is more."""
MOST_STRAIGHTENED = 4
"""Rounds in which elements get straight sides, since a neighbour may turn inside out by it."""


class KnownStates:
    """States of equilibrium with the load value each belongs to."""

    def __init__(self, value: float, state: State) -> None:
        self._values = [value]
        self._states = [state]
        self._first = 0

    @property
    def values(self) -> FloatArray:
        """Load values (k,) in the order in which the states were added."""
        return np.array(self._values)

    @property
    def states(self) -> tuple[State, ...]:
        """The states in the same order."""
        return tuple(self._states)

    def add(self, value: float, state: State, *, alone: bool = False) -> None:
        """Remember a state; behind one that stands alone those before it predict nothing more."""
        if alone:
            self._first = len(self._values)
        self._values.append(value)
        self._states.append(state)

    def predict(self, value: float, highest: int = HIGHEST_ORDER) -> State:
        """State at a load value, of at most the order `highest`."""
        chosen = self._choose(value, highest + 1)
        states = [self._states[n] for n in chosen]
        return extrapolated(np.array([self._values[n] for n in chosen]), states, value)

    def _choose(self, value: float, most: int) -> list[int]:
        """Nearest known states, far enough from each other for the distance to the value."""
        distance = np.abs(np.array(self._values) - value)
        order = self._first + np.argsort(distance[self._first :], kind="stable")
        chosen = [int(order[0])]
        spacing = LEAST_SPACING * max(float(distance[order[0]]), 1e-9 * float(distance.max()))
        for n in order[1:]:
            if len(chosen) == most or distance[order[0]] == 0.0:
                break
            if all(abs(self._values[n] - self._values[m]) > spacing for m in chosen):
                chosen.append(int(n))
        return chosen


def extrapolated(points: FloatArray, states: list[State], at: float) -> State:
    """Prediction at one place from states at different points (n,), the most important first."""
    weights = np.zeros((len(points), len(points)))
    for k in range(len(points)):
        weights[k, : k + 1] = lagrange(points[: k + 1], at)
    terms = np.diff(weights, axis=0) @ np.stack([state.y for state in states])
    sizes = np.linalg.norm(terms, axis=1)
    order = min(LOWEST_ORDER, len(sizes))
    while order < len(sizes) and sizes[order] <= SHRINKAGE * sizes[order - 1]:
        order += 1
    return combined(weights[order, : order + 1], states[: order + 1])


def along_tangent(problem: Equilibrium, state: State, control: Literal["force", "depth"], step: float) -> State | None:
    """Prediction by the tangent at an equilibrium, for so much more force (N) or depth (m); None where it has none."""
    evaluation = problem.system.evaluate(state.y, state.pressure)
    if evaluation is None:
        return None
    try:
        problem.factorise(evaluation)
        slope = problem.solve(problem.unit_load[:, None], 0.0)[:, 0]
    except SingularMatrixError:
        return None
    share = 1.0 if control == "force" else problem.depth(slope)
    if share == 0.0:
        return None
    force = step / share
    dy = force * slope
    return State(state.y + dy, problem.system.pressure_after(evaluation, dy), state.force + force)


def combined(weights: FloatArray, states: list[State]) -> State:
    """Sum of states (n) times weights (n,)."""
    y = np.tensordot(weights, [s.y for s in states], axes=1)
    pressure = np.tensordot(weights, [s.pressure for s in states], axes=1)
    return State(y, pressure, float(weights @ [s.force for s in states]))


def lagrange(points: FloatArray, at: float) -> FloatArray:
    """Weights (n,) of values at different points (n,) in the polynomial through them, at one place."""
    weights = np.ones(len(points))
    for i, p in enumerate(points):
        for j, other in enumerate(points):
            if i != j:
                weights[i] *= (at - other) / (p - other)
    return weights


class RecentStates:
    """The last states of equilibrium with load value and time of each."""

    def __init__(self, value: float, time: float, state: State) -> None:
        self._known = [(value, time, state)]

    def add(self, value: float, time: float, state: State) -> None:
        """Remember a state."""
        self._known = [*self._known[1 - KEPT :], (value, time, state)]

    @property
    def last(self) -> tuple[float, State]:
        """Time in s of the last state, and the state."""
        return self._known[-1][1:]

    def predictions(self, value: float, time: float) -> Iterator[State]:
        """States at a load value and a time in s, the best first."""
        yield self.predict(value, time)

    def predict(self, value: float, time: float) -> State:
        """State at a load value and a time in s."""
        values = np.array([*(v for v, _, _ in self._known), value])
        times = np.array([*(t for _, t, _ in self._known), time])
        states = [state for _, _, state in self._known]
        if len(states) == 1:
            return states[0]
        steps, durations = np.diff(values), np.diff(times)
        if len(states) == KEPT and durations.min() > 0.0 and _steady(steps / durations):
            return combined(lagrange(times[:-1], time), states)
        ratio = steps[-1] / steps[-2] if abs(steps[-2]) > LEAST_STEP * abs(steps[-1]) else 0.0
        return combined(np.array([-ratio, 1.0 + ratio]), states[-2:])


class GuidedStates(RecentStates):
    """The last states, with increments of those that another mesh has at given times, linear between them.

    Parameters
    ----------
    problem
        The equations.
    value, start
        Load value (N or m) and state to start from.
    times
        Times (k,) in s, rising, that of the start first.
    guides
        States (k) there, see :func:`from_displacement`, the start first.
    """

    def __init__(
        self, problem: Equilibrium, value: float, start: State, times: FloatArray, guides: Sequence[State]
    ) -> None:
        super().__init__(value, float(times[0]), start)
        self._times, self._forces = times, np.array([guide.force for guide in guides])
        self._y = np.stack([guide.y for guide in guides])
        moved = np.zeros(len(start.y) + 1, dtype=np.bool_)
        moved[problem.system.numbering.unknown] = moved[problem.probe] = True
        self._multipliers = np.flatnonzero(~moved[:-1])

    def predictions(self, value: float, time: float) -> Iterator[State]:
        """The last state with the guides' increment and multipliers that go with the force; then the plain one."""
        before, last = self.last
        y = last.y + self._at(time) - self._at(before)
        force = last.force + float(np.diff(np.interp([before, time], self._times, self._forces))[0])
        if last.force > 0.0:
            y[self._multipliers] *= force / last.force
        yield State(y, last.pressure, force)
        yield self.predict(value, time)

    def _at(self, time: float) -> FloatArray:
        """Unknowns (n,) of the guides at a time in s."""
        after = int(np.searchsorted(self._times, time).clip(1, len(self._times) - 1))
        start, end = self._times[after - 1 : after + 1]
        share = (time - start) / (end - start) if end > start else 1.0  # a sudden press
        out: FloatArray = (1.0 - share) * self._y[after - 1] + share * self._y[after]
        return out


def from_displacement(problem: Equilibrium, mesh: Mesh, nodal: FloatArray, force: float, depth: float) -> State:
    """State near one with displacements (N, 2) in m at the nodes, a force in N and a depth in m; no pressure yet."""
    numbering = problem.system.numbering
    own = nodal.T if numbering.prescribed is None else nodal.T - numbering.prescribed
    y: FloatArray = np.zeros(numbering.count + 1)
    for _ in range(MOST_STRAIGHTENED):
        y[numbering.unknown] = own
        y[problem.probe] = -depth
        inverted = _inverted(problem, y[:-1])
        if not inverted.size:
            break
        own = _straightened(own, mesh.elements[:, inverted])
    return State(y[:-1], problem.system.rest()[1], force)


def _inverted(problem: Equilibrium, y: FloatArray) -> IntArray:
    """Elements that the unknowns (n,) turn inside out."""
    deformation = problem.system.elements.deformation(problem.system.element_displacement(y))
    return np.flatnonzero(~(deformation.J.min(axis=0) > 0.0))


def _straightened(nodal: FloatArray, elements: IntArray) -> FloatArray:
    """Displacements (2, N) with those of the elements' (9, m) mid-sides and centres the means of their corners'."""
    corners, out = elements[:4], nodal.copy()
    out[:, elements[4:8]] = 0.5 * (nodal[:, corners] + nodal[:, np.roll(corners, -1, axis=0)])
    out[:, elements[8]] = nodal[:, corners].mean(axis=1)
    return out


def _steady(rates: np.ndarray) -> bool:
    return bool(np.ptp(rates) <= SAME_RATE * np.abs(rates).max())
