"""Pardiso of the MKL: symmetric indefinite LDL^T of the upper triangle, analysed once."""

from __future__ import annotations

import copy
import weakref

import numpy as np
import pypardiso
import scipy.sparse as sp
from pypardiso.pardiso_wrapper import PyPardisoError

from fem.arrays import FloatArray, IntArray
from fem.linear_solver.symmetric import DiagonalScaling, SingularMatrixError, require_finite

REAL_SYMMETRIC_INDEFINITE = -2
ANALYSE, FACTORISE, SOLVE = 11, 22, 33
# iparm by its number from 0: own values, METIS, two steps of refinement only where pivots were perturbed, by 1e-8,
# Bunch-Kaufman pivots. By default refinement takes its two steps every time.
CONTROLS = {0: 1, 1: 2, 7: 0, 9: 8, 20: 1}
SMALL = 10_000  # unknowns below which threads wait for each other longer than they work


class PardisoSolver:
    """Pardiso for one pattern.

    Parameters
    ----------
    indptr, indices
        Pattern of the upper triangle in compressed rows, diagonal first in each row.
    """

    name = "pardiso"

    def __init__(self, indptr: IntArray, indices: IntArray) -> None:
        count = len(indptr) - 1
        self._scaling = DiagonalScaling(indptr, indices)
        self._matrix = sp.csr_matrix((np.ones(len(indices)), indices, indptr), shape=(count, count))
        self._solver = _new_solver()
        self._threads = 1 if count < SMALL else int(self._solver.libmkl.MKL_Get_Max_Threads())
        self._nothing = np.zeros((count, 1))
        self._call(ANALYSE, self._nothing)
        weakref.finalize(self, _release, self._solver)

    def factorise(self, data: FloatArray) -> None:
        """Factorise the entries (nnz,).

        Raises
        ------
        SingularMatrixError
            If Pardiso finds no factors.
        """
        self._matrix.data[:] = self._scaling.scale(data)
        self._call(FACTORISE, self._nothing)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution (n, k) of right-hand sides (n, k).

        Raises
        ------
        SingularMatrixError
            If the solution is not finite.
        """
        factor = self._scaling.factor[:, None]
        return require_finite(factor * self._call(SOLVE, np.asfortranarray(factor * right)))

    def _call(self, phase: int, right: FloatArray) -> FloatArray:
        """One phase, always with the threads of the analysis: Pardiso crashes if they change between phases."""
        self._solver.set_phase(phase)
        before = self._solver.libmkl.MKL_Set_Num_Threads_Local(self._threads)
        try:
            out: FloatArray = self._solver._call_pardiso(self._matrix, right)
        except PyPardisoError as error:
            raise SingularMatrixError(f"Pardiso error {error.value} in phase {phase}") from error
        finally:
            self._solver.libmkl.MKL_Set_Num_Threads_Local(before)
        return out


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
