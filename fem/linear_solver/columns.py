"""Columns of nodes through the thickness, solved exactly: block tridiagonal in their levels, all columns at once.

A node shares elements with those that are few levels above and below it. Unknowns of so many levels make one block,
and blocks are eliminated from the first to the last (G. H. Golub and C. F. Van Loan, Matrix Computations, 4th edition,
section 4.5.1). Memory and time grow with the height of a column, where its inverse grows with the square.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from fem.arrays import FloatArray, IntArray
from fem.linear_solver.symmetric import SingularMatrixError

ELEMENTS_AT_ONCE = 2048  # whose pairs of unknowns in one column are found together
Single: TypeAlias = NDArray[np.float32]


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


class Columns:
    """Solves the equations of each column with all other unknowns held.

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
        block, below = _blocks(matrices, unknowns, places)
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


def _blocks(matrices: FloatArray, unknowns: IntArray, places: ColumnPlaces) -> tuple[FloatArray, FloatArray]:
    """Blocks (blocks, columns, reach, reach) on the diagonal, and left of it; 1 on the diagonal at empty places."""
    count, reach, columns = places.shape
    both = np.zeros((2, count, columns, reach, reach))
    column, slot = np.append(places.column, -1), np.append(places.slot, 0)
    for start in range(0, len(matrices), ELEMENTS_AT_ONCE):
        u = unknowns[:, start : start + ELEMENTS_AT_ONCE].T
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
