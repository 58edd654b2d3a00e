"""Pardiso of the MKL: factors of the upper triangle, analysed once.

Small systems have symmetric indefinite ones (LDL^T) in double precision. Large systems are factorised in single
precision, in half the time and memory, by Cholesky, and by LDL^T where they are not positive definite. The factors then
precondition the flexible GMRES in double precision (E. Carson and N. J. Higham, SIAM Journal on Scientific Computing
40 (2018) A817). Where it does not come there, the system is factorised in double. A way that failed is not tried again.
"""

from __future__ import annotations

import copy
import ctypes
import os
import sys
import weakref
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TypeAlias

import numpy as np
import scipy.sparse as sp
from numpy.typing import DTypeLike, NDArray

from fem.arrays import FloatArray, IndexArray
from fem.linear_solver.symmetric import DiagonalScaling, SingularMatrixError, checked_solution, flexible_gmres

MKL = "PYPARDISO_MKL_RT"


def _tell_where_mkl_is() -> None:
    """Where the MKL lies beside this Python, unless somebody said; pypardiso's own search takes up to half a second.

    It asks the compiler and the linker, and then looks through every folder of the installation.
    """
    for path in sorted(Path(sys.prefix, "lib").glob("libmkl_rt.so*"))[:1]:
        os.environ.setdefault(MKL, str(path))


_tell_where_mkl_is()

import pypardiso  # noqa: E402 - after it was told
from pypardiso.pardiso_wrapper import PyPardisoError  # noqa: E402

POSITIVE_DEFINITE, INDEFINITE = 2, -2
ANALYSE, FACTORISE, SOLVE = 11, 22, 33
# iparm by its number from 0: own values, METIS, two steps of refinement only where pivots were perturbed, by 1e-13,
# Bunch-Kaufman pivots. By default refinement takes its two steps every time.
CONTROLS = MappingProxyType({0: 1, 1: 2, 7: 0, 9: 13, 20: 1})
# Two-level factorisation of variable blocks: unknowns that are alike to 80 %, those of a node, are analysed as one.
BLOCKS = MappingProxyType({23: 1, 36: -80})
SINGLE_PRECISION = 27  # of iparm, 1 for single
NEGATIVE = 22  # of iparm, where Pardiso counts negative eigenvalues
SMALL = 10_000  # unknowns below which threads wait for each other longer than they work
SINGLE_FROM = 30_000  # unknowns; below, the iterations take what the factorisation saves
# Residual over right-hand side, scaled to a unit diagonal; one pass of refinement takes it to round-off.
TOLERANCE = 1e-9
ALONE = 1e-4  # residual that single factors leave by themselves, or less; wanted of a preconditioner
MOST_ITERATIONS = 30  # three times what layers of 1 MPa on 10 kPa take
Single: TypeAlias = NDArray[np.float32]
Values: TypeAlias = FloatArray | Single


@dataclass(frozen=True)
class Way:
    """One way to factorise.

    Attributes
    ----------
    kind
        Pardiso's number of the kind of matrix.
    dtype
        Double or single.
    controls
        Entries of iparm by their number from 0.
    """

    kind: int
    dtype: DTypeLike
    controls: Mapping[int, int]

    @property
    def is_single(self) -> bool:
        """Whether it is in single precision."""
        return self.dtype == np.float32


