"""From a problem to a model. Light to import; the numerical libraries are loaded by the first call."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fem.problem.problem import Problem

if TYPE_CHECKING:
    from fem.analysis.prepared import Model


def prepare(problem: Problem, linear_solver: str = "auto", mesh_file: str | Path | None = None) -> Model:
    """Mesh a problem and set up its equations, once for all load histories.

    Parameters
    ----------
    problem
        Layers, tool, support, kinematics and discretisation.
    linear_solver
        "auto" (Pardiso where it installs, otherwise SuperLU; "iterative" for large blocks), "pardiso", "superlu" or
        "iterative" (multigrid; for blocks without a tool that touches).
    mesh_file
        File in which the mesh of a body from a surface is kept, and taken from if it holds that of the same body; the
        mesher never makes the same mesh twice, which a checkpoint of a run needs. Other meshes need none.

    Returns
    -------
    Model
        Ready to :meth:`~fem.analysis.prepared.Model.run`.

    Raises
    ------
    FemError
        If the contact or the solver is not available for this problem, or the mesh file cannot be written.
    """
    from fem.setup.building import build_model

    return build_model(problem, linear_solver, None if mesh_file is None else Path(mesh_file))
