"""Small-strain runs: the solution of a press of 1 N, scaled; with layers that relax one linear system a step.

The stiffness of a step of relaxation depends on its duration only: it is factorised anew where that changes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fem.analysis.equilibrium import Equilibrium, State
from fem.analysis.record import Record, largest_strain
from fem.analysis.stepping import at_rest, settle_linear
from fem.arrays import FloatArray
from fem.assembly.system import System
from fem.load import Load
from fem.results.solution import Solution, StepReport

LARGEST_SMALL_STRAIN = 0.05
SAME_DURATION = 1e-12
UNBALANCED = 1e-3
"""Of the force, what supports may miss of it; a film 1e8 times as stiff as its base misses 2e-5 by round-off."""
CLOSE = 1e-11  # residual over the load that a direct solver aims at; round-off of layers 1 : 100 leaves 1e-10


def run_linear(
    record: Record,
    load: Load,
    warnings: tuple[str, ...],
    on_step: Callable[[StepReport], None] | None,
) -> Solution:
    """Scale the unit solution with the load.

    Parameters
    ----------
    record
        Empty record of the model.
    load
        Prescribed force (N) or depth (m).
    warnings
        Texts of the model.
    on_step
        Called after each step.
    """
    problem = record.equilibrium
    if problem.system.remembers:
        return run_relaxing(record, load, warnings, on_step)
    unit, unit_reaction = unit_state(problem)
    start = settle_linear(problem)
    compliance, depth = problem.depth(unit.y), problem.depth(start.y)
    strain = None if problem.system.is_displaced else largest_strain(problem.system, unit.y, finite=False)
    forces: FloatArray = load.value if load.control == "force" else (load.value - depth) / compliance
    for n, (time, force) in enumerate(zip(load.time.tolist(), forces.tolist(), strict=True)):
        state = State(start.y + force * unit.y, start.pressure + force * unit.pressure, force)
        largest = largest_strain(problem.system, state.y, finite=False) if strain is None else abs(force) * strain
        record.add(time, state, force * unit_reaction, largest)
        if on_step is not None:
            on_step(StepReport(n + 1, len(forces), time, force, problem.depth(state.y), 0, 0))
    return record.solution(None, warnings + balance_warning(unit_reaction) + strain_warning(record.strains))


def run_relaxing(
    record: Record, load: Load, warnings: tuple[str, ...], on_step: Callable[[StepReport], None] | None
) -> Solution:
    """Follow a load history with layers that relax; the arguments are those of :func:`run_linear`."""
    body = RelaxingBody(record.equilibrium)
    times = np.concatenate(([load.start], load.time))
    for n, (time, value) in enumerate(zip(load.time.tolist(), load.value.tolist(), strict=True)):
        state, returned = body.step(float(times[n + 1] - times[n]), load.control, value)
        record.add(time, state, returned, largest_strain(body.system, state.y, finite=False))
        if on_step is not None:
            on_step(StepReport(n + 1, len(load.time), time, state.force, record.equilibrium.depth(state.y), 0, 0))
    return record.solution(None, warnings + strain_warning(record.strains))


class RelaxingBody:
    """A body in small strain with its memory and the factors of the last duration.

    Parameters
    ----------
    problem
        Its equations at rest; a layer must relax.
    """

    def __init__(self, problem: Equilibrium) -> None:
        memory = problem.system.elements.memory
        if memory is None:
            raise ArithmeticError("a body without relaxation has no memory to follow")
        self.system: System = problem.system
        self._problem, self._rest, self._memory = problem, at_rest(problem), memory
        self._duration = -1.0
        self._unit = (State(np.zeros(0), np.zeros(0), 0.0), 0.0)

    def step(self, duration: float, control: str, value: float) -> tuple[State, float]:
        """State and reaction (N) after a step of a duration (s) to a force (N) or depth (m)."""
        self._factorise(duration)
        geometry = self.system.elements.geometry
        over = geometry.forces(self._memory.ahead(self._duration)[1] * geometry.weight)
        y = self._alone(over)
        unit, depth = self._unit[0], self._problem.depth
        force = value if control == "force" else (value - depth(y)) / depth(unit.y)
        y = y + force * unit.y
        element_force = over + self.system.linear_force(self._rest, y)
        self._remember(y)
        pressure = self.system.linear_pressure(self._rest, y)
        return State(y, pressure, force), self.system.reaction(element_force)

    def _factorise(self, duration: float) -> None:
        if abs(duration - self._duration) <= SAME_DURATION * self._duration:
            return
        elements = self._problem.system.elements
        laws = elements.laws.relaxing(self._memory.ahead(duration)[0], None)
        self._duration, self.system = duration, replace(self._problem.system, elements=replace(elements, laws=laws))
        self._unit = unit_state(replace(self._problem, system=self.system))

    def _alone(self, over: FloatArray) -> FloatArray:
        """Unknowns (n,) under the overstress's forces (k, E) and the prescribed displacements alone."""
        y = np.zeros(self.system.numbering.count)
        for _ in range(2):
            force = self.system.scatter.vector(over + self.system.linear_force(self._rest, y))
            y = y - self._problem.solver.solve(force[:, None])[:, 0]
        return y

    def _remember(self, y: FloatArray) -> None:
        elements = self.system.elements
        deformation = elements.deformation(self.system.element_displacement(y))
        self._memory = self._memory.after(self._duration, elements.laws.linear_stress(deformation))


def unit_state(problem: Equilibrium) -> tuple[State, float]:
    """State under 1 N in linear kinematics and the reaction (N) to it.

    The tangent at rest is factorised here. What a direct solver leaves is round-off, after a second pass where the
    first has not come there; an iterative solver leaves its tolerance.
    """
    system, rest = problem.system.plain, at_rest(problem)
    solver, load = problem.solver, problem.unit_load
    round_off = replace(problem, system=system).factorise(rest)
    y = solver.solve(load[:, None], solver.tolerance or CLOSE)[:, 0]
    left = load - system.linear_residual(rest, y)
    unbalanced = float(np.linalg.norm(left))
    if unbalanced > solver.tolerance * float(np.linalg.norm(load)) and unbalanced > round_off(y):
        y = y + solver.solve(left[:, None])[:, 0]
    force = system.linear_force(rest, y)
    return State(y, system.linear_pressure(rest, y), 1.0), system.reaction(force)


def balance_warning(reaction: float) -> tuple[str, ...]:
    """Warn where supports do not hold the force of 1 N (N), which the equations have them do to round-off."""
    if abs(reaction - 1.0) <= UNBALANCED:
        return ()
    return (
        f"the supports hold {100.0 * reaction:.4g} % of the tool's force: the equations are so ill-conditioned, as of "
        "a very thin sheet over a wide hole or layers whose moduli are far apart, that the linear solver does not "
        "solve them; these results are not a prediction",
    )


def strain_warning(strains: list[float]) -> tuple[str, ...]:
    """Warn of the first step whose largest strain passes 5 %."""
    beyond = np.flatnonzero(np.array(strains) > LARGEST_SMALL_STRAIN)
    if beyond.size == 0:
        return ()
    return (
        f"SMALL-STRAIN THEORY EXCEEDED: kinematics = 'linear', but the strain reaches {100 * max(strains):.3g} % "
        f"and passes {100 * LARGEST_SMALL_STRAIN:g} % from step {int(beyond[0]) + 1} of {len(strains)} on; these "
        "results are not a prediction of a large press, use kinematics = 'finite'",
    )