DOUBLE = Way(INDEFINITE, np.float64, CONTROLS)
SINGLE = (
    Way(POSITIVE_DEFINITE, np.float32, MappingProxyType({**CONTROLS, **BLOCKS})),
    Way(INDEFINITE, np.float32, MappingProxyType({**CONTROLS, **BLOCKS})),
)


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

    def __init__(self, indptr: IndexArray, indices: IndexArray, single_from: int = SINGLE_FROM) -> None:
        count = len(indptr) - 1
        self._scaling = DiagonalScaling(indptr, indices)
        self._matrix = sp.csr_array(
            (np.zeros(len(indices)), indices.astype(np.int32, copy=False), indptr.astype(np.int32, copy=False)),
            shape=(count, count),
        )
        self._ways = [*SINGLE, DOUBLE] if count >= single_from else [DOUBLE]
        self._factors = Factors(self._matrix, self.way)

    @property
    def way(self) -> Way:
        """The way to factorise that is taken now."""
        return self._ways[0]

    @property
    def is_single(self) -> bool:
        """Whether the factors are in single precision."""
        return self.way.is_single

    @property
    def negative(self) -> int | None:
        """Negative eigenvalues of what was factorised last (Sylvester's law of inertia).

        None where single factors are not Cholesky's: what they lack may be digits.
        """
        return self._factors.negative

    def factorise(self, data: FloatArray) -> None:
        """Factorise the entries (nnz,).

        Raises
        ------
        SingularMatrixError
            If Pardiso finds no factors.
        """
        self._matrix.data = self._scaling.scale(data)
        self._refactorise()

    def solve(self, right: FloatArray, tolerance: float = TOLERANCE) -> FloatArray:
        """Solution (n, k) of right-hand sides (n, k).

        Parameters
        ----------
        right
            The right-hand sides.
        tolerance
            Residual to aim at over the right-hand side, scaled to a unit diagonal. More is left where single factors
            do not come closer, at most 1e-9; double factors leave less. From 1e-4 on the factors are used as they
            are, and the residual is not looked at.

        Raises
        ------
        SingularMatrixError
            If the solution is not finite.
        """
        factor = self._scaling.factor[:, None]
        scaled = factor * right
        while self.is_single:
            found = self._refined(scaled, tolerance)
            if found is not None:
                return checked_solution(factor * found)
            self._take_next()
            self._refactorise()
        return checked_solution(factor * self._factors.solve(scaled))

    def _refactorise(self) -> None:
        """Factorise the matrix in the first way that can."""
        while True:
            try:
                self._factors.factorise(self._matrix.data)
                return
            except SingularMatrixError:
                if len(self._ways) == 1:
                    raise
            self._take_next()

    def _refined(self, right: FloatArray, tolerance: float) -> FloatArray | None:
        """Solution (n, k) by single factors; None where those do not suffice."""
        if tolerance >= ALONE:
            plain = self._factors.solve(right)
            return plain if np.isfinite(plain).all() else None
        found = []
        for column in right.T:
            x, _, left = flexible_gmres(self._times, self._approximate, column, tolerance, MOST_ITERATIONS)
            if not left <= max(tolerance, TOLERANCE):
                return None
            found.append(x)
        return np.stack(found, axis=1)

    def _take_next(self) -> None:
        """Another way from now on; the memory of the factors before is given back first."""
        del self._factors
        del self._ways[0]
        self._factors = Factors(self._matrix, self.way)

    def _times(self, x: FloatArray) -> FloatArray:
        """Product (n,) of the scaled matrix, whose diagonal is 1 or -1, with x (n,)."""
        upper = self._matrix
        out: FloatArray = upper @ x + upper.T @ x - upper.data[upper.indptr[:-1]] * x
        return out

    def _approximate(self, residual: FloatArray) -> FloatArray:
        """Solution (n,) in single precision of a residual (n,)."""
        return self._factors.solve(residual[:, None])[:, 0]


class Factors:
    """Pardiso's factors of one pattern in one way.

    Parameters
    ----------
    pattern
        Upper triangle, diagonal first in each row.
    way
        The way.
    """

    def __init__(self, pattern: sp.csr_array, way: Way) -> None:
        self._way, self.dtype = way, np.dtype(way.dtype)
        self._rows, self._columns = pattern.indptr + np.int32(1), pattern.indices + np.int32(1)
        self._values: Values = np.zeros(1, dtype=self.dtype)
        self._solver = _new_solver(way)
        count = pattern.shape[0]
        self._threads = 1 if count < SMALL else int(self._solver.libmkl.MKL_Get_Max_Threads())
        self._nothing = np.zeros((count, 1), dtype=self.dtype)
        self._values = np.zeros(len(self._columns), dtype=self.dtype)
        self._call(ANALYSE, self._nothing)
        weakref.finalize(self, _release, self._solver)

    def factorise(self, data: FloatArray) -> None:
        """Factorise the entries (nnz,); SingularMatrixError if Pardiso finds no factors."""
        np.copyto(self._values, data, casting="same_kind")
        self._call(FACTORISE, self._nothing)

    @property
    def negative(self) -> int | None:
        """Negative eigenvalues of what was factorised last, as far as the factors tell."""
        if self._way.kind == POSITIVE_DEFINITE:
            return 0
        return None if self._way.is_single else int(self._solver.iparm[NEGATIVE])

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
            ctypes.byref(ctypes.c_int32(value)) for value in (self._way.kind, phase, count, columns)
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


def _new_solver(way: Way) -> pypardiso.PyPardisoSolver:
    """A solver with a memory of its own on the library pypardiso has loaded; finding it again takes 0.2 s."""
    solver = copy.copy(pypardiso.ps)
    solver.pt = np.zeros_like(solver.pt)
    solver.iparm = np.zeros_like(solver.iparm)
    solver.iparm[list(way.controls)] = list(way.controls.values())
    solver.iparm[SINGLE_PRECISION] = int(way.is_single)
    solver.set_matrix_type(way.kind)
    return solver


def _release(solver: pypardiso.PyPardisoSolver) -> None:
    """Give Pardiso's memory back."""
    solver.free_memory(everything=True)
