"""Below a mesh of quadratic elements: the linear elements of the same mesh, and its columns of nodes."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.assembly.element_geometry import packed_positions
from fem.assembly.scatter import Numbering, Scatter, build_scatter
from fem.assembly.solid import SOLID_ELEMENTS
from fem.linear_solver.multigrid import CoarseSpace, ColumnPlaces
from fem.mesh.solid import SolidMesh

LINEAR = {"hex27": "hex8", "hex20": "hex8", "tet10": "tet4"}
SAME_PLACE = 1e-9  # distance beside each other of the nodes of one column, over the mesh's width


def coarse_space(mesh: SolidMesh, numbering: Numbering, scatter: Scatter) -> CoarseSpace:
    """Linear elements and columns of a mesh with its unknowns.

    Supports and ties are taken as they are at the corners: they hold whole faces of elements.
    """
    linear = SOLID_ELEMENTS[LINEAR[mesh.element]]
    count = len(linear.node_places)
    values, _ = linear.tabulate(SOLID_ELEMENTS[mesh.element].node_places.T)
    corners = mesh.elements[:count]
    below = _numbering_below(numbering, corners)
    coarse = build_scatter(corners, below)
    return CoarseSpace(
        scatter.element_unknowns,
        _columns(mesh.nodes, numbering, scatter.element_unknowns),
        _each_component(values),
        _transfer(mesh.elements, numbering, below, values),
        packed_positions(count, 3),
        coarse.matrix,
        coarse.indptr,
        coarse.indices,
    )


def _each_component(values: FloatArray) -> FloatArray:
    """Block diagonal (3 k, 3 c) of the same values (k, c)."""
    out = np.zeros((3 * values.shape[0], 3 * values.shape[1]))
    for n in range(3):
        out[n * values.shape[0] : (n + 1) * values.shape[0], n * values.shape[1] : (n + 1) * values.shape[1]] = values
    return out


def _numbering_below(numbering: Numbering, corners: IntArray) -> Numbering:
    """The unknowns of the corners, numbered anew; other nodes have none."""
    is_corner = np.zeros(numbering.unknown.shape[1], dtype=np.bool_)
    is_corner[corners] = True
    kept = np.where(is_corner, numbering.unknown, -1)
    old = np.unique(kept[kept >= 0])
    return Numbering(np.where(kept >= 0, np.searchsorted(old, kept), -1), len(old))


def _transfer(elements: IntArray, numbering: Numbering, below: Numbering, values: FloatArray) -> sp.csr_array:
    """Sparse (n, m) from the shape functions (nodes, c) of the linear element at the nodes of the quadratic one."""
    count = values.shape[1]
    owner, local = np.zeros((2, numbering.unknown.shape[1]), dtype=np.int64)
    for k in range(len(elements) - 1, -1, -1):
        owner[elements[k]], local[elements[k]] = np.arange(elements.shape[1]), k
    is_corner: BoolArray = local < count
    rows, columns, entries = [], [], []
    for unknown, coarse in zip(numbering.unknown, below.unknown, strict=True):
        free = np.flatnonzero(unknown >= 0)
        free = free[np.argsort(~is_corner[free], kind="stable")]
        of_row, first = np.unique(unknown[free], return_index=True)
        node = free[first]
        weight, at = values[local[node]], coarse[elements[:count, owner[node]].T]
        used = (weight != 0.0) & (at >= 0)
        rows.append(np.broadcast_to(of_row[:, None], used.shape)[used])
        columns.append(at[used])
        entries.append(weight[used])
    place = np.concatenate(rows), np.concatenate(columns)
    return sp.csr_array((np.concatenate(entries), place), shape=(numbering.count, below.count))


def _columns(nodes: FloatArray, numbering: Numbering, unknowns: IntArray) -> ColumnPlaces:
    """Places of the unknowns in columns; one that several nodes share is in that of the first of them."""
    grid = np.rint(nodes[:, :2] / (SAME_PLACE * np.ptp(nodes[:, 0]))).astype(np.int64)
    of_node = np.unique(grid, axis=0, return_inverse=True)[1].ravel()
    level = _levels(of_node, nodes[:, 2])
    column, slot = np.zeros((2, numbering.count), dtype=np.int64)
    for component, unknown in enumerate(numbering.unknown):
        free = np.flatnonzero(unknown >= 0)[::-1]
        column[unknown[free]], slot[unknown[free]] = of_node[free], 3 * level[free] + component
    column = np.unique(column, return_inverse=True)[1]
    return ColumnPlaces(column, slot, 3 * _most_levels(unknowns, np.append(column, -1), np.append(slot, 0) // 3))


def _levels(of_node: IntArray, z: FloatArray) -> IntArray:
    """Number (N,) of each node in its column, from the lowest."""
    order = np.lexsort((z, of_node))
    out = np.empty(len(z), dtype=np.int64)
    out[order] = np.arange(len(z)) - np.searchsorted(of_node[order], of_node[order])
    return out


def _most_levels(unknowns: IntArray, column: IntArray, level: IntArray) -> int:
    """Most levels between two unknowns of one element (k, E) and one column; both with an entry for what is fixed."""
    most = 1
    for i in range(1, len(unknowns)):
        one, others = unknowns[i], unknowns[:i]
        same = (column[others] == column[one]) & (column[one] >= 0)
        most = max(most, int(np.abs(level[others] - level[one])[same].max(initial=0)))
    return most
