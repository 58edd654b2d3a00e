"""What the tool meets on the top face of a mesh: nodes under it, their areas, and a load spread over its disc."""

from __future__ import annotations

import numpy as np
import skfem

from fem.arrays import BoolArray, FloatArray
from fem.assembly.solid import SOLID_ELEMENTS
from fem.mesh.quads import Mesh, ring_areas
from fem.mesh.solid import AnyMesh, SolidMesh
from fem.mesh.surface.surface_mesh import SurfaceMesh

INSIDE = 1.0 + 1e-9
AXIS_SHARE = 0.1  # area of the node on the axis, which is 0 by Simpson's rule, over its neighbour's


def under_tool(mesh: AnyMesh, radius: float) -> BoolArray:
    """Nodes (N,) of the top face within a radius in m of the tool's axis."""
    return mesh.top & (mesh.tool_distance <= radius * INSIDE)


def disc_load(mesh: AnyMesh, radius: float) -> FloatArray:
    """Work-equivalent nodal forces (N,) in z of 1 N over the reference disc of a radius in m, seen from above."""
    if isinstance(mesh, Mesh):
        return _ring_load(mesh, radius)
    return mesh.tool_load if isinstance(mesh, SurfaceMesh) else _face_load(mesh, radius)


def top_areas(mesh: AnyMesh) -> FloatArray:
    """Area (N,) in m2 of each node of the top face, with all mirror images; 0 elsewhere."""
    if not isinstance(mesh, Mesh):
        return mesh.images * _face_integrals(mesh, np.ones(len(mesh.top_elements), dtype=np.bool_))
    top = mesh.interfaces[0]
    area = ring_areas(mesh.nodes[top, 0])
    area[0] = AXIS_SHARE * area[1]
    out = np.zeros(len(mesh.nodes))
    out[top] = area
    return out


def _ring_load(mesh: Mesh, radius: float) -> FloatArray:
    """Nodal forces -int N 2 r dr / radius^2, (N,), by Simpson's rule, exact for N r with quadratic N."""
    top = mesh.interfaces[0]
    row = top[mesh.nodes[top, 0] <= radius]
    inner, middle, outer = row[:-2:2], row[1:-1:2], row[2::2]
    r0, r1, r2 = (mesh.nodes[n, 0] for n in (inner, middle, outer))
    share = (r2 - r0) / (3.0 * radius**2)
    load = np.zeros(len(mesh.nodes))
    np.add.at(load, inner, -share * r0)
    np.add.at(load, middle, -share * 4.0 * r1)
    np.add.at(load, outer, -share * r2)
    return load


def _face_load(mesh: SolidMesh, radius: float) -> FloatArray:
    """Nodal forces (N,) that add up to -1: the shape functions' integrals over the top faces inside the disc."""
    x, y, _ = mesh.nodes[mesh.elements[:, mesh.top_elements]].transpose(2, 0, 1)
    centre = np.hypot(x.mean(axis=0) - mesh.axis_point[0], y.mean(axis=0) - mesh.axis_point[1])
    share = _face_integrals(mesh, centre < radius)
    out: FloatArray = -share / share.sum()
    return out


def _face_integrals(mesh: SolidMesh, wanted: BoolArray) -> FloatArray:
    """Integrals (N,) in m2 of the nodes' shape functions over some of the top faces (T,)."""
    element = SOLID_ELEMENTS[mesh.element]
    points, weights = skfem.quadrature.get_quadrature(skfem.ElementQuad2(), 5)
    value, rows = element.tabulate(np.concatenate((points, np.ones((1, points.shape[1])))))
    faces = mesh.elements[:, mesh.top_elements[wanted]]
    x, y, _ = mesh.nodes[faces].transpose(2, 0, 1)
    (x_xi, x_eta, _), (y_xi, y_eta, _) = ((rows @ c).reshape(3, len(weights), -1) for c in (x, y))
    share = value.T @ ((x_xi * y_eta - x_eta * y_xi) * weights[:, None])
    area = np.zeros(len(mesh.nodes))
    np.add.at(area, faces.ravel(), share.ravel())
    return area
