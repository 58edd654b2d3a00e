"""Choice of the direct solver."""

from __future__ import annotations

from fem.arrays import IntArray
from fem.checks import require_one_of
from fem.errors import FemError
from fem.linear_solver.mkl import name_library
from fem.linear_solver.superlu import SuperLUSolver
from fem.linear_solver.symmetric import SymmetricSolver

LINEAR_SOLVERS = ("auto", "pardiso", "superlu")


def make_solver(choice: str, indptr: IntArray, indices: IntArray) -> SymmetricSolver:
    """Direct solver for a pattern.

    Parameters
    ----------
    choice
        "pardiso", "superlu" or "auto": Pardiso where it can be loaded, otherwise SuperLU.
    indptr, indices
        Pattern of the upper triangle in compressed rows, diagonal first in each row.

    Raises
    ------
    FemError
        If the word is unknown, or Pardiso was asked for and cannot be loaded.
    """
    require_one_of("linear_solver", choice, LINEAR_SOLVERS)
    if choice != "superlu":
        name_library()
        try:
            from fem.linear_solver.pardiso import PardisoSolver

            return PardisoSolver(indptr, indices)
        except ImportError as error:
            if choice == "pardiso":
                raise FemError(f"linear_solver = 'pardiso': cannot be loaded ({error}); use 'superlu'") from error
    return SuperLUSolver(indptr, indices)
