"""Pardiso of the MKL: symmetric indefinite LDL^T of the upper triangle, analysed once.

Large systems are factorised in single precision, in half the time and memory. The factors then precondition the
flexible GMRES in double precision (E. Carson and N. J. Higham,
SIAM Journal on Scientific Computing 40 (2018) A817). Where it does not come there, the system is factorised in double.
"""

from __future__ import annotations

import copy
import ctypes
import weakref
from typing import TypeAlias

import numpy as np
import pypardiso
import scipy.sparse as sp
from numpy.typing import DTypeLike, NDArray
from pypardiso.pardiso_wrapper import PyPardisoError

from fem.arrays import FloatArray, IntArray
from fem.linear_solver.symmetric import DiagonalScaling, SingularMatrixError, flexible_gmres, require_finite

REAL_SYMMETRIC_INDEFINITE = -2
ANALYSE, FACTORISE, SOLVE = 11, 22, 33
# iparm by its number from 0: own values, METIS, two steps of refinement only where pivots were perturbed, by 1e-8,
# Bunch-Kaufman pivots. By default refinement takes its two steps every time.
CONTROLS = {0: 1, 1: 2, 7: 0, 9: 8, 20: 1}
SINGLE_PRECISION = 27  # of iparm, 1 for single
SMALL = 10_000  # unknowns below which threads wait for each other longer than they work
SINGLE_FROM = 30_000  # unknowns; below, the iterations take what the factorisation saves
# Residual over right-hand side, scaled to a unit diagonal; one pass of refinement takes it to round-off.
TOLERANCE = 1e-9
MOST_ITERATIONS = 30  # three times what layers of 1 MPa on 10 kPa take
Single: TypeAlias = NDArray[np.float32]
Values: TypeAlias = FloatArray | Single


