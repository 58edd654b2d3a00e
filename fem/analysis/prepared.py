"""A prepared model: mesh, equations and linear solver of one problem, ready for load histories."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fem.analysis.checkpoint import Checkpoint, Keeper, run_fingerprint
from fem.analysis.equilibrium import Equilibrium
from fem.analysis.limit_points import NONE_NEAR
from fem.analysis.linear import run_linear
from fem.analysis.newton import NewtonSettings
from fem.analysis.nonlinear import run_nonlinear
from fem.analysis.record import Record
from fem.linear_solver import IterativeSolver
from fem.load import Load
from fem.mesh.quads import Mesh
from fem.mesh.solid import AnyMesh
from fem.problem.problem import Problem
from fem.results.fields import FieldRecovery
from fem.results.solution import Solution, StepReport
from fem.threads import suited_threads

PULLING = "the load history pulls (negative values): the contact is tied to the surface and cannot lift off"

BULGE = 0.01
"""Of a cylinder's height, by which its side may go past a plate before it is said."""
GLUED = "the load history pulls (negative values): the specimen is glued to its plates and cannot come off"
BY_DEPTH = "a press by depth may go on from there"
COARSER = "a coarser mesh, whose elements at the tool's edge fold later, may follow a deeper press"
ROUNDER = "a larger edge_radius of the tool may follow a deeper press"

FOLDED = 0.0
"""Cosine between the surface on both sides of a node, below which it has folded: it turns there by more than the right
angle by which a tool's edge turns it."""

LIFTING = (
    "the load history pulls (negative values): the tool comes off once it pulls more than its adhesion force; a depth "
    "is then reached without force, a prescribed pull is not"
)


@dataclass(frozen=True)
class Model:
    """A problem with its mesh, equations and linear solver.

    Attributes
    ----------
    problem
        What was asked.
    mesh
        The mesh.
    equilibrium
        Equations, linear solver, unit load and depth probe.
    recovery
        Evaluates stress and strain.
    newton
        Limits of Newton's method.
    warnings
        Texts for people, repeated in every solution.
    """

    problem: Problem
    mesh: AnyMesh
    equilibrium: Equilibrium
    recovery: FieldRecovery
    newton: NewtonSettings
    warnings: tuple[str, ...]

    @property
    def unknowns(self) -> int:
        """Number of displacement unknowns; the pressure is condensed."""
        return self.equilibrium.system.numbering.count

    @property
    def linear_solver(self) -> str:
        """Name of the linear solver in use."""
        return self.equilibrium.solver.name

    @property
    def within_limits(self) -> Model:
        """The same model, whose presses end where they would go over a limit point (:mod:`fem.analysis.limit_points`).

        For curves that must be smooth: beyond one they jump.
        """
        return replace(self, newton=replace(self.newton, beyond_limits=False))

    def run(
        self,
        load: Load,
        on_step: Callable[[StepReport], None] | None = None,
        checkpoint: str | Path | Keeper | None = None,
    ) -> Solution:
        """Follow a load history.

        Parameters
        ----------
        load
            Prescribed force or depth over time.
        on_step
            Called after each accepted step that was computed here.
        checkpoint
            File in which a run at finite strain keeps its accepted steps, each one, or a keeper round
            :meth:`checkpoint` that decides which. If the file exists, the run goes on from there; after the last
            step it stays, and can be removed. A linear run, which is one solve, has none.

        Returns
        -------
        Solution
            With `complete` False and a `failure` if a step could not be reached; never raises for that.

        Raises
        ------
        CheckpointError
            If the checkpoint cannot be written, is damaged, or is of another problem, mesh, load history or solver.
        """
        record = Record(self.mesh, self.equilibrium, self.recovery, self._names())
        warnings = self.warnings + ((self._pulling,) if load.value.min() < 0.0 else ())
        with suited_threads(self.unknowns):
            if self.problem.kinematics == "linear":
                return self._remarked(run_linear(record, load, warnings, on_step))
            kept = self.checkpoint(load, checkpoint) if isinstance(checkpoint, (str, Path)) else checkpoint
            found = run_nonlinear(record, load, self.newton, warnings, on_step, kept)
            return self._remarked(self._bulged(self._advised(found)))

    def checkpoint(self, load: Load, path: str | Path) -> Checkpoint:
        """The file in which a run of a load history keeps its steps."""
        return Checkpoint(Path(path), run_fingerprint(self.problem, self.mesh, load))

    def _remarked(self, solution: Solution) -> Solution:
        """The solution; where another linear solver took over it says so."""
        solver = self.equilibrium.solver
        if not isinstance(solver, IterativeSolver) or not solver.remark:
            return solution
        return replace(solution, warnings=(*solution.warnings, solver.remark))

    def _advised(self, solution: Solution) -> Solution:
        """The solution; a press that the mesh could not follow with what may go further."""
        failure = solution.failure
        touches = self.problem.touches
        coarse = self.problem.discretisation.density == "coarse" and not touches
        if failure is None or coarse or failure.target <= failure.reached:
            return solution
        advice = ROUNDER if touches else COARSER
        if failure.reason == NONE_NEAR and failure.control == "force":
            advice = f"{BY_DEPTH}, and {advice}"
        reason = f"{failure.reason}{self._folded(solution)}; {advice}"
        return replace(solution, failure=replace(failure, reason=reason))

    def _folded(self, solution: Solution) -> str:
        """Where the surface has folded in the last state of equilibrium of a plane mesh, in words, or "".

        At an edge that it is stuck to it may turn as it likes.
        """
        reached = solution if solution.last is None else solution.last
        if not isinstance(self.mesh, Mesh) or not len(reached.time):
            return ""
        row = self.mesh.interfaces[0]
        place = (self.mesh.nodes + reached.displacement[-1])[row]
        side = np.diff(place, axis=0)
        side /= np.linalg.norm(side, axis=1)[:, None]
        turn = np.sum(side[1:] * side[:-1], axis=1)
        if self.problem.is_stuck:
            turn[self.mesh.nodes[row[1:-1], 0] == self.problem.tool.radius] = 1.0
        sharpest = int(turn.argmin())
        if turn[sharpest] > FOLDED:
            return ""
        return f": the surface has folded {1e3 * place[sharpest + 1, 0]:.3g} mm from the axis"

    def _bulged(self, solution: Solution) -> Solution:
        """The solution; that of a cylinder with how far its free side goes past the plates, which do not stop it."""
        mesh, height = self.mesh, -float(self.mesh.nodes[:, -1].min())
        if self.problem.support.kind != "plates" or not solution.depth.size:
            return solution
        z = mesh.nodes[mesh.border, -1] + solution.displacement[:, mesh.border, -1]
        past = np.maximum(z.max(axis=1) + solution.depth, -height - z.min(axis=1))
        seen = np.flatnonzero(past > BULGE * height)
        if not seen.size:
            return solution
        first, most = 1e3 * float(solution.depth[seen[0]]), 1e3 * float(past.max())
        said = (
            f"the cylinder's free side bulges past the plates, by {most:.2g} mm at most and from {first:.3g} mm on by "
            f"more than {100 * BULGE:g} % of its height; real plates stop it and carry more force there"
        )
        return replace(solution, warnings=(*solution.warnings, said))

    @property
    def _pulling(self) -> str:
        """What a history that pulls must know of this contact."""
        if self.problem.support.kind == "plates":
            return GLUED
        return LIFTING if self.problem.touches else PULLING

    def _names(self) -> tuple[str, ...]:
        return tuple(layer.name for layer in self.problem.layers)
