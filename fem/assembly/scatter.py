"""From element arrays to the unknowns: numbering, and the sparse pattern, built once where it is asked for.

It is asked for by direct solvers and items; an iterative one does without, and without its memory.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.assembly.element_geometry import packed_positions

FIXED = -1
Index: TypeAlias = NDArray[np.int32]  # half the memory of the pattern's large arrays


@dataclass(frozen=True)
class Numbering:
    """Which unknown each nodal displacement is.

    Attributes
    ----------
    unknown
        Unknown of (component, node), (2, N) or (3, N); -1 where the displacement is zero.
    count
        Number of unknowns n.
    prescribed
        Displacements (2, N) in m on top of those of the unknowns, or None for none.
    """

    unknown: IntArray
    count: int
    prescribed: FloatArray | None = None

    def expand(self, y: FloatArray) -> FloatArray:
        """Nodal displacements (..., 2, N) in m of the unknowns (..., n)."""
        out: FloatArray = np.concatenate((y, np.zeros((*y.shape[:-1], 1))), axis=-1)[..., self.unknown]
        return out if self.prescribed is None else out + self.prescribed

    def reduce(self, nodal: FloatArray) -> FloatArray:
        """Forces on the unknowns (n,) of nodal forces (2, N)."""
        total: FloatArray = np.zeros(self.count + 1)
        np.add.at(total, self.unknown.ravel(), nodal.ravel())
        return total[:-1]


def number_unknowns(fixed: BoolArray, tied: BoolArray, level: Iterable[tuple[IntArray, IntArray]] = ()) -> Numbering:
    """Number what is neither fixed (2, N) nor the same as another.

    Parameters
    ----------
    fixed
        Displacements that are zero, (2, N) or (3, N), the vertical one last.
    tied
        Nodes (N,) that share one vertical displacement.
    level
        Rows of nodes (m,), not tied, whose vertical displacements are those of other rows (m,).
    """
    representative = np.arange(fixed.size).reshape(fixed.shape)
    if tied.any():
        representative[-1, tied] = representative[-1, tied].min()
    for row, other in level:
        representative[-1, row] = representative[-1, other]
    free = np.unique(representative[~fixed])
    unknown = np.searchsorted(free, representative)
    unknown[fixed] = FIXED
    return Numbering(unknown, len(free))


@dataclass(frozen=True)
class Pattern:
    """The sparse upper triangle.

    Attributes
    ----------
    matrix_sum
        Sparse (nnz, 171 E): packed element stiffness to the entries of the upper triangle.
    indptr, indices
        Pattern of the upper triangle in compressed rows, diagonal first in each row.
    """

    matrix_sum: sp.csr_array
    indptr: IntArray
    indices: IntArray


@dataclass(frozen=True)
class Scatter:
    """Sums element arrays into the unknowns.

    Attributes
    ----------
    element_unknowns
        Unknowns of each element (18, E), radial ones first; fixed ones are n.
    vector_sum
        Sparse (n, 18 E): element forces to forces on the unknowns.
    components
        Displacement components.
    wide
        Pattern with more entries than those of the elements, or None.
    """

    element_unknowns: IntArray
    vector_sum: sp.csr_array
    components: int
    wide: Pattern | None = None

    @cached_property
    def pattern(self) -> Pattern:
        """Pattern of the elements' upper triangle, or the wider one."""
        return _pattern(self) if self.wide is None else self.wide

    @property
    def matrix_sum(self) -> sp.csr_array:
        """See :class:`Pattern`."""
        return self.pattern.matrix_sum

    @property
    def indptr(self) -> IntArray:
        """See :class:`Pattern`."""
        return self.pattern.indptr

    @property
    def indices(self) -> IntArray:
        """See :class:`Pattern`."""
        return self.pattern.indices

    def gather(self, y: FloatArray) -> FloatArray:
        """Element values (18, E) of the unknowns (n,)."""
        out: FloatArray = np.append(y, 0.0)[self.element_unknowns]
        return out

    def vector(self, element: FloatArray) -> FloatArray:
        """Forces (n,) of element forces (18, E)."""
        out: FloatArray = self.vector_sum @ element.ravel()
        return out

    def round_off(self, tangent: FloatArray, y: FloatArray) -> float:
        """Norm of the forces that round-off leaves unbalanced: eps |A| |y| of entries (nnz,), unknowns (n,)."""
        n = len(y)
        upper = sp.csr_array((np.abs(tangent), self.indices, self.indptr), shape=(n, n))
        size = np.abs(y)
        bound = upper @ size + upper.T @ size - upper.diagonal() * size
        return float(np.finfo(np.float64).eps * np.linalg.norm(bound))

    def matrix(self, packed: FloatArray) -> FloatArray:
        """Entries (nnz,) of the upper triangle from packed element stiffness (171, E)."""
        out: FloatArray = self.matrix_sum @ packed.ravel()
        return out


