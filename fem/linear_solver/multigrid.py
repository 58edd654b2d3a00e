"""One multigrid cycle on quadratic elements: column smoothing, and the linear elements of the same mesh below.

The matrix is kept as the elements' own matrices and never assembled. Layers are thin and their elements flat, so that
nodes are bound far more strongly to those above and below than to those beside: the smoother inverts whole columns of
nodes through the thickness, and Chebyshev polynomials damp what is left (M. Adams and others, Parallel multigrid
smoothing: polynomial versus Gauss-Seidel, Journal of Computational Physics 188 (2003) 593). What is smooth is
corrected on linear elements (p-multigrid; J. J. Heys and others, Algebraic multigrid for higher-order finite elements,
Journal of Computational Physics 204 (2005) 520), which a direct solver solves. All but that is in single precision,
since it serves as a preconditioner.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fem.arrays import FloatArray, IndexArray, IntArray
from fem.linear_solver.symmetric import SingularMatrixError, SymmetricSolver

DEGREE = 3  # of the Chebyshev polynomial; 2 and 4 take 5 to 10 % more products with the matrix
DAMPED = 25.0  # largest eigenvalue over the smallest that the polynomial damps
POWER_STEPS = 20
MARGIN = 1.1  # on the largest eigenvalue, which the power iteration finds from below
AT_ONCE = 256  # elements or columns of which copies in double precision are made at a time
Single: TypeAlias = NDArray[np.float32]
Array = TypeVar("Array", FloatArray, Single)


@dataclass(frozen=True)
class CoarseSpace:
    """The linear elements below quadratic ones, and the columns of unknowns that are smoothed together.

    Attributes
    ----------
    unknowns
        Unknowns of each quadratic element (k, E), component by component; fixed ones are n.
    column
        Column (n,) of each unknown, numbered from 0.
    element_transfer
        Displacements of a quadratic element from those of the linear one, (k, c).
    transfer
        Sparse (n, m): unknowns from those of the linear elements.
    packed
        Row and column (entries,) of each packed entry of a linear element's matrix.
    matrix_sum
        Entries (nnz,) of the upper triangle from packed linear elements (entries, E).
    indptr, indices
        Pattern of the linear elements' upper triangle in compressed rows, diagonal first in each row.
    """

    unknowns: IntArray
    column: IntArray
    element_transfer: FloatArray
    transfer: sp.csr_array
    packed: tuple[IntArray, IntArray]
    matrix_sum: Callable[[FloatArray], FloatArray]
    indptr: IndexArray
    indices: IndexArray

    @property
    def count(self) -> int:
        """Number of unknowns n."""
        return len(self.column)

    def coarse_entries(self, matrices: FloatArray) -> FloatArray:
        """Entries (nnz,) of the linear elements' upper triangle, T^T K T of element matrices (E, k, k)."""
        rows, columns = self.packed
        packed = np.empty((len(rows), len(matrices)))
        for part in parts(len(matrices)):
            small = self.element_transfer.T @ matrices[part] @ self.element_transfer
            packed[:, part] = small[:, rows, columns].T
        return self.matrix_sum(packed)


class ElementSum:
    """Products with a matrix that is a sum over elements.

    Parameters
    ----------
    unknowns
        Unknowns of each element (k, E); fixed ones are n.
    count
        Number of unknowns n.
    """

    def __init__(self, unknowns: IntArray, count: int) -> None:
        self._gathered = np.ascontiguousarray(unknowns.T)
        self._count = count
        flat = self._gathered.ravel()
        ends = np.arange(flat.size + 1)
        self._sums = sp.csc_array((np.ones(flat.size, np.float32), flat, ends), shape=(count + 1, flat.size)).tocsr()

    def gather(self, x: Array) -> Array:
        """Values (E, k) on the elements of unknowns (n,)."""
        out: Array = np.append(x, x.dtype.type(0.0))[self._gathered]
        return out

    def scatter(self, element: Array) -> Array:
        """Sums (n,) of values (E, k)."""
        out: Array = (self._sums @ element.ravel())[: self._count]
        return out

    def product(self, matrices: Array, x: Array) -> Array:
        """Sum (n,) of element matrices (E, k, k) times unknowns (n,)."""
        return self.scatter(np.einsum("eij,ej->ei", matrices, self.gather(x)))


