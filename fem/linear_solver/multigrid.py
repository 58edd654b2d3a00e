"""One multigrid cycle on quadratic elements: column smoothing, and the linear elements of the same mesh below.

The matrix is kept as the elements' own matrices and never assembled. Layers are thin and their elements flat, so that
nodes are bound far more strongly to those above and below than to those beside: the smoother solves whole columns of
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
from fem.threads import do_in_threads, in_parts

DEGREE = 3  # of the Chebyshev polynomial; 2 and 4 take 5 to 10 % more products with the matrix
DAMPED = 25.0  # largest eigenvalue over the smallest that the polynomial damps
POWER_STEPS = 20
BELOW = 1e-3  # of the linear elements' forces that their solution may leave
MARGIN = 1.1  # on the largest eigenvalue, which the power iteration finds from below
PARTS = 8  # of a product, so that a thread beside a busy program is not waited for
AT_ONCE = 256  # elements of which copies in double precision are made at a time
PAIRED_AT_ONCE = 2048  # elements whose pairs of unknowns in one column are found together
Single: TypeAlias = NDArray[np.float32]
Array = TypeVar("Array", FloatArray, Single)


@dataclass(frozen=True)
class ColumnPlaces:
    """Where the unknowns are in columns.

    Attributes
    ----------
    column
        Column (n,) of each unknown, numbered from 0.
    slot
        Place (n,) of each unknown in its column, from one end to the other; places may be empty.
    reach
        Slots in a block: those of unknowns of one element and column lie in the same block or in neighbours.
    """

    column: IntArray
    slot: IntArray
    reach: int

    @property
    def shape(self) -> tuple[int, int, int]:
        """Blocks, slots in each, columns."""
        return int(self.slot.max()) // self.reach + 1, self.reach, int(self.column.max()) + 1


@dataclass(frozen=True)
class CoarseSpace:
    """The linear elements below quadratic ones, and the columns of unknowns.

    Attributes
    ----------
    unknowns
        Unknowns of each quadratic element (k, E), component by component; fixed ones are n.
    places
        Columns of unknowns that are smoothed together.
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
    places: ColumnPlaces
    element_transfer: FloatArray
    transfer: sp.csr_array
    packed: tuple[IntArray, IntArray]
    matrix_sum: Callable[[FloatArray], FloatArray]
    indptr: IndexArray
    indices: IndexArray

    @property
    def count(self) -> int:
        """Number of unknowns n."""
        return len(self.places.column)

    def coarse_entries(self, matrices: FloatArray) -> FloatArray:
        """Entries (nnz,) of the linear elements' upper triangle, T^T K T of element matrices (E, k, k)."""
        rows, columns = self.packed
        packed = np.empty((len(rows), len(matrices)))
        for part in in_parts(len(matrices), AT_ONCE):
            small = self.element_transfer.T @ matrices[part] @ self.element_transfer
            packed[:, part] = small[:, rows, columns].T
        return self.matrix_sum(packed)


