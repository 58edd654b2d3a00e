"""Direct solvers of symmetric sparse systems, one a file, behind one factory."""

from fem.linear_solver.factory import LINEAR_SOLVERS, make_solver
from fem.linear_solver.symmetric import SingularMatrixError, SymmetricSolver

__all__ = ["LINEAR_SOLVERS", "SingularMatrixError", "SymmetricSolver", "make_solver"]
