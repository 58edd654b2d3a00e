"""From element arrays to the unknowns: numbering, and the sparse pattern, built once where it is asked for.

It is asked for by direct solvers and items; an iterative one does without, and without its memory. In shapes an element
has k displacements, its nodes times the components (18 in axial symmetry).
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
PLACED_AT_ONCE = 512  # elements whose places are found together, so that what is made of them stays in the cache
ROWS_AT_ONCE = 16_384  # of the tangent, whose sizes are taken together: all at once would be as much memory again
Index: TypeAlias = NDArray[np.int32]  # half the memory of the pattern's large arrays


@dataclass(frozen=True)
class Numbering:
    """Which unknown each nodal displacement is.

    Attributes
    ----------
    unknown
        Unknown of (component, node), (components, N); -1 where the displacement is zero.
    count
        Number of unknowns n.
    prescribed
        Displacements (components, N) in m on top of those of the unknowns, or None for none.
    """

    unknown: IntArray
    count: int
    prescribed: FloatArray | None = None

    def expand(self, y: FloatArray) -> FloatArray:
        """Nodal displacements (..., components, N) in m of the unknowns (..., n)."""
        out: FloatArray = np.concatenate((y, np.zeros((*y.shape[:-1], 1))), axis=-1)[..., self.unknown]
        return out if self.prescribed is None else out + self.prescribed

    def reduce(self, nodal: FloatArray) -> FloatArray:
        """Forces on the unknowns (n,) of nodal forces (components, N)."""
        total: FloatArray = np.zeros(self.count + 1)
        np.add.at(total, self.unknown.ravel(), nodal.ravel())
        return total[:-1]


def number_unknowns(fixed: BoolArray, tied: BoolArray, level: Iterable[tuple[IntArray, IntArray]] = ()) -> Numbering:
    """Number node by node what is neither fixed (components, N) nor the same as another.

    Parameters
    ----------
    fixed
        Displacements that are zero, (components, N), the vertical one last.
    tied
        Nodes (N,) that share one vertical displacement.
    level
        Rows of nodes (m,), not tied, whose vertical displacements are those of other rows (m,).
    """
    representative = np.arange(fixed.size).reshape(fixed.shape[::-1]).T
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
    """The sparse upper triangle, and where the elements' entries are in it.

    Attributes
    ----------
    place
        Entry (k (k + 1) / 2, E) of each entry of a packed element stiffness; nnz for what is fixed.
    twice
        Whether each of these entries stands for two, for itself and for its mirror; None where none does.
    indptr, indices
        Pattern of the upper triangle in compressed rows, diagonal first in each row.
    """

    place: Index
    twice: BoolArray | None
    indptr: Index
    indices: Index

    def sum(self, parts: Iterable[tuple[slice, FloatArray]]) -> FloatArray:
        """Entries (nnz,) of the upper triangle from packed element stiffness (k (k + 1) / 2, part), part by part."""
        out = np.zeros(len(self.indices) + 1)
        for part, packed in parts:
            place = self.place[:, part]
            np.add.at(out, place.ravel(), packed.ravel())
            if self.twice is not None:
                is_twice = self.twice[:, part]
                np.add.at(out, place[is_twice], packed[is_twice])
        return out[:-1]


@dataclass(frozen=True)
class Scatter:
    """Sums element arrays into the unknowns.

    Attributes
    ----------
    element_unknowns
        Unknowns of each element (k, E), component by component; fixed ones are n.
    vector_sum
        Sparse (n, k E): element forces to forces on the unknowns.
    elements, numbering
        Nodes (nodes, E) of the elements, and which unknowns they have.
    wide
        Pattern with more entries than those of the elements, or None.
    """

    element_unknowns: IntArray
    vector_sum: sp.csr_array
    elements: IntArray
    numbering: Numbering
    wide: Pattern | None = None

    @cached_property
    def pattern(self) -> Pattern:
        """Pattern of the elements' upper triangle, or the wider one."""
        return _pattern(self) if self.wide is None else self.wide

    @property
    def indptr(self) -> Index:
        """See :class:`Pattern`."""
        return self.pattern.indptr

    @property
    def indices(self) -> Index:
        """See :class:`Pattern`."""
        return self.pattern.indices

    def gather(self, y: FloatArray) -> FloatArray:
        """Element values (k, E) of the unknowns (n,)."""
        out: FloatArray = np.append(y, 0.0)[self.element_unknowns]
        return out

    def vector(self, element: FloatArray) -> FloatArray:
        """Forces (n,) of element forces (k, E)."""
        out: FloatArray = self.vector_sum @ element.ravel()
        return out

    def round_off(self, tangent: FloatArray, y: FloatArray) -> float:
        """Norm of the forces that round-off leaves unbalanced: eps |A| |y| of entries (nnz,), unknowns (n,)."""
        n, size = len(y), np.abs(y)
        bound: FloatArray = -np.abs(tangent[self.indptr[:-1]]) * size
        for start in range(0, n, ROWS_AT_ONCE):
            rows, ends = slice(start, start + ROWS_AT_ONCE), self.indptr[start : start + ROWS_AT_ONCE + 1]
            part = slice(ends[0], ends[-1])
            entries = np.abs(tangent[part]), self.indices[part], ends - ends[0]
            upper = sp.csr_array(entries, shape=(len(ends) - 1, n))
            bound[rows] += upper @ size
            bound += upper.T @ size[rows]
        return float(np.finfo(np.float64).eps * np.linalg.norm(bound))

    def matrix(self, packed: FloatArray) -> FloatArray:
        """Entries (nnz,) of the upper triangle from packed element stiffness (k (k + 1) / 2, E)."""
        return self.pattern.sum([(slice(None), packed)])

    def matrix_of_parts(self, parts: Iterable[tuple[slice, FloatArray]]) -> FloatArray:
        """The same of elements and their packed stiffness (k (k + 1) / 2, part), part by part."""
        return self.pattern.sum(parts)


