"""From element arrays to the unknowns: numbering, and the sparse pattern built once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.assembly.shapes import COLUMNS, NODES, ROWS

FIXED = -1


@dataclass(frozen=True)
class Numbering:
    """Which unknown each nodal displacement is.

    Attributes
    ----------
    unknown
        Unknown of (component, node), (2, N); -1 where the displacement is zero.
    count
        Number of unknowns n.
    """

    unknown: IntArray
    count: int

    def expand(self, y: FloatArray) -> FloatArray:
        """Nodal displacements (2, N) in m of the unknowns (n,)."""
        out: FloatArray = np.append(y, 0.0)[self.unknown]
        return out

    def reduce(self, nodal: FloatArray) -> FloatArray:
        """Forces on the unknowns (n,) of nodal forces (2, N)."""
        total: FloatArray = np.zeros(self.count + 1)
        np.add.at(total, self.unknown.ravel(), nodal.ravel())
        return total[:-1]


def number_unknowns(fixed: BoolArray, tied: BoolArray) -> Numbering:
    """Number what is neither fixed (2, N) nor the same as another.

    Parameters
    ----------
    fixed
        Displacements that are zero, (2, N): radial, vertical.
    tied
        Nodes (N,) that share one vertical displacement.
    """
    representative = np.arange(fixed.size).reshape(fixed.shape)
    if tied.any():
        representative[1, tied] = representative[1, tied].min()
    free = np.unique(representative[~fixed])
    unknown = np.searchsorted(free, representative)
    unknown[fixed] = FIXED
    return Numbering(unknown, len(free))


@dataclass(frozen=True)
class Scatter:
    """Sums element arrays into the unknowns.

    Attributes
    ----------
    element_unknowns
        Unknowns of each element (18, E), radial ones first; fixed ones are n.
    matrix_sum
        Sparse (nnz, 171 E): packed element stiffness to the entries of the upper triangle.
    vector_sum
        Sparse (n, 18 E): element forces to forces on the unknowns.
    indptr, indices
        Pattern of the upper triangle in compressed rows, diagonal first in each row.
    """

    element_unknowns: IntArray
    matrix_sum: sp.csr_array
    vector_sum: sp.csr_array
    indptr: IntArray
    indices: IntArray

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


def packed_positions() -> tuple[IntArray, IntArray]:
    """Local row and column (171,) of each packed entry: rr upper, rz full, zz upper."""
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(NODES), np.arange(NODES), indexing="ij"))
    row = np.concatenate((ROWS, i, ROWS + NODES))
    column = np.concatenate((COLUMNS, j + NODES, COLUMNS + NODES))
    return row, column


def build_scatter(elements: IntArray, numbering: Numbering) -> Scatter:
    """Scatter of elements (9, E) with a numbering."""
    n = numbering.count
    unknowns = np.concatenate([numbering.unknown[c][elements] for c in range(2)])
    local_row, local_column = packed_positions()
    row, column = unknowns[local_row].ravel(), unknowns[local_column].ravel()
    # An off-diagonal packed entry stands for itself and its mirror: both land on the diagonal of a tied unknown.
    twice = np.repeat(local_row != local_column, elements.shape[1]) & (row == column)
    kept = np.flatnonzero((row >= 0) & (column >= 0))
    key = np.minimum(row, column)[kept] * n + np.maximum(row, column)[kept]
    entries, position = np.unique(key, return_inverse=True)
    weight = np.where(twice[kept], 2.0, 1.0)
    matrix_sum = sp.csr_array((weight, (position, kept)), shape=(len(entries), row.size))
    flat = np.flatnonzero(unknowns.ravel() >= 0)
    vector_sum = sp.csr_array((np.ones(flat.size), (unknowns.ravel()[flat], flat)), shape=(n, unknowns.size))
    indptr = np.searchsorted(entries // n, np.arange(n + 1))
    return Scatter(np.where(unknowns < 0, n, unknowns), matrix_sum, vector_sum, indptr, entries % n)
