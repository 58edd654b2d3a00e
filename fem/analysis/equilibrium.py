"""The equilibrium problem of a run, and its states: equations, unit load, depth probe; how a Newton run ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from fem.arrays import FloatArray
from fem.assembly.system import Evaluation, System
from fem.linear_solver import IterativeSolver, SymmetricSolver


@dataclass(frozen=True)
class Equilibrium:
    """Internal forces = force * unit load, with the force or the depth prescribed.

    Attributes
    ----------
    system
        Residual and tangent.
    solver
        Linear solver of the tangent's pattern.
    unit_load
        Forces (n,) on the unknowns of a press of 1 N.
    probe
        Unknown whose downward displacement is the depth.
    """

    system: System
    solver: SymmetricSolver | IterativeSolver
    unit_load: FloatArray
    probe: int

    def factorise(self, state: Evaluation) -> Callable[[FloatArray], float]:
        """Make the linear solver ready for the tangent at a state.

        Returns
        -------
        callable
            Norm in N of the forces that round-off leaves unbalanced at unknowns (n,).

        Raises
        ------
        SingularMatrixError
            If the tangent is singular.
        """
        if isinstance(self.solver, IterativeSolver):
            self.solver.factorise(self.system.element_tangent(state))
            return self.solver.round_off
        tangent = self.system.tangent(state)
        self.solver.factorise(tangent)
        return partial(self.system.scatter.round_off, tangent)

    def solve(self, right: FloatArray, tolerance: float) -> FloatArray:
        """Solution (n, k) of right-hand sides (n, k), with at most `tolerance` of each left by an iterative solver."""
        if isinstance(self.solver, IterativeSolver):
            return self.solver.solve(right, tolerance)
        return self.solver.solve(right)

    def depth(self, y: FloatArray) -> float:
        """Depth in m of the unknowns (n,)."""
        return float(-y[self.probe])


@dataclass(frozen=True)
class State:
    """Displacement, pressure and force, in equilibrium or a guess at it.

    Attributes
    ----------
    y
        Unknowns (n,) in m.
    pressure
        Pressure coefficients (p, E).
    force
        Press of the tool in N.
    """

    y: FloatArray
    pressure: FloatArray
    force: float


@dataclass(frozen=True)
class NewtonResult:
    """How a Newton run ended.

    Attributes
    ----------
    state
        The state reached; in equilibrium if `reason` is empty.
    iterations
        Number of Newton corrections made.
    reason
        Why it failed, or "".
    round_off
        Of the factors that the solver holds after a success, see :meth:`Equilibrium.factorise`.
    unstable
        Whether it was seen that the body would leave the equilibrium by itself.
    """

    state: State
    iterations: int
    reason: str = ""
    round_off: Callable[[FloatArray], float] | None = None
    unstable: bool = False

    @property
    def success(self) -> bool:
        """Whether equilibrium was found."""
        return not self.reason
