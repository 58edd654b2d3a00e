"""What a direct solver of symmetric sparse systems gives, and the scaling both solvers use."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from fem.arrays import FloatArray, IntArray


class SingularMatrixError(ArithmeticError):
    """The matrix could not be factorised or the solution is not finite."""


class SymmetricSolver(Protocol):
    """Direct solver of one sparsity pattern, whose values may change."""

    @property
    def name(self) -> str:
        """Which solver this is, for reports."""
        ...

    def factorise(self, data: FloatArray) -> None:
        """Factorise the upper triangle with entries (nnz,)."""
        ...

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution (n, k) of right-hand sides (n, k)."""
        ...


class DiagonalScaling:
    """Scaling to a unit diagonal, S A S with S = |diag A|^(-1/2).

    Entries of layered meshes span many orders of magnitude (radius, modulus, element size); pivot
    thresholds of the solvers are meant for scaled matrices.

    Parameters
    ----------
    indptr, indices
        Pattern of the upper triangle, diagonal first in each row.
    """

    def __init__(self, indptr: IntArray, indices: IntArray) -> None:
        self._diagonal = indptr[:-1]
        self._row = np.repeat(np.arange(len(indptr) - 1), np.diff(indptr))
        self._column = indices
        self.factor = np.ones(len(indptr) - 1)

    def scale(self, data: FloatArray) -> FloatArray:
        """Scaled entries (nnz,); keeps the factors for right-hand sides.

        Raises
        ------
        SingularMatrixError
            If an entry is not finite.
        """
        if not np.isfinite(data).all():
            raise SingularMatrixError("the stiffness matrix has entries that are not finite")
        diagonal = np.abs(data[self._diagonal])
        self.factor = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
        out: FloatArray = data * self.factor[self._row] * self.factor[self._column]
        return out


def require_finite(solution: FloatArray) -> FloatArray:
    """Return the solution.

    Raises
    ------
    SingularMatrixError
        If it is not finite.
    """
    if not np.isfinite(solution).all():
        raise SingularMatrixError("the stiffness matrix is singular")
    return solution
