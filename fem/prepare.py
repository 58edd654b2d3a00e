"""From a problem to a model. Light to import; the numerical libraries are loaded by the first call."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fem.problem import Problem

if TYPE_CHECKING:
    from fem.model import Model


def prepare(problem: Problem, linear_solver: str = "auto") -> Model:
    """Mesh a problem and set up its equations, once for all load histories.

    Parameters
    ----------
    problem
        Layers, tool, support, kinematics and discretisation.
    linear_solver
        "auto" (Pardiso where it installs, otherwise SuperLU), "pardiso" or "superlu".

    Returns
    -------
    Model
        Ready to :meth:`~fem.model.Model.run`.

    Raises
    ------
    FemError
        If the contact or the solver is not available for this problem.
    """
    from fem.build import build_model

    return build_model(problem, linear_solver)
