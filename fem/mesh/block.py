"""The structured three-dimensional mesh of a layered block: a plane grid, drawn down through the layers."""

from __future__ import annotations

import numpy as np

from fem.arrays import FloatArray
from fem.mesh.disc_grid import DiscGrid
from fem.mesh.solid import SolidMesh


def build_block(
    grid: DiscGrid, depth_lines: FloatArray, layer_tops: FloatArray, places: FloatArray, element: str
) -> SolidMesh:
    """Mesh of a block.

    Parameters
    ----------
    grid
        The plane grid.
    depth_lines
        Depths (m,) in m, increasing from 0.
    layer_tops
        Depths (L,) of the layers' top faces in m, each one of `depth_lines`.
    places
        Reference coordinates (n, 3) of the element's nodes, all of 0, 1/2 or 1.
    element
        Kind of the element, "hex27" or "hex20".
    """
    plane, patches = grid.points(), grid.elements()
    half_lines = np.insert(depth_lines[1:], range(len(depth_lines) - 1), 0.5 * (depth_lines[1:] + depth_lines[:-1]))
    depths = np.concatenate((depth_lines[:1], half_lines))
    count = len(plane)
    a, b, c = np.rint(2.0 * places).astype(np.int64).T
    level = 2 * np.arange(len(depth_lines) - 1)[None, :] + 2 - c[:, None]
    elements = (patches[a, b][:, :, None] + count * level[:, None, :]).reshape(len(places), -1)
    middle = 0.5 * (depth_lines[1:] + depth_lines[:-1])
    layer = np.tile(np.searchsorted(layer_tops, middle, side="right") - 1, patches.shape[2])
    nodes = np.concatenate((np.tile(plane, (len(depths), 1)), -np.repeat(depths, count)[:, None]), axis=1)
    rows = [grid.row() + count * int(np.flatnonzero(depths == top)[0]) for top in layer_tops]
    used, renumbered = np.unique(elements, return_inverse=True)
    x, y, z = nodes[used].T
    outer = grid.rings[-1] * (1.0 - 1e-9)
    return SolidMesh(
        nodes[used],
        renumbered.reshape(elements.shape),
        element,
        layer,
        axis_point=(grid.centre, 0.0),
        images=4 // grid.quarters,
        mirror_x=np.asarray((x == 0.0) & (grid.quarters == 1)),
        mirror_y=np.asarray(y == 0.0),
        top=np.asarray(z == 0.0),
        base=np.asarray(z == z.min()),
        border=np.asarray((np.abs(x) >= outer) | (y >= outer)),
        interfaces=tuple(np.searchsorted(used, row) for row in rows),
        top_elements=np.arange(patches.shape[2]) * (len(depth_lines) - 1),
    )