def build_scatter(elements: IntArray, numbering: Numbering) -> Scatter:
    """Scatter of elements (nodes, E) with a numbering."""
    n = numbering.count
    unknowns = np.concatenate([unknown[elements] for unknown in numbering.unknown])
    flat = np.flatnonzero(unknowns.ravel() >= 0)
    vector_sum = sp.csr_array((np.ones(flat.size), (unknowns.ravel()[flat], flat)), shape=(n, unknowns.size))
    return Scatter(np.where(unknowns < 0, n, unknowns), vector_sum, elements, numbering)


def _pattern(scatter: Scatter) -> Pattern:
    """Pattern of the elements, from that of their nodes."""
    unknown, count = scatter.numbering.unknown, scatter.numbering.count
    pairs = _node_pairs(scatter.elements, unknown.shape[1])
    table, indptr, indices = _node_blocks(pairs, unknown >= 0)
    is_free = unknown.T >= 0
    real = unknown.T[is_free]
    is_plain = np.array_equal(real, np.arange(count))
    if not is_plain:
        table, indptr, indices = _merged(real, count, table, indptr, indices)
    place = _packed_places(scatter.elements, pairs.number, table)
    twice = None
    if not is_plain or pairs.has_folded:
        # An off-diagonal packed entry stands for itself and its mirror: both land on the diagonal of a tied unknown.
        row, column = packed_positions(len(scatter.elements), len(unknown))
        is_diagonal = np.zeros(len(indices) + 1, dtype=np.bool_)
        is_diagonal[indptr[:-1]] = np.diff(indptr) > 0
        is_diagonal[-1] = False
        twice = is_diagonal[place] & (row != column)[:, None]
    return Pattern(place, twice, indptr, indices)


@dataclass(frozen=True)
class NodePairs:
    """Pairs of nodes that share an element, the lower node first, sorted.

    Attributes
    ----------
    low, high
        The nodes (p,) of each pair.
    number
        Pair of each two of the m local nodes of each element, (m (m + 1) / 2, E), in the order of `numpy.triu_indices`.
    has_folded
        Whether an element has a node twice.
    """

    low: Index
    high: Index
    number: Index
    has_folded: bool


def _node_pairs(elements: IntArray, count: int) -> NodePairs:
    first, second = np.triu_indices(len(elements))
    nodes = elements.astype(np.int32)
    low, high = np.minimum(nodes[first], nodes[second]), np.maximum(nodes[first], nodes[second])
    has_folded = bool((low == high)[first != second].any())
    low, high = low.ravel(), high.ravel()
    number, new = _numbered(low, high, count)
    return NodePairs(low[new], high[new], number.reshape(len(first), -1), has_folded)


