"""Solvers of symmetric systems: direct ones of a pattern, by one choice, and an iterative one of elements."""

from fem.linear_solver.direct import LINEAR_SOLVERS, make_solver
from fem.linear_solver.iterative import IterativeSolver
from fem.linear_solver.symmetric import SingularMatrixError, SymmetricSolver

__all__ = ["LINEAR_SOLVERS", "IterativeSolver", "SingularMatrixError", "SymmetricSolver", "make_solver"]
