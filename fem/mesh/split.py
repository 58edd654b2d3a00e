"""Interfaces whose two sides have nodes of their own, at the same places at rest."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from fem.mesh.quads import Mesh


def split_interfaces(mesh: Mesh, above: Collection[int]) -> Mesh:
    """The mesh with the lower faces of some layers parted from what is below them.

    The nodes on the axis and on the outer border, which cannot slide, stay those of both sides.

    Parameters
    ----------
    mesh
        A mesh whose layers are joined.
    above
        Numbers of the layers, 0 on top, whose lower faces get nodes of their own.
    """
    for layer in above:
        mesh = _split_below(mesh, layer)
    return mesh


def _split_below(mesh: Mesh, layer: int) -> Mesh:
    row, count = mesh.interfaces[layer + 1], len(mesh.nodes)
    parted = row[~(mesh.axis | mesh.border)[row]]
    twin = np.arange(count)
    twin[parted] = count + np.arange(len(parted))
    upper = mesh.layer == layer
    elements = mesh.elements.copy()
    elements[:, upper] = twin[elements[:, upper]]
    undersides = list(mesh.undersides)
    undersides[layer] = twin[row]
    origin = np.concatenate((np.arange(count), parted))
    return replace(
        mesh,
        nodes=mesh.nodes[origin],
        elements=elements,
        axis=mesh.axis[origin],
        top=mesh.top[origin],
        base=mesh.base[origin],
        border=mesh.border[origin],
        undersides=tuple(undersides),
    )