def _numbered(low: Index, high: Index, count: int) -> tuple[Index, Index]:
    """Number (m,) of each pair among the different ones, sorted by low and then high; and where (p,) each is found."""
    order = np.arange(len(low), dtype=np.int32)
    order = _stable_order(low, count, _stable_order(high, count, order))
    row, column = low[order], high[order]
    is_new = np.concatenate(([True], (row[1:] != row[:-1]) | (column[1:] != column[:-1])))
    number = np.empty_like(order)
    number[order] = np.cumsum(is_new, dtype=np.int32) - np.int32(1)
    return number, order[is_new]


def _node_blocks(pairs: NodePairs, is_free: BoolArray) -> tuple[Index, Index, Index]:
    """Upper triangle of one unknown for each free displacement (dim, N), numbered node by node.

    Returns
    -------
    tuple of ndarray
        Places (dim, dim, p) of the components of the lower node with those of the higher one, nnz where one is
        fixed; indptr and indices.
    """
    low, high = pairs.low, pairs.high
    width = is_free.sum(axis=0, dtype=np.int32)
    before = np.cumsum(is_free, axis=0, dtype=np.int32) - is_free
    ends = np.concatenate(([0], np.cumsum(width[high], dtype=np.int32)))
    first = np.searchsorted(low, np.arange(len(width) + 1))
    lengths = np.maximum(np.diff(ends[first]) - before, 0).T[is_free.T]  # 0 where no element has the node
    indptr = np.concatenate(([0], np.cumsum(lengths, dtype=np.int32)))
    start, name = np.zeros((2, *is_free.shape), dtype=np.int32)
    start.T[is_free.T], name.T[is_free.T] = indptr[:-1], np.arange(len(lengths))
    head = start - before - ends[first[:-1]]
    table = np.empty((len(is_free), len(is_free), len(low)), dtype=np.int32)
    indices = np.empty(indptr[-1], dtype=np.int32)
    for a, b in np.ndindex(table.shape[:2]):
        place = head[a, low] + ends[:-1] + before[b, high]
        is_used = is_free[a, low] & is_free[b, high]
        if a > b:
            is_used &= low != high
        indices[place[is_used]] = name[b, high[is_used]]
        table[a, b] = np.where(is_used, place, indptr[-1])
    return table, indptr, indices


def _merged(real: IntArray, count: int, table: Index, indptr: Index, indices: Index) -> tuple[Index, Index, Index]:
    """The same with the unknowns (m,) that displacements really are, fewer or numbered otherwise."""
    kind = real.astype(np.int32)
    row, column = np.repeat(kind, np.diff(indptr)), kind[indices]
    low, high = np.minimum(row, column), np.maximum(row, column)
    number, new = _numbered(low, high, count)
    starts = np.searchsorted(low[new], np.arange(count + 1, dtype=np.int32)).astype(np.int32)
    return np.append(number, np.int32(len(new)))[table], starts, high[new]


def _packed_places(elements: IntArray, number: Index, table: Index) -> Index:
    """Place (entries, E) of each entry of the packed element stiffness."""
    k, dim = len(elements), len(table)
    pair = np.zeros((k, k), dtype=np.int64)
    first, second = np.triu_indices(k)
    pair[first, second] = pair[second, first] = np.arange(len(first))
    out = np.empty((len(packed_positions(k, dim)[0]), elements.shape[1]), dtype=np.int32)
    for begin in range(0, elements.shape[1], PLACED_AT_ONCE):
        part = slice(begin, begin + PLACED_AT_ONCE)
        of_upper, nodes = number[:, part], elements[:, part]
        of_all = number[pair.ravel(), part]
        is_turned = (nodes[:, None] > nodes).reshape(k * k, -1)
        end = 0
        for a in range(dim):
            for b in range(a, dim):
                start, end = end, end + (len(number) if a == b else k * k)
                if a == b:
                    out[start:end, part] = table[a, a][of_upper]
                else:
                    out[start:end, part] = np.where(is_turned, table[b, a][of_all], table[a, b][of_all])
    return out


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
    old = np.repeat(np.arange(count, dtype=np.int64), np.diff(scatter.indptr)) * count + scatter.indices
    keys, place = np.unique(np.concatenate((old, low * count + high)), return_inverse=True)
    kept, added = place[: len(old)], place[len(old) :]
    moved = np.append(kept, len(keys)).astype(np.int32)
    indptr = np.searchsorted(keys // count, np.arange(count + 1)).astype(np.int32)
    pattern = scatter.pattern
    wide = Pattern(moved[pattern.place], pattern.twice, indptr, (keys % count).astype(np.int32))
    return replace(scatter, wide=wide), added