class ElementSum:
    """Products with a matrix that is a sum over elements, on as many threads as there are.

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
        flat = self._gathered.ravel().astype(np.int32)
        ends = np.arange(flat.size + 1, dtype=np.int32)
        sums = sp.csc_array((np.ones(flat.size, np.float32), flat, ends), shape=(count + 1, flat.size)).tocsr()
        self._sums = {dtype: sums.astype(dtype) for dtype in (np.dtype(np.float32), np.dtype(np.float64))}

    def gather(self, x: Array) -> Array:
        """Values (E, k) on the elements of unknowns (n,)."""
        out: Array = np.append(x, x.dtype.type(0.0))[self._gathered]
        return out

    def scatter(self, element: Array) -> Array:
        """Sums (n,) of values (E, k)."""
        out: Array = (self._sums[element.dtype] @ element.ravel())[: self._count]
        return out

    def product(self, matrices: Array, x: Array) -> Array:
        """Sum (n,) of element matrices (E, k, k) times unknowns (n,)."""
        return self.scatter(self.on_elements(matrices, self.gather(x)))

    def on_elements(self, matrices: Array, values: Array) -> Array:
        """Element matrices (E, j, k) times values (E, k) on the elements, (E, j)."""
        out = np.empty(matrices.shape[:2], dtype=matrices.dtype)

        def multiply(part: slice) -> None:
            np.einsum("eij,ej->ei", matrices[part], values[part], out=out[part])

        do_in_threads(multiply, in_parts(len(matrices), max(AT_ONCE, len(matrices) // PARTS)))
        return out


class Columns:
    """Solves the equations of each column with all other unknowns held: block tridiagonal, all columns at once.

    A node shares elements with those that are few levels above and below it. Unknowns of so many levels make one block,
    and blocks are eliminated from the first to the last (G. H. Golub and C. F. Van Loan, Matrix Computations, 4th
    edition, section 4.5.1). Memory and time grow with a column's height, where its inverse grows with the square.

    Parameters
    ----------
    matrices
        Element matrices (E, k, k).
    unknowns
        Unknowns of each element (k, E); fixed ones are n.
    places
        Where the unknowns are.

    Raises
    ------
    SingularMatrixError
        If a column has no solution.
    """

    def __init__(self, matrices: FloatArray, unknowns: IntArray, places: ColumnPlaces) -> None:
        count, reach, columns = places.shape
        self._shape = (count, reach, columns)
        self._place = places.slot * columns + places.column
        block, below = _column_blocks(matrices, unknowns, places)
        self._inverse = np.empty((count, reach, reach, columns), dtype=np.float32)
        self._lower = np.empty((count, reach, reach, columns), dtype=np.float32)  # the first is of no use
        above = np.zeros((columns, reach, reach))
        for k in range(count):
            lower = below[k] @ above
            try:
                above = np.linalg.inv(block[k] - lower @ below[k].transpose(0, 2, 1))
            except np.linalg.LinAlgError as error:
                raise SingularMatrixError(f"a column of nodes: {error}") from error
            self._inverse[k], self._lower[k] = above.transpose(1, 2, 0), lower.transpose(1, 2, 0)

    @property
    def blocks(self) -> int:
        """Blocks of a column."""
        return self._shape[0]

    def __call__(self, residual: Single) -> Single:
        """Corrections (n,) of residuals (n,)."""
        x = np.zeros(self._shape, dtype=np.float32)
        x.reshape(-1)[self._place] = residual
        for k in range(1, len(x)):
            x[k] -= np.einsum("ijc,jc->ic", self._lower[k], x[k - 1])
        for k in range(len(x) - 1, -1, -1):
            x[k] = np.einsum("ijc,jc->ic", self._inverse[k], x[k])
            if k + 1 < len(x):
                x[k] -= np.einsum("jic,jc->ic", self._lower[k + 1], x[k + 1])
        out: Single = x.reshape(-1)[self._place]
        return out


def _column_blocks(matrices: FloatArray, unknowns: IntArray, places: ColumnPlaces) -> tuple[FloatArray, FloatArray]:
    """Blocks (blocks, columns, reach, reach) on the diagonal, and left of it; 1 on the diagonal at empty places."""
    count, reach, columns = places.shape
    both = np.zeros((2, count, columns, reach, reach))
    column, slot = np.append(places.column, -1), np.append(places.slot, 0)
    for start in range(0, len(matrices), PAIRED_AT_ONCE):
        u = unknowns[:, start : start + PAIRED_AT_ONCE].T
        c, s = column[u], slot[u]
        e, i, j = np.nonzero((c[:, :, None] == c[:, None, :]) & (c >= 0)[:, :, None])
        (row, within), (other, beside) = np.divmod(s[e, i], reach), np.divmod(s[e, j], reach)
        used = row >= other
        at = (row - other, row, c[e, i], within, beside)
        np.add.at(both, tuple(index[used] for index in at), matrices[start + e[used], i[used], j[used]])
    is_empty = np.ones((count, reach, columns), dtype=np.bool_)
    is_empty[places.slot // reach, places.slot % reach, places.column] = False
    block, place, of_column = np.nonzero(is_empty)
    both[0, block, of_column, place, place] = 1.0
    return both[0], both[1]


class MultigridCycle:
    """Approximate inverse of a sum over elements.

    Parameters
    ----------
    matrices
        Element matrices (E, k, k) in N/m.
    space
        Linear elements and columns.
    elements
        Sums over the elements.
    coarse
        Direct solver of the linear elements' pattern.

    Raises
    ------
    SingularMatrixError
        If a column or the linear elements have no inverse.
    """

    def __init__(self, matrices: FloatArray, space: CoarseSpace, elements: ElementSum, coarse: SymmetricSolver) -> None:
        self._sum = elements
        self._matrices = matrices.astype(np.float32)
        self._columns = Columns(matrices, space.unknowns, space.places)
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
        below = self._coarse.solve((self._down @ residual).astype(np.float64)[:, None], BELOW)[:, 0]
        correction: Single = self._up @ below.astype(np.float32)
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
        return self._sum.product(self._matrices, x)

    def _largest_eigenvalue(self, count: int) -> float:
        """Of the matrix smoothed once, by the power iteration."""
        x, size = np.random.default_rng(1).normal(size=count).astype(np.float32), 1.0
        for _ in range(POWER_STEPS):
            x = self._columns(self._times(x / np.float32(size)))
            size = float(np.linalg.norm(x))
        if not np.isfinite(size) or size == 0.0:
            raise SingularMatrixError("the columns of nodes do not bound the stiffness matrix")
        return MARGIN * size
