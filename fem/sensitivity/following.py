"""Derivatives of the states of a run as it goes.

The equations at an offset are evaluated at the state beside, y + offset dy/dp; what they leave unbalanced over the
offset is zero for the right derivative. The first correction, from none, is -K^-1 dR/dp. Further ones bring in what the
tangent has not: limits of Coulomb's friction, which follow the pressure, and what its symmetric form leaves out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from fem.analysis.equilibrium import Equilibrium, State
from fem.analysis.linear import run_linear, unit_state
from fem.analysis.nonlinear import run_nonlinear
from fem.analysis.prepared import Model
from fem.analysis.record import Record
from fem.arrays import FloatArray
from fem.assembly.system import System
from fem.errors import NotDifferentiableError
from fem.linear_solver import SingularMatrixError
from fem.load import Load
from fem.results.solution import Solution, StepReport
from fem.sensitivity.changed_equations import ChangedEquations, changed_equations
from fem.sensitivity.problem_change import DifferentiatedSolution, ProblemChange, SecondDerivative, SolutionDerivative
from fem.threads import suited_threads

MOST_CORRECTIONS = 80
SETTLED = 1e-6  # last correction over the derivative; of round-off are 1e-9 to 1e-6
LEAST = 1e-30  # of a derivative
ROUND_OFF = 1e-4  # a correction below it that does not shrink is round-off


@dataclass(frozen=True)
class StateDerivative:
    """Derivatives of the unknowns (n, k) and of the press (k,) by k parameters, and the second ones by each."""

    y: FloatArray
    force: FloatArray
    second: StateDerivative | None = None


@dataclass
class Following:
    """A watch on a run that differentiates each state.

    Attributes
    ----------
    equilibrium
        The equations as told, with the linear solver.
    control
        What is prescribed.
    sides
        For each parameter the equations below and above, as they remember.
    second
        Whether second derivatives are wanted.
    time
        Of the last state, s.
    found
        Each state with its derivative.
    """

    equilibrium: Equilibrium
    control: Literal["force", "depth"]
    sides: list[tuple[ChangedEquations, ChangedEquations]]
    second: bool = False
    time: float = 0.0
    found: list[tuple[State, StateDerivative]] = field(default_factory=list)

    def __call__(self, system: System, state: State, time: float) -> None:
        """Differentiate a state that fits the equations, and remember what these remember."""
        evaluation = system.evaluate(state.y, state.pressure)
        if evaluation is None:
            raise ArithmeticError("an accepted state cannot be evaluated")
        try:
            replace(self.equilibrium, system=system).factorise(evaluation)
        except SingularMatrixError as error:
            raise NotDifferentiableError(f"a state has no derivative: {error}") from error
        remembers = system.remembers
        if remembers:
            self._each(lambda side: side.system.advanced(time - self.time))
        if system.items:
            self._each(lambda side: side.system.holding(system, state.y))
        derivative = self._refined(state) if remembers else self._first(state)
        if self.second and not remembers:
            left = evaluation.residual - state.force * self.equilibrium.unit_load
            derivative = replace(derivative, second=self._curved(state, derivative, left))
        if remembers:
            self._accept(state, derivative)
        self.time = time
        self.found.append((state, derivative))

    def _each(self, change: Callable[[ChangedEquations], System]) -> None:
        self.sides = [
            (replace(less, system=change(less)), replace(more, system=change(more))) for less, more in self.sides
        ]

    def _first(self, state: State) -> StateDerivative:
        """The derivative without a memory: one correction from none."""
        columns = [
            (more.unbalanced(state) - less.unbalanced(state)) / (more.offset - less.offset) for less, more in self.sides
        ]
        return _correction(self.equilibrium, self.control, np.stack(columns, axis=1))

    def _refined(self, state: State) -> StateDerivative:
        """The derivative with a memory, corrected until it stays."""
        count, last = len(self.sides), np.inf
        y, force = np.zeros((len(state.y), count)), np.zeros(count)
        for _ in range(MOST_CORRECTIONS):
            left = [self._left(pair, state, y[:, n], float(force[n])) for n, pair in enumerate(self.sides)]
            more = _correction(self.equilibrium, self.control, np.stack(left, axis=1))
            y, force = y + more.y, force + more.force
            size = float((np.abs(more.y).max(axis=0) / np.maximum(np.abs(y).max(axis=0), LEAST)).max())
            if size <= SETTLED or (size <= ROUND_OFF and size > 0.5 * last):
                return StateDerivative(y, force)
            last = size
        raise NotDifferentiableError(f"the derivative of friction does not settle in {MOST_CORRECTIONS} rounds")

    def _curved(self, state: State, first: StateDerivative, left: FloatArray) -> StateDerivative:
        """Second derivatives: by what the right first ones leave on both sides beyond what the state leaves (n,)."""
        columns = []
        for n, (less, more) in enumerate(self.sides):
            low, high = self._both((less, more), state, first.y[:, n], float(first.force[n]))
            below, above = -less.offset, more.offset
            if below <= 0.0 or above <= 0.0:
                raise NotDifferentiableError("a second derivative needs a change to both sides")
            columns.append(2.0 * ((low - left) / below + (high - left) / above) / (below + above))
        return _correction(self.equilibrium, self.control, np.stack(columns, axis=1))

    def _left(
        self, pair: tuple[ChangedEquations, ChangedEquations], state: State, dy: FloatArray, df: float
    ) -> FloatArray:
        """What the changed equations leave unbalanced at the states beside, over the parameter, (n,)."""
        low, high = self._both(pair, state, dy, df)
        out: FloatArray = (high - low) / (pair[1].offset - pair[0].offset)
        return out

    @staticmethod
    def _both(
        pair: tuple[ChangedEquations, ChangedEquations], state: State, dy: FloatArray, df: float
    ) -> tuple[FloatArray, FloatArray]:
        """What each of the changed equations leaves unbalanced at the state beside, (n,) N."""
        forces = []
        for side in pair:
            beside = side.beside(state, dy, df)
            forces.append(replace(side, system=side.system.fitted(beside.y)).unbalanced(beside))
        return forces[0], forces[1]

    def _accept(self, state: State, derivative: StateDerivative) -> None:
        """Let the changed equations remember the states beside."""
        kept = []
        for n, pair in enumerate(self.sides):
            both = []
            for side in pair:
                y = side.beside(state, derivative.y[:, n], float(derivative.force[n])).y
                both.append(replace(side, system=side.system.fitted(y).accepted(y)))
            kept.append((both[0], both[1]))
        self.sides = kept


def _correction(problem: Equilibrium, control: str, unbalanced: FloatArray) -> StateDerivative:
    """Derivatives by which unbalanced forces (n, k) vanish, with the factors that the solver has.

    Raises
    ------
    NotDifferentiableError
        If they are no finite numbers, as where the state lies on a limit point.
    """
    count, by_force = unbalanced.shape[1], control == "force"
    right = -unbalanced if by_force else np.column_stack((-unbalanced, problem.unit_load))
    try:
        solved = problem.solver.solve(right)
    except SingularMatrixError as error:
        raise NotDifferentiableError(f"a state has no derivative: {error}") from error
    if by_force:
        return StateDerivative(solved, np.zeros(count))
    free, loaded = solved[:, :count], solved[:, count]
    if loaded[problem.probe] == 0.0:
        raise NotDifferentiableError("a state has no derivative: the depth does not depend on the force")
    force = -free[problem.probe] / loaded[problem.probe]
    return StateDerivative(free + loaded[:, None] * force, force)


def differentiated_run(
    model: Model,
    load: Load,
    changes: Mapping[str, ProblemChange],
    on_step: Callable[[StepReport], None] | None = None,
    *,
    second: bool = False,
) -> DifferentiatedSolution:
    """See :func:`fem.differentiate`."""
    if second and model.problem.kinematics == "linear":
        raise NotDifferentiableError("kinematics = 'linear' has first derivatives only")
    sides = [
        (changed_equations(model, each.less, -each.below), changed_equations(model, each.more, each.above))
        for each in changes.values()
    ]
    names = tuple(layer.name for layer in model.problem.layers)
    record = Record(model.mesh, model.equilibrium, model.recovery, names)
    with suited_threads(model.unknowns):
        if model.problem.kinematics == "linear":
            solution = run_linear(record, load, model.warnings, on_step)
            derivatives = _linear(model, load, sides, record) if changes else []
        else:
            watch = Following(model.equilibrium, load.control, sides, second, load.start)
            each = watch if changes else None
            solution = run_nonlinear(record, load, model.newton, model.warnings, on_step, None, each)
            known = {id(state): derivative for state, derivative in watch.found}
            derivatives = [known[id(state)] for state in record.states] if changes else []
    return DifferentiatedSolution(solution, _by_name(model, changes, sides, derivatives, solution))


def _linear(
    model: Model, load: Load, sides: list[tuple[ChangedEquations, ChangedEquations]], record: Record
) -> list[StateDerivative]:
    """Derivatives of states in small strain, with the tangent at rest."""
    if model.equilibrium.system.elements.memory is not None:
        raise NotDifferentiableError(
            "kinematics = 'linear' with relaxation has no derivative here; use kinematics = 'finite'"
        )
    unit_state(model.equilibrium)
    found = []
    for state in record.states:
        columns = [
            (more.unbalanced_linear(state) - less.unbalanced_linear(state)) / (more.offset - less.offset)
            for less, more in sides
        ]
        found.append(_correction(model.equilibrium, load.control, np.stack(columns, axis=1)))
    return found


def _by_name(
    model: Model,
    changes: Mapping[str, ProblemChange],
    sides: list[tuple[ChangedEquations, ChangedEquations]],
    derivatives: list[StateDerivative],
    solution: Solution,
) -> dict[str, SolutionDerivative]:
    numbering = replace(model.equilibrium.system.numbering, prescribed=None)
    probe, steps = model.equilibrium.probe, len(solution.time)

    def rows(each: list[StateDerivative], n: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Force (s,), depth (s,) and nodal displacements (s, N, components)."""
        y = np.array([one.y[:, n] for one in each]).reshape(steps, numbering.count)
        force: FloatArray = np.array([one.force[n] for one in each])
        return force, -y[:, probe], numbering.expand(y).swapaxes(1, 2)

    seconds = [each.second for each in derivatives if each.second is not None]
    found = {}
    for n, (name, (less, more)) in enumerate(zip(changes, sides, strict=True)):
        velocity = (more.nodes - less.nodes) / (more.offset - less.offset)
        second = SecondDerivative(*rows(seconds, n)) if seconds else None
        found[name] = SolutionDerivative(*rows(derivatives, n), velocity, second)
    return found
