"""What every element gives the equations: the way from nodal values to gradients and back.

Shapes are (..., q, E): point before element, so that one matrix product serves all elements at once. The rows
of a component are the derivatives (and the value, where the geometry needs it) of the shape functions of one
displacement component in reference coordinates; "pulled back" are quantities that multiply these rows.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.materials.components import Components


class ElementGeometry(ABC):
    """Factors at q points of E elements with n nodes and p pressure shapes.

    Attributes
    ----------
    weight
        Volume of each point, (q, E), in m3, with all mirror images.
    pressure
        Pressure shapes (p, q, E), orthonormal in the weight on each element.
    """

    weight: FloatArray
    pressure: FloatArray

    @property
    @abstractmethod
    def components(self) -> Components:
        """Components of the deformation gradient."""

    @property
    @abstractmethod
    def tables(self) -> tuple[FloatArray, ...]:
        """Rows of each displacement component at the points, (rows q, n) each."""

    @abstractmethod
    def gradient(self, u: FloatArray) -> FloatArray:
        """Displacement gradient (components, q, E) of nodal displacements (n times components, E)."""

    @abstractmethod
    def pull_back(self, stress: FloatArray, elements: slice = slice(None)) -> FloatArray:
        """Reference rows (components, ..., q, E) of components (components, ..., q, E), not weighted."""

    def forces(self, stress: FloatArray) -> FloatArray:
        """Nodal forces (n times components, E) of a weighted first Piola-Kirchhoff stress."""
        return self._on_nodes(self.pull_back(stress).reshape(-1, stress.shape[2]))

    def coupling(self, cofactor: FloatArray) -> FloatArray:
        """Derivative (n times components, p, E) of the volume change by the nodal displacements, cofactor weighted."""
        rate = self.pull_back(cofactor)
        count, _, elements = self.pressure.shape
        weighted = rate[:, :, None, :] * self.pressure.transpose(1, 0, 2)
        both = self._on_nodes(weighted.reshape(rate.shape[0] * rate.shape[1], count * elements))
        return both.reshape(len(both), count, elements)

    def stiffness(self, moduli: FloatArray, part: slice) -> FloatArray:
        """Packed stiffness (entries, part) of some elements, of their weighted moduli (pairs, q, part)."""
        half = self.pull_back(self.components.unpack(moduli), part)
        rows = self.pull_back(np.swapaxes(half, 0, 1), part)[self.components.pairs]
        flat = rows.reshape(-1, rows.shape[2])
        ends = np.cumsum([table.shape[1] for table in self._products])[:-1]
        pieces = np.split(flat, ends)
        return np.concatenate([table @ piece for table, piece in zip(self._products, pieces, strict=True)])

    @cached_property
    def packed(self) -> tuple[IntArray, IntArray]:
        """Row and column (entries,) of each entry of a packed element stiffness."""
        return packed_positions(self.tables[0].shape[1], len(self.tables))

    @cached_property
    def _products(self) -> tuple[FloatArray, ...]:
        return stiffness_tables(self.components, self.tables)

    def _on_nodes(self, flat: FloatArray) -> FloatArray:
        ends = np.cumsum([len(table) for table in self.tables])[:-1]
        pieces = np.split(flat, ends)
        return np.concatenate([table.T @ piece for table, piece in zip(self.tables, pieces, strict=True)])


def orthonormal(monomials: FloatArray, weight: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Shapes made orthonormal in the weight (q, E) on each element: from monomials (p, q), and at the points.

    Returns
    -------
    tuple of ndarray
        Lower triangular (p, p, E) and (p, q, E).
    """
    mass = np.einsum("iq,jq,qe->eij", monomials, monomials, weight)
    transform = np.ascontiguousarray(np.linalg.inv(np.linalg.cholesky(mass)).transpose(1, 2, 0))
    return transform, np.einsum("ije,jq->iqe", transform, monomials)


def packed_positions(nodes: int, components: int) -> tuple[IntArray, IntArray]:
    """Local row and column (entries,) of each packed entry: the upper triangle of the diagonal blocks, all of others.

    Blocks belong to two displacement components each, in the order (0, 0), (0, 1), ...
    """
    upper = np.triu_indices(nodes)
    full = tuple(grid.ravel() for grid in np.indices((nodes, nodes)))
    rows, columns = [], []
    for a in range(components):
        for b in range(a, components):
            i, j = upper if a == b else full
            rows.append(i + a * nodes)
            columns.append(j + b * nodes)
    return np.concatenate(rows), np.concatenate(columns)


def stiffness_tables(components: Components, tables: tuple[FloatArray, ...]) -> tuple[FloatArray, ...]:
    """Products of gradient rows that turn packed moduli into packed element stiffness.

    Returns
    -------
    tuple of ndarray
        One table for each block of two displacement components, first not after second: times the pulled back
        moduli (pairs q, E) of the block it gives the upper triangle of an equal block, all of an unequal one.
    """
    nodes = tables[0].shape[1]
    upper = np.triu_indices(nodes)
    rows = [table.reshape(length, -1, nodes) for table, length in zip(tables, components.blocks, strict=True)]
    block_of = np.repeat(np.arange(len(rows)), components.blocks)
    within = np.concatenate([np.arange(length) for length in components.blocks])
    found: dict[tuple[int, int], list[FloatArray]] = {}
    for k, m in zip(*components.pairs, strict=True):
        a, b = int(block_of[k]), int(block_of[m])
        product = np.einsum("qi,qj->ijq", rows[a][within[k]], rows[b][within[m]])
        if a != b:
            entries = product.reshape(nodes * nodes, -1)
        else:
            entries = (product if k == m else product + product.transpose(1, 0, 2))[upper]
        found.setdefault((a, b), []).append(entries)
    return tuple(np.concatenate(pieces, axis=1) for pieces in found.values())
