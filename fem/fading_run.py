"""Small-strain runs of layers that relax: one linear system a step, factorised anew where its duration changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fem.arrays import FloatArray
from fem.assembly import Memory, System
from fem.deformation import Deformation
from fem.load import Load
from fem.record import Record, largest_strain, reaction
from fem.small_strain import strain_warning, unit_state
from fem.solution import Solution, StepReport
from fem.solving import Equilibrium, State, at_rest

SAME_DURATION = 1e-12


def run_fading(
    record: Record, load: Load, warnings: tuple[str, ...], on_step: Callable[[StepReport], None] | None
) -> Solution:
    """Follow a load history in small strain; the arguments are those of :func:`fem.linear_run.run_linear`."""
    body = FadingBody(record.equilibrium)
    times = np.concatenate(([load.start], load.time))
    for n, (time, value) in enumerate(zip(load.time.tolist(), load.value.tolist(), strict=True)):
        state, returned = body.step(float(times[n + 1] - times[n]), load.control, value)
        record.add(time, state, returned, largest_strain(body.system, state.y, finite=False))
        if on_step is not None:
            on_step(StepReport(n + 1, len(load.time), time, state.force, record.equilibrium.depth(state.y), 0, 0))
    return record.solution(None, warnings + strain_warning(record.strains))


class FadingBody:
    """A body in small strain with its memory and the factors of the last duration.

    Parameters
    ----------
    problem
        Its equations at rest; a layer must relax.
    """

    def __init__(self, problem: Equilibrium) -> None:
        memory = problem.system.memory
        if memory is None:
            raise ArithmeticError("a body without relaxation has no memory to follow")
        self.system: System = problem.system
        self._problem, self._rest, self._memory = problem, at_rest(problem), memory
        self._duration = -1.0
        self._unit = (State(np.zeros(0), np.zeros(0), 0.0), 0.0)

    def step(self, duration: float, control: str, value: float) -> tuple[State, float]:
        """State and reaction (N) after a step of a duration (s) to a force (N) or depth (m)."""
        self._factorise(duration)
        over = self.system.geometry.forces(self._memory.ahead(self._duration)[1] * self.system.geometry.weight)
        y = self._alone(over)
        unit, depth = self._unit[0], self._problem.depth
        force = value if control == "force" else (value - depth(y)) / depth(unit.y)
        y = y + force * unit.y
        element_force = over + self.system.linear_force(self._rest, y)
        self._memory = _remember(self._memory, self._duration, self.system, y)
        pressure = self.system.linear_pressure(self._rest, y)
        return State(y, pressure, force), reaction(self.system, element_force)

    def _factorise(self, duration: float) -> None:
        if abs(duration - self._duration) <= SAME_DURATION * self._duration:
            return
        laws = self._problem.system.laws.relaxing(self._memory.ahead(duration)[0], None)
        self._duration, self.system = duration, self._problem.system.with_laws(laws)
        self._unit = unit_state(replace(self._problem, system=self.system))

    def _alone(self, over: FloatArray) -> FloatArray:
        """Unknowns (n,) under the overstress's forces (18, E) and the prescribed displacements alone."""
        y = np.zeros(self.system.numbering.count)
        for _ in range(2):
            force = self.system.scatter.vector(over + self.system.linear_force(self._rest, y))
            y = y - self._problem.solver.solve(force[:, None])[:, 0]
        return y


def _remember(memory: Memory, duration: float, system: System, y: FloatArray) -> Memory:
    u = system.element_displacement(y)
    deformation = Deformation(system.geometry.components, system.geometry.gradient(u))
    return memory.after(duration, system.laws.linear_stress(deformation))
