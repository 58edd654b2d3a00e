"""Meshes of biquadratic quadrilaterals, and the node sets every part of the solver works with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import skfem

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.mesh.rows import along_row


@dataclass(frozen=True)
class Mesh:
    """9-node quadrilaterals in (r, z), z upwards with the top face at z = 0.

    Attributes
    ----------
    nodes
        Reference positions (N, 2) in m.
    elements
        Node numbers (9, E): four corners around, the four mid-sides after them, the centre.
    layer
        Layer of each element (E,), 0 on top.
    axis, top, base, border
        Nodes (N,) on the axis, the top face, the lower face and the outer border.
    interfaces
        For each layer the nodes of its top face from the axis outwards, corners and mid-sides in turn.
    undersides
        For each layer but the last the nodes of its lower face in the same order: those of the next top face, or
        where the interface is split nodes at the same places (see :mod:`fem.mesh.split`).
    """

    nodes: FloatArray
    elements: IntArray
    layer: IntArray
    axis: BoolArray
    top: BoolArray
    base: BoolArray
    border: BoolArray
    interfaces: tuple[IntArray, ...]
    undersides: tuple[IntArray, ...]

    @property
    def radius(self) -> float:
        """Radius of the outer border in m."""
        return float(self.nodes[:, 0].max())

    @property
    def specimen_distance(self) -> FloatArray:
        """Distance of the nodes (N,) in m from the specimen's axis, which is the tool's."""
        out: FloatArray = self.nodes[:, 0]
        return out

    def profile(self, values: FloatArray, r: FloatArray) -> FloatArray:
        """Nodal values (N,) on each layer's top face at distances r (m,) from the tool's axis, (L, m)."""
        return np.stack([along_row(self.nodes[row, 0], values[row], r) for row in self.interfaces])


def mesh_of_quads(points: FloatArray, quads: IntArray, layer_tops: FloatArray) -> Mesh:
    """Biquadratic mesh of quadrilaterals, its nodes numbered by scikit-fem.

    Parameters
    ----------
    points
        Corners (P, 2) in m. A quadrilateral may be collapsed to a triangle: two corners at one place.
    quads
        Corner numbers (4, E) around each quadrilateral.
    layer_tops
        Depths (L,) of the layers' top faces in m, from 0.
    """
    basis = skfem.Basis(
        skfem.MeshQuad(np.ascontiguousarray(points.T), np.ascontiguousarray(quads)),
        skfem.ElementQuad2(),
        intorder=1,
    )
    nodes = np.ascontiguousarray(basis.doflocs.T)
    elements = np.asarray(basis.element_dofs, dtype=np.int64)
    r, z = nodes.T
    interfaces = tuple(_row(r, np.flatnonzero(z == -depth)) for depth in layer_tops)
    return Mesh(
        nodes,
        elements,
        layer=np.searchsorted(layer_tops, -z[elements[8]]) - 1,
        axis=np.asarray(r == 0.0),
        top=np.asarray(z == 0.0),
        base=np.asarray(z == z.min()),
        border=np.asarray(r == r.max()),
        interfaces=interfaces,
        undersides=interfaces[1:],
    )


def _row(r: FloatArray, row: IntArray) -> IntArray:
    """Nodes of a row ordered by r, one for each place."""
    places, first = np.unique(r[row], return_index=True)
    del places
    return row[first]
