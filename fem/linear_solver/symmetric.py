"""What a solver of symmetric sparse systems gives, and the scaling and the Krylov method that the solvers use."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeAlias

import numpy as np

from fem.arrays import FloatArray, IndexArray

ROWS_AT_ONCE = 4096  # so that what is made of their entries is small
Operator: TypeAlias = Callable[[FloatArray], FloatArray]
"""A linear map of vectors (n,)."""


class SingularMatrixError(ArithmeticError):
    """The matrix could not be factorised or the solution is not finite."""


class SymmetricSolver(Protocol):
    """Direct solver of one sparsity pattern, whose values may change."""

    @property
    def name(self) -> str:
        """Which solver this is, for reports."""
        ...

    @property
    def tolerance(self) -> float:
        """Unbalanced over given forces that a solution may leave; 0 where refinement takes it to round-off."""
        ...

    @property
    def negative(self) -> int | None:
        """Negative eigenvalues of what was factorised last; None where the factors do not tell."""
        ...

    def factorise(self, data: FloatArray) -> None:
        """Factorise the upper triangle with entries (nnz,)."""
        ...

    def solve(self, right: FloatArray, tolerance: float = ...) -> FloatArray:
        """Solution (n, k) of right-hand sides (n, k), with about `tolerance` of each left, or less."""
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

    def __init__(self, indptr: IndexArray, indices: IndexArray) -> None:
        self._indptr = indptr
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
        diagonal = np.abs(data[self._indptr[:-1]])
        self.factor = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
        out = np.empty_like(data)
        for start in range(0, len(self.factor), ROWS_AT_ONCE):
            ends = self._indptr[start : start + ROWS_AT_ONCE + 1]
            part = slice(ends[0], ends[-1])
            of_row = np.repeat(self.factor[start : start + ROWS_AT_ONCE], np.diff(ends))
            np.multiply(data[part], of_row * self.factor[self._column[part]], out=out[part])
        return out


def checked_solution(solution: FloatArray) -> FloatArray:
    """Return the solution.

    Raises
    ------
    SingularMatrixError
        If it is not finite.
    """
    if not np.isfinite(solution).all():
        raise SingularMatrixError("the stiffness matrix is singular")
    return solution


def flexible_gmres(
    times: Operator, precondition: Operator, right: FloatArray, tolerance: float, iterations: int
) -> tuple[FloatArray, int, float]:
    """Solve by the flexible GMRES without restart.

    Parameters
    ----------
    times, precondition
        Products with the matrix and with about its inverse.
    right
        Right-hand side (n,).
    tolerance
        Norm of the residual over that of the right-hand side to stop at.
    iterations
        Most iterations.

    Returns
    -------
    tuple
        Solution (n,), iterations made, and the norm of its residual over that of the right-hand side.
    """
    size = float(np.linalg.norm(right))
    if size == 0.0:
        return np.zeros_like(right), 0, 0.0
    basis, ahead = np.empty((iterations + 1, len(right))), np.empty((iterations, len(right)))
    hessenberg, target = np.zeros((iterations + 1, iterations)), np.zeros(iterations + 1)
    basis[0], target[0] = right / size, size
    for k in range(iterations):
        ahead[k] = precondition(basis[k])
        following = times(ahead[k])
        for _ in range(2):  # once more, since one pass loses orthogonality
            share = basis[: k + 1] @ following
            hessenberg[: k + 1, k] += share
            following = following - share @ basis[: k + 1]
        hessenberg[k + 1, k] = np.linalg.norm(following)
        small = hessenberg[: k + 2, : k + 1]
        weights = np.linalg.lstsq(small, target[: k + 2], rcond=None)[0]
        left = float(np.linalg.norm(target[: k + 2] - small @ weights)) / size
        if left <= tolerance or hessenberg[k + 1, k] == 0.0 or not np.isfinite(left):
            break
        basis[k + 1] = following / hessenberg[k + 1, k]
    return weights @ ahead[: len(weights)], len(weights), left