class PardisoSolver:
    """Pardiso for one pattern.

    Parameters
    ----------
    indptr, indices
        Pattern of the upper triangle in compressed rows, diagonal first in each row.
    single_from
        Unknowns from which on the factors are single.
    """

    name = "pardiso"
    tolerance = 0.0

    def __init__(self, indptr: IntArray, indices: IntArray, single_from: int = SINGLE_FROM) -> None:
        count = len(indptr) - 1
        self._scaling = DiagonalScaling(indptr, indices)
        self._matrix = sp.csr_array(
            (np.ones(len(indices)), indices.astype(np.int32), indptr.astype(np.int32)), shape=(count, count)
        )
        self._factors = Factors(self._matrix, np.float32 if count >= single_from else np.float64)

    @property
    def is_single(self) -> bool:
        """Whether the factors are in single precision."""
        return self._factors.dtype == np.float32

    def factorise(self, data: FloatArray) -> None:
        """Factorise the entries (nnz,).

        Raises
        ------
        SingularMatrixError
            If Pardiso finds no factors.
        """
        self._matrix.data[:] = self._scaling.scale(data)
        if self.is_single:
            try:
                self._factors.factorise(self._matrix.data)
                return
            except SingularMatrixError:
                self._take_double()
        self._factors.factorise(self._matrix.data)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution (n, k) of right-hand sides (n, k).

        Raises
        ------
        SingularMatrixError
            If the solution is not finite.
        """
        factor = self._scaling.factor[:, None]
        scaled = factor * right
        found = self._refined(scaled) if self.is_single else self._factors.solve(scaled)
        return require_finite(factor * found)

    def _refined(self, right: FloatArray) -> FloatArray:
        """Solution (n, k) by single factors, or by double ones where those do not suffice."""
        found = []
        for column in right.T:
            x, _, left = flexible_gmres(self._times, self._approximate, column, TOLERANCE, MOST_ITERATIONS)
            if not left <= TOLERANCE:
                self._take_double()
                self._factors.factorise(self._matrix.data)
                return self._factors.solve(right)
            found.append(x)
        return np.stack(found, axis=1)

    def _take_double(self) -> None:
        """Double factors from now on; the memory of the single ones is given back first."""
        del self._factors
        self._factors = Factors(self._matrix, np.float64)

    def _times(self, x: FloatArray) -> FloatArray:
        """Product (n,) of the scaled matrix, whose diagonal is 1 or -1, with x (n,)."""
        upper = self._matrix
        out: FloatArray = upper @ x + upper.T @ x - upper.data[upper.indptr[:-1]] * x
        return out

    def _approximate(self, residual: FloatArray) -> FloatArray:
        """Solution (n,) in single precision of a residual (n,)."""
        return self._factors.solve(residual[:, None])[:, 0]


class Factors:
    """Pardiso's factors of one pattern in one precision.

    Parameters
    ----------
    pattern
        Upper triangle, diagonal first in each row.
    dtype
        Double or single.
    """

    def __init__(self, pattern: sp.csr_array, dtype: DTypeLike) -> None:
        self.dtype = np.dtype(dtype)
        self._rows, self._columns = pattern.indptr + np.int32(1), pattern.indices + np.int32(1)
        self._values: Values = np.ones(1, dtype=self.dtype)
        self._solver = _new_solver()
        self._solver.iparm[SINGLE_PRECISION] = int(self.dtype == np.float32)
        count = pattern.shape[0]
        self._threads = 1 if count < SMALL else int(self._solver.libmkl.MKL_Get_Max_Threads())
        self._nothing = np.zeros((count, 1), dtype=self.dtype)
        self._values = np.ones(len(self._columns), dtype=self.dtype)
        self._call(ANALYSE, self._nothing)
        weakref.finalize(self, _release, self._solver)

    def factorise(self, data: FloatArray) -> None:
        """Factorise the entries (nnz,); SingularMatrixError if Pardiso finds no factors."""
        self._values = np.ascontiguousarray(data, dtype=self.dtype)
        self._call(FACTORISE, self._nothing)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution (n, k) of right-hand sides (n, k)."""
        size = float(np.abs(right).max()) or 1.0
        return size * self._call(SOLVE, np.asfortranarray(right / size, dtype=self.dtype)).astype(np.float64)

    def _call(self, phase: int, right: Values) -> Values:
        """One phase, always with the threads of the analysis: Pardiso crashes if they change between phases."""
        before = self._solver.libmkl.MKL_Set_Num_Threads_Local(self._threads)
        try:
            return self._pardiso(phase, right)
        except PyPardisoError as error:
            raise SingularMatrixError(f"Pardiso error {error.value} in phase {phase}") from error
        finally:
            self._solver.libmkl.MKL_Set_Num_Threads_Local(before)

    def _pardiso(self, phase: int, right: Values) -> Values:
        """One phase; pypardiso itself calls the library in double precision only."""
        solver, count, columns = self._solver, len(self._rows) - 1, right.shape[1]
        found, error = np.zeros_like(right), ctypes.c_int32(0)
        handle = solver.pt.ctypes.data_as(ctypes.POINTER(solver._pt_type[0]))
        one, silent = (ctypes.byref(ctypes.c_int32(value)) for value in (1, 0))
        kind, which, rows, sides = (
            ctypes.byref(ctypes.c_int32(value)) for value in (REAL_SYMMETRIC_INDEFINITE, phase, count, columns)
        )
        pattern = _integers(self._rows), _integers(self._columns), _integers(solver.perm)
        values, given, wanted = (array.ctypes.data_as(ctypes.c_void_p) for array in (self._values, right, found))
        controls = _integers(solver.iparm)
        solver._mkl_pardiso(
            *(handle, one, one, kind, which, rows, values, *pattern, sides, controls, silent, given, wanted),
            ctypes.byref(error),
        )
        if error.value != 0:
            raise PyPardisoError(error.value)
        out: Values = found.copy(order="C")
        return out


def _integers(array: NDArray[np.int32]) -> ctypes._Pointer[ctypes.c_int32]:
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_int32))


def _new_solver() -> pypardiso.PyPardisoSolver:
    """A solver with a memory of its own on the library pypardiso has loaded; finding it again takes 0.2 s."""
    solver = copy.copy(pypardiso.ps)
    solver.pt = np.zeros_like(solver.pt)
    solver.iparm = np.zeros_like(solver.iparm)
    solver.iparm[list(CONTROLS)] = list(CONTROLS.values())
    solver.set_matrix_type(REAL_SYMMETRIC_INDEFINITE)
    return solver


def _release(solver: pypardiso.PyPardisoSolver) -> None:
    """Give Pardiso's memory back."""
    solver.free_memory(everything=True)
