"""The contacts on three-dimensional meshes, by their words."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
import skfem

from fem.arrays import BoolArray, FloatArray
from fem.assembly.solid import SOLID_ELEMENTS
from fem.interactions.punch import standing
from fem.mesh.solid import SolidMesh
from fem.mesh.surface.surface_mesh import SurfaceMesh
from fem.problem.problem import Problem
from fem.setup.contacts import REACH, Conditions, punch_of

INSIDE = 1.0 + 1e-9


def uniform_pressure(mesh: SolidMesh, radius: float) -> Conditions:
    """Work-equivalent nodal forces of 1 N spread over the reference disc of the radius (m), seen from above."""
    free = np.zeros(len(mesh.nodes), dtype=np.bool_)
    load = mesh.tool_load if isinstance(mesh, SurfaceMesh) else _disc_load(mesh, radius)
    return Conditions(free, free, load)


def rigid_bonded(mesh: SolidMesh, radius: float) -> Conditions:
    """One vertical and no lateral displacement under the tool."""
    inside = mesh.top & (mesh.tool_distance <= radius * INSIDE)
    return Conditions(held=inside, tied=inside, load=_master_load(mesh))


def rigid_frictionless(mesh: SolidMesh, radius: float) -> Conditions:
    """One vertical displacement under the tool, free to slide."""
    inside = mesh.top & (mesh.tool_distance <= radius * INSIDE)
    return Conditions(held=np.zeros_like(inside), tied=inside, load=_master_load(mesh))


def rigid_punch(mesh: SolidMesh, problem: Problem) -> Conditions:
    """No tie; the nodes of a block near the tool may touch the punch."""
    tool = problem.tool
    punch = standing(punch_of(tool), tool.position, tool.tilt)
    area = mesh.images * _face_integrals(mesh, np.ones(len(mesh.top_elements), dtype=np.bool_))
    x, y, _ = punch.tip
    near = mesh.top & (np.hypot(mesh.nodes[:, 0] - x, mesh.nodes[:, 1] - y) <= REACH * tool.radius)
    free, touching = np.zeros(len(mesh.nodes), dtype=np.bool_), punch.lowered(mesh.nodes[near].T)
    return Conditions(free, free, np.zeros(len(mesh.nodes)), touching, np.where(near, area, 0.0))


TIED: Mapping[str, Callable[[SolidMesh, float], Conditions]] = MappingProxyType(
    {
        "uniform_pressure": uniform_pressure,
        "rigid_bonded": rigid_bonded,
        "rigid_frictionless": rigid_frictionless,
    }
)


def solid_conditions(mesh: SolidMesh, problem: Problem) -> Conditions:
    """Conditions on the nodes of a mesh; tools that touch do so in finite strain."""
    tool = problem.tool
    if problem.touches:
        return rigid_punch(mesh, problem)
    return TIED[tool.contact](mesh, tool.radius)


def _master_load(mesh: SolidMesh) -> FloatArray:
    load = np.zeros(len(mesh.nodes))
    load[mesh.interfaces[0][0]] = -1.0
    return load


def _disc_load(mesh: SolidMesh, radius: float) -> FloatArray:
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
