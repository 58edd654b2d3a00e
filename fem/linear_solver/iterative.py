"""Krylov solver of nearly incompressible bodies: displacement and pressure together, preconditioned by multigrid.

The condensed stiffness A + B^T K B with a bulk modulus K far above the shear modulus G has no good multigrid cycle of
its own. With the pressure p = K B u as an unknown again, A keeping a bulk modulus of about G,

    [ A   B^T ] [u]   [f]
    [ B  -1/K ] [p] = [0]

is preconditioned by the upper triangle of its block factors: a cycle for A, and for the Schur complement
1/K + B A^-1 B^T the diagonal 1/K + 1/(2 G) of the orthonormal pressure shapes, which it equals up to constants that
know neither K nor the mesh (M. Benzi, G. H. Golub and J. Liesen, Numerical solution of saddle point problems, Acta
Numerica 14 (2005) 1, sections 10.1 and 10.4). The preconditioner is not quite the same linear map each time (single
precision), so that the Krylov method is the flexible GMRES (Y. Saad, SIAM Journal on Scientific Computing 14 (1993)
461).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray
from fem.linear_solver.multigrid import AT_ONCE, CoarseSpace, ElementSum, MultigridCycle
from fem.linear_solver.symmetric import SingularMatrixError, SymmetricSolver, checked_solution, flexible_gmres
from fem.threads import do_in_threads, in_parts

TOLERANCE = 1e-7  # unbalanced over given forces; displacements are then 1e-8 to 1e-10 from those of a direct solver
MOST_ITERATIONS = 400  # of one solve; a million unknowns take about 80
RESTART = 100  # iterations whose vectors are kept
STALLED = 0.3  # unbalanced forces after so many over those before from which on more iterations are no use
REACH = 1e-10  # smallest residual of one run of iterations over its right-hand side
CLOSER = 0.3  # residual of displacement and pressure over that of the condensed equations that it is to give
SLOWER = 1.25  # iterations a decade over those of a new cycle from which on an old cycle is replaced
MOST_DIRECT = 400_000  # unknowns up to which a direct solver may take over; 62 000 take it 0.9 GB, these perhaps 11 GB


@dataclass(frozen=True)
class ElementTangent:
    """A stiffness element by element, the stiff part of the bulk modulus apart.

    Attributes
    ----------
    matrices
        Element matrices (E, k, k) in N/m with at most the shear modulus as bulk modulus of the pressure.
    coupling
        Volume changes (k, p, E) of the pressure shapes by the displacements, in m2 over the root of the volume.
    modulus
        Rest (E,) in Pa of the bulk modulus, which acts on those volume changes.
    shear_modulus
        Shear modulus (E,) in Pa.
    assembled
        Gives the entries (nnz,) of the condensed upper triangle, for a direct solver.
    """

    matrices: FloatArray
    coupling: FloatArray
    modulus: FloatArray
    shear_modulus: FloatArray
    assembled: Callable[[], FloatArray]


class SaddlePoint:
    """The matrix of displacement and pressure, the pressure in units that make its own block -1.

    Parameters
    ----------
    tangent
        The stiffness.
    elements
        Sums over the elements.
    count
        Number of displacement unknowns n.
    """

    def __init__(self, tangent: ElementTangent, elements: ElementSum, count: int) -> None:
        self.matrices, self._elements, self.count = tangent.matrices, elements, count
        self._coupling = np.ascontiguousarray((tangent.coupling * np.sqrt(tangent.modulus)).transpose(2, 1, 0))
        # Rows of the pressure weigh as the forces that what they leave gives once the pressure is condensed.
        self._scale = np.linalg.norm(self._coupling, axis=2).ravel()
        self._scale[self._scale == 0.0] = 1.0
        stiffness = tangent.modulus / (2.0 * tangent.shear_modulus)
        self._schur = np.repeat(1.0 / (1.0 + stiffness), self._coupling.shape[1])
        self.size = count + self._schur.size

    def volume(self, u: FloatArray) -> FloatArray:
        """B u (P,) of displacements (n,)."""
        out: FloatArray = np.einsum("epk,ek->ep", self._coupling, self._elements.gather(u)).ravel()
        return out

    def pressing(self, p: FloatArray) -> FloatArray:
        """B^T p (n,) of pressures (P,)."""
        element = np.einsum("epk,ep->ek", self._coupling, p.reshape(self._coupling.shape[:2]))
        return self._elements.scatter(element)

    def soft(self, u: FloatArray) -> FloatArray:
        """A u (n,)."""
        return self._elements.product(self.matrices, u)

    def condensed(self, u: FloatArray) -> FloatArray:
        """(A + B^T B) u (n,): the forces of displacements (n,)."""
        return self.soft(u) + self.pressing(self.volume(u))

    def round_off(self, u: FloatArray) -> float:
        """Norm in N of the forces that round-off leaves unbalanced: eps |K| |u| of displacements u (n,), a bound."""
        size, coupling = np.abs(self._elements.gather(u)), self._coupling
        element = np.empty_like(size)

        def bound(part: slice) -> None:
            volume = np.abs(coupling[part])
            np.einsum("eij,ej->ei", np.abs(self.matrices[part]), size[part], out=element[part])
            element[part] += np.einsum("epk,ep->ek", volume, np.einsum("epk,ek->ep", volume, size[part]))

        do_in_threads(bound, in_parts(len(size), AT_ONCE))
        return float(np.finfo(np.float64).eps * np.linalg.norm(self._elements.scatter(element)))

    def times(self, x: FloatArray) -> FloatArray:
        """Product (n + P,) with displacements and pressures (n + P,)."""
        u, p = np.split(x, [self.count])
        return np.concatenate((self.soft(u) + self.pressing(p), self._scale * (self.volume(u) - p)))

    def preconditioned(self, cycle: MultigridCycle, residual: FloatArray) -> FloatArray:
        """Displacements and pressures (n + P,) that remove a residual (n + P,), approximately."""
        force, volume = np.split(residual, [self.count])
        p = -self._schur * volume / self._scale
        return np.concatenate((cycle(force - self.pressing(p)), p))


class IterativeSolver:
    """Solver of one mesh's stiffness, element by element; a direct one takes over where it does not converge.

    The multigrid cycle of an earlier stiffness is kept as long as it serves nearly as well as a new one.

    Parameters
    ----------
    space
        Linear elements and columns of the mesh.
    coarse
        Direct solver of the linear elements' pattern.
    direct
        Makes a direct solver of the condensed stiffness.
    """

    tolerance = TOLERANCE
    negative = None
    """It has no factors that would tell of negative eigenvalues."""

    def __init__(self, space: CoarseSpace, coarse: SymmetricSolver, direct: Callable[[], SymmetricSolver]) -> None:
        self._space, self._coarse, self._make_direct = space, coarse, direct
        self._elements = ElementSum(space.unknowns, space.count)
        self._assembled: Callable[[], FloatArray] | None = None
        self._matrix: SaddlePoint | None = None
        self._cycle: MultigridCycle | None = None
        self._direct: SymmetricSolver | None = None
        self._pace, self._new_pace = 0.0, 0.0
        self._before: tuple[FloatArray, FloatArray] | None = None
        self.iterations = 0
        self.remark = ""

    @property
    def name(self) -> str:
        """Which solver this is, for reports."""
        return "iterative" if self._direct is None else f"iterative, then {self._direct.name}"

    def factorise(self, tangent: ElementTangent) -> None:
        """Make ready for a stiffness.

        Raises
        ------
        SingularMatrixError
            If neither multigrid nor a direct solver can be made for it.
        """
        if self._direct is not None:
            self._direct.factorise(tangent.assembled())
            return
        self._assembled, self._matrix = tangent.assembled, None  # the old one's memory first
        if self._pace > SLOWER * self._new_pace:
            self._cycle = None
        self._matrix = SaddlePoint(tangent, self._elements, self._space.count)

    def solve(self, right: FloatArray, tolerance: float = TOLERANCE) -> FloatArray:
        """Solution (n, k) of right-hand sides (n, k), with unbalanced forces of `tolerance` times the given ones.

        Raises
        ------
        SingularMatrixError
            If nothing was made ready, or neither the iterations nor a direct solver find a solution.
        """
        if self._direct is None:
            try:
                return self._all_solved(right, tolerance)
            except SingularMatrixError as error:
                self._take_direct(str(error))
        return checked_solution(self._given_up().solve(right))

    def round_off(self, u: FloatArray) -> float:
        """Norm in N of the forces that round-off leaves unbalanced at displacements (n,)."""
        return 0.0 if self._matrix is None else self._matrix.round_off(u)

    def _all_solved(self, right: FloatArray, tolerance: float) -> FloatArray:
        """Solutions (n, k); of the last load of the call before, such as that of 1 N, from what it moved then."""
        before = self._before
        starts = [before[1] if before and np.array_equal(before[0], force) else None for force in right.T]
        found = [self._solved(force, tolerance, start) for force, start in zip(right.T, starts, strict=True)]
        self._before = (right[:, -1].copy(), found[-1])
        return np.stack(found, axis=1)

    def _solved(self, force: FloatArray, tolerance: float, start: FloatArray | None) -> FloatArray:
        matrix, size, made = self._matrix, float(np.linalg.norm(force)), 0
        if matrix is None:
            raise SingularMatrixError("nothing is factorised")
        u, missing, left, stalled = np.zeros_like(force), force, size, False
        if start is not None:
            other = force - matrix.condensed(start)
            if np.linalg.norm(other) < size:
                u, missing, left = start, other, float(np.linalg.norm(other))
        while not left <= tolerance * size:
            if made >= MOST_ITERATIONS or stalled or not np.isfinite(left):
                raise SingularMatrixError(f"{made} iterations left {left / size:.1e} of the forces unbalanced")
            step, more = self._step(matrix, missing, max(CLOSER * tolerance * size / left, REACH))
            u, made, before = u + step, made + more, left
            missing = force - matrix.condensed(u)
            left = float(np.linalg.norm(missing))
            stalled = more >= RESTART and left > STALLED * before
        self.iterations = made
        return u

    def _step(self, matrix: SaddlePoint, force: FloatArray, tolerance: float) -> tuple[FloatArray, int]:
        """Displacements (n,) under forces (n,), and iterations made."""
        is_new = self._cycle is None
        if self._cycle is None:
            self._cycle = MultigridCycle(matrix.matrices, self._space, self._elements, self._coarse)
        cycle = self._cycle
        right = np.concatenate((force, np.zeros(matrix.size - matrix.count)))
        x, made, left = flexible_gmres(
            matrix.times, lambda residual: matrix.preconditioned(cycle, residual), right, tolerance, RESTART
        )
        self._pace = made / max(-np.log10(left), 0.1) if left > 0.0 else 0.0
        if is_new:
            self._new_pace = self._pace
        return x[: matrix.count], made

    def _take_direct(self, reason: str) -> None:
        """A direct solver from now on."""
        if self._assembled is None or self._space.count > MOST_DIRECT:
            raise SingularMatrixError(f"the iterative solver failed: {reason}")
        self._direct = self._make_direct()
        self.remark = f"the iterative solver failed: {reason}; {self._direct.name} took over"
        self._matrix = self._cycle = None
        self._direct.factorise(self._assembled())

    def _given_up(self) -> SymmetricSolver:
        if self._direct is None:
            raise SingularMatrixError("nothing is factorised")
        return self._direct
