"""The direct solver of a symmetric pattern: Pardiso where it can be loaded, otherwise SuperLU of SciPy, which is here.

Without being told pypardiso would search the whole environment for the MKL, which takes up to a second.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from fem.arrays import FloatArray, IndexArray
from fem.errors import FemError, require_one_of
from fem.linear_solver.symmetric import DiagonalScaling, SingularMatrixError, SymmetricSolver, checked_solution

LINEAR_SOLVERS = ("auto", "pardiso", "superlu", "iterative")
DIRECT = LINEAR_SOLVERS[:3]
VARIABLE = "PYPARDISO_MKL_RT"
PIVOT_THRESHOLD = 0.01  # of SuperLU


def make_solver(choice: str, indptr: IndexArray, indices: IndexArray) -> SymmetricSolver:
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
    require_one_of("linear_solver", choice, DIRECT)
    if choice != "superlu":
        name_library()
        try:
            from fem.linear_solver.pardiso import PardisoSolver

            return PardisoSolver(indptr, indices)
        except ImportError as error:
            if choice == "pardiso":
                raise FemError(f"linear_solver = 'pardiso': cannot be loaded ({error}); use 'superlu'") from error
    return SuperLUSolver(indptr, indices)


def name_library(prefix: str = sys.prefix) -> None:
    """Tell pypardiso the library of this environment by its variable, unless the user has set it."""
    for pattern in ("lib/libmkl_rt.so*", "Library/bin/mkl_rt*.dll"):
        for path in sorted(Path(prefix).glob(pattern)):
            os.environ.setdefault(VARIABLE, str(path))


class SuperLUSolver:
    """SuperLU in symmetric mode for one pattern; the ordering is made anew in each factorisation.

    Parameters
    ----------
    indptr, indices
        Pattern of the upper triangle in compressed rows, diagonal first in each row.
    """

    name = "superlu"
    tolerance = 0.0

    def __init__(self, indptr: IndexArray, indices: IndexArray) -> None:
        count = len(indptr) - 1
        self._scaling = DiagonalScaling(indptr, indices)
        row = np.repeat(np.arange(count), np.diff(indptr))
        mirrored = np.flatnonzero(row != indices)
        source = np.concatenate((np.arange(len(indices)), mirrored))
        rows = np.concatenate((row, indices[mirrored]))
        columns = np.concatenate((indices, row[mirrored]))
        order = np.lexsort((rows, columns))
        self._source = source[order]
        starts = np.searchsorted(columns[order], np.arange(count + 1))
        self._matrix = sp.csc_matrix((np.ones(order.size), rows[order], starts), shape=(count, count))
        self._factors: spla.SuperLU | None = None

    def factorise(self, data: FloatArray) -> None:
        """Factorise the entries (nnz,).

        Raises
        ------
        SingularMatrixError
            If the matrix is singular.
        """
        self._matrix.data[:] = self._scaling.scale(data)[self._source]
        try:
            self._factors = spla.splu(
                self._matrix,
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=PIVOT_THRESHOLD,
                options={"SymmetricMode": True},
            )
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from error

    @property
    def negative(self) -> int | None:
        """Negative eigenvalues, by the pivots (Sylvester's law of inertia); None where rows were exchanged."""
        factors = self._factors
        if factors is None or not np.array_equal(factors.perm_r, factors.perm_c):
            return None
        return int(np.count_nonzero(factors.U.diagonal() < 0.0))

    def solve(self, right: FloatArray, tolerance: float = 0.0) -> FloatArray:  # noqa: ARG002 (it comes to round-off)
        """Solution (n, k) of right-hand sides (n, k), whatever the tolerance.

        Raises
        ------
        SingularMatrixError
            If nothing was factorised, or the solution is not finite.
        """
        if self._factors is None:
            raise SingularMatrixError("nothing is factorised")
        factor = self._scaling.factor[:, None]
        return checked_solution(factor * self._factors.solve(factor * right))
