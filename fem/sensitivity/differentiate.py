"""A run with its derivatives by parameters of the problem. Light to import, like :mod:`fem.setup.prepare`.

At each state of equilibrium R(y, f; p) = 0, so that K dy/dp = -dR/dp with the tangent K of that state: one
factorisation and one solve with a right-hand side a parameter, instead of two more runs. dR/dp is semi-analytical, a
central difference of the assembled equations at held unknowns (K. K. Choi and N.-H. Kim, Structural Sensitivity
Analysis and Optimization 2, 2005, chapters 6 and 7): exact but for round-off where a parameter enters them linearly, as
most constants of laws do.

A parameter is whatever two problems differ in. The mesh keeps its topology: its nodes move with tool, rims and layers
(:mod:`fem.sensitivity.changed_equations`), and its outer border stays.

What the equations leave unbalanced at p +- h and y +- h dy/dp is -h^2/2 K d2y/dp2: second derivatives cost one more
solve. They want a change of 1e-5 to 1e-3 of what matters in both directions, for round-off grows with its square.

Touch, stick and slip are those of the state: where a node is about to change, the derivative is that of one side. What
friction and relaxation remember is differentiated step by step.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from fem.load import Load
from fem.results.solution import StepReport
from fem.sensitivity.problem_change import DifferentiatedSolution, ProblemChange

if TYPE_CHECKING:
    from fem.analysis.prepared import Model


def differentiate(
    model: Model,
    load: Load,
    changes: Mapping[str, ProblemChange],
    on_step: Callable[[StepReport], None] | None = None,
    *,
    second: bool = False,
) -> DifferentiatedSolution:
    """Follow a load history and differentiate each of its steps.

    Parameters
    ----------
    model
        A prepared problem.
    load
        Prescribed force or depth over time.
    changes
        The problem with one parameter changed a little, by any name.
    on_step
        Called after each accepted step.
    second
        Whether second derivatives by each parameter are wanted as well; with friction or relaxation there are none.

    Raises
    ------
    NotDifferentiableError
        Problems that differ in kind, whose mesh cannot follow, or without a derivative here (small strain with
        relaxation; a tool's or hole's radius in three dimensions where the tool is tied).
    """
    from fem.sensitivity.following import differentiated_run

    return differentiated_run(model, load, changes, on_step, second=second)