class ColumnInverses:
    """Inverses of the blocks of all columns.

    Parameters
    ----------
    matrices
        Element matrices (E, k, k).
    unknowns
        Unknowns of each element (k, E); fixed ones are n.
    column
        Column (n,) of each unknown.

    Raises
    ------
    SingularMatrixError
        If a block has no inverse.
    """

    def __init__(self, matrices: FloatArray, unknowns: IntArray, column: IntArray) -> None:
        sizes = np.bincount(column)
        order = np.argsort(column, kind="stable")
        within = np.empty(len(column), dtype=np.int64)
        within[order] = np.arange(len(column)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
        self._shape, width = (len(sizes), int(sizes.max())), int(sizes.max())
        self._slot = column * width + within
        blocks = self._blocks(matrices, unknowns, np.append(column, -1), np.append(within, 0))
        empty, place = np.nonzero(np.arange(width) >= sizes[:, None])
        blocks[empty, place, place] = 1.0
        try:
            for part in parts(len(blocks)):
                blocks[part] = np.linalg.inv(blocks[part].astype(np.float64))
        except np.linalg.LinAlgError as error:
            raise SingularMatrixError(f"a column of nodes: {error}") from error
        self._inverses = blocks

    def _blocks(self, matrices: FloatArray, unknowns: IntArray, column: IntArray, within: IntArray) -> Single:
        width = self._shape[1]
        blocks = np.zeros((*self._shape, width), dtype=np.float32)
        flat = blocks.reshape(-1)
        for part in parts(len(matrices), 8 * AT_ONCE):
            u = unknowns[:, part].T
            c = column[u]
            e, i, j = np.nonzero((c[:, :, None] == c[:, None, :]) & (c >= 0)[:, :, None])
            place = (c[e, i] * width + within[u[e, i]]) * width + within[u[e, j]]
            np.add.at(flat, place, matrices[part][e, i, j].astype(np.float32))
        return blocks

    def __call__(self, residual: Single) -> Single:
        """Corrections (n,) of residuals (n,)."""
        padded = np.zeros(self._shape[0] * self._shape[1], dtype=np.float32)
        padded[self._slot] = residual
        out: Single = np.einsum("cij,cj->ci", self._inverses, padded.reshape(self._shape)).ravel()[self._slot]
        return out


class MultigridCycle:
    """Approximate inverse of a sum over elements.

    Parameters
    ----------
    matrices
        Element matrices (E, k, k) in N/m.
    space
        Linear elements and columns.
    coarse
        Direct solver of the linear elements' pattern.

    Raises
    ------
    SingularMatrixError
        If a column or the linear elements have no inverse.
    """

    def __init__(self, matrices: FloatArray, space: CoarseSpace, coarse: SymmetricSolver) -> None:
        self._sum = ElementSum(space.unknowns, space.count)
        self._matrices = matrices.astype(np.float32)
        self._columns = ColumnInverses(matrices, space.unknowns, space.column)
        self._up = space.transfer.astype(np.float32)
        self._down = self._up.T.tocsr()
        self._coarse = coarse
        coarse.factorise(space.coarse_entries(matrices))
        self._largest = self._largest_eigenvalue(space.count)

    def __call__(self, force: FloatArray) -> FloatArray:
        """Displacements (n,) that forces (n,) cause, approximately; a symmetric linear map."""
        size = float(np.abs(force).max()) or 1.0
        residual: Single = (force / size).astype(np.float32)
        x, residual = self._smoothed(np.zeros_like(residual), residual)
        lifted = self._up @ self._coarse.solve((self._down @ residual).astype(np.float64)[:, None])[:, 0]
        correction: Single = lifted.astype(np.float32)
        x, _ = self._smoothed(x + correction, residual - self._times(correction), last=True)
        out: FloatArray = size * x.astype(np.float64)
        return out

    def _smoothed(self, x: Single, residual: Single, last: bool = False) -> tuple[Single, Single]:
        """Solution and residual after the Chebyshev polynomial (Y. Saad, Iterative Methods, 2003, algorithm 12.1)."""
        middle, half = (0.5 * self._largest * (1.0 + sign / DAMPED) for sign in (1.0, -1.0))
        ratio = middle / half
        rho = 1.0 / ratio
        step: Single = self._columns(residual) / np.float32(middle)
        for degree in range(1, DEGREE + 1):
            x = x + step
            if degree == DEGREE and last:
                break
            residual = residual - self._times(step)
            if degree < DEGREE:
                following = 1.0 / (2.0 * ratio - rho)
                ahead = np.float32(2.0 * following / half)
                step = np.float32(following * rho) * step + ahead * self._columns(residual)
                rho = following
        return x, residual

    def _times(self, x: Single) -> Single:
        out: Single = self._sum.product(self._matrices, x).astype(np.float32, copy=False)
        return out

    def _largest_eigenvalue(self, count: int) -> float:
        """Of the matrix smoothed once, by the power iteration."""
        x, size = np.random.default_rng(1).normal(size=count).astype(np.float32), 1.0
        for _ in range(POWER_STEPS):
            x = self._columns(self._times(x / np.float32(size)))
            size = float(np.linalg.norm(x))
        if not np.isfinite(size) or size == 0.0:
            raise SingularMatrixError("the columns of nodes do not bound the stiffness matrix")
        return MARGIN * size


def parts(count: int, size: int = AT_ONCE) -> list[slice]:
    """Slices of at most `size` that cover 0 to count."""
    return [slice(start, min(start + size, count)) for start in range(0, count, size)]