def build_scatter(elements: IntArray, numbering: Numbering) -> Scatter:
    """Scatter of elements (nodes, E) with a numbering."""
    n = numbering.count
    unknowns = np.concatenate([unknown[elements] for unknown in numbering.unknown])
    flat = np.flatnonzero(unknowns.ravel() >= 0)
    vector_sum = sp.csr_array((np.ones(flat.size), (unknowns.ravel()[flat], flat)), shape=(n, unknowns.size))
    return Scatter(np.where(unknowns < 0, n, unknowns), vector_sum, len(numbering.unknown))


def _pattern(scatter: Scatter) -> Pattern:
    """Pattern of the elements."""
    n = scatter.vector_sum.shape[0]
    unknowns = np.where(scatter.element_unknowns == n, FIXED, scatter.element_unknowns).astype(np.int32)
    local_row, local_column = packed_positions(len(unknowns) // scatter.components, scatter.components)
    row, column = unknowns[local_row].ravel(), unknowns[local_column].ravel()
    low, high = np.minimum(row, column), np.maximum(row, column)
    # An off-diagonal packed entry stands for itself and its mirror: both land on the diagonal of a tied unknown.
    twice = (low == high) & np.repeat(local_row != local_column, unknowns.shape[1])
    order = np.flatnonzero(low >= 0).astype(np.int32)
    order = _stable_order(low, n, _stable_order(high, n, order))
    row, column = low[order], high[order]
    new = np.flatnonzero(np.concatenate(([True], (row[1:] != row[:-1]) | (column[1:] != column[:-1]))))
    weight = 1.0 + twice[order]
    matrix_sum = sp.csr_array((weight, order, np.append(new, len(order)).astype(np.int32)), shape=(len(new), low.size))
    first_row, indices = row[new].astype(np.int64), column[new].astype(np.int64)
    return Pattern(matrix_sum, np.searchsorted(first_row, np.arange(n + 1)), indices)


def _stable_order(key: Index, count: int, order: Index) -> Index:
    """`order` (m,) sorted by key[order] in 0..count - 1, stable: a counting sort, as SciPy does it to transpose."""
    ends = np.array([0, len(order)], dtype=order.dtype)
    row = sp.csr_array((order, key[order], ends), shape=(1, count))
    out: Index = row.tocsc().data
    return out


def widened(scatter: Scatter, count: int, rows: IntArray, columns: IntArray) -> tuple[Scatter, IntArray]:
    """A scatter whose pattern has more entries.

    Parameters
    ----------
    scatter
        Sums of the elements.
    count
        Number of unknowns.
    rows, columns
        Entries (k,) that are needed, each in any order and as often as wanted; every row must have its diagonal.

    Returns
    -------
    tuple
        The scatter, and the place (k,) of each entry among the entries of the upper triangle.
    """
    low, high = np.minimum(rows, columns), np.maximum(rows, columns)
    old = np.repeat(np.arange(count), np.diff(scatter.indptr)) * count + scatter.indices
    keys, place = np.unique(np.concatenate((old, low * count + high)), return_inverse=True)
    kept, added = place[: len(old)], place[len(old) :]
    lengths = np.zeros(len(keys), dtype=np.int64)
    lengths[kept] = np.diff(scatter.matrix_sum.indptr)
    matrix = sp.csr_array(
        (
            scatter.matrix_sum.data,
            scatter.matrix_sum.indices,
            np.concatenate(([0], np.cumsum(lengths))).astype(scatter.matrix_sum.indptr.dtype),
        ),
        shape=(len(keys), scatter.matrix_sum.shape[1]),
    )
    indptr = np.searchsorted(keys // count, np.arange(count + 1))
    return replace(scatter, wide=Pattern(matrix, indptr, keys % count)), added
