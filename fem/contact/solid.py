"""The contacts on three-dimensional meshes, by their words."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
import skfem

from fem.arrays import FloatArray
from fem.assembly.solid_element import SOLID_ELEMENTS
from fem.contact.conditions import Conditions
from fem.mesh import SolidMesh
from fem.mesh.surface import SurfaceMesh

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


SOLID_CONTACTS: Mapping[str, Callable[[SolidMesh, float], Conditions]] = MappingProxyType(
    {
        "uniform_pressure": uniform_pressure,
        "rigid_bonded": rigid_bonded,
        "rigid_frictionless": rigid_frictionless,
    }
)


def _master_load(mesh: SolidMesh) -> FloatArray:
    load = np.zeros(len(mesh.nodes))
    load[mesh.interfaces[0][0]] = -1.0
    return load


def _disc_load(mesh: SolidMesh, radius: float) -> FloatArray:
    """Nodal forces (N,) that add up to -1: the shape functions' integrals over the top faces inside the disc."""
    element = SOLID_ELEMENTS[mesh.element]
    points, weights = skfem.quadrature.get_quadrature(skfem.ElementQuad2(), 5)
    value, rows = element.tabulate(np.concatenate((points, np.ones((1, points.shape[1])))))
    faces = mesh.elements[:, mesh.top_elements]
    x, y, _ = mesh.nodes[faces].transpose(2, 0, 1)
    centre = np.hypot(x.mean(axis=0) - mesh.axis_point[0], y.mean(axis=0) - mesh.axis_point[1])
    inside = centre < radius
    (x_xi, x_eta, _), (y_xi, y_eta, _) = ((rows @ c[:, inside]).reshape(3, len(weights), -1) for c in (x, y))
    share = value.T @ ((x_xi * y_eta - x_eta * y_xi) * weights[:, None])
    load = np.zeros(len(mesh.nodes))
    np.add.at(load, faces[:, inside].ravel(), share.ravel())
    out: FloatArray = -load / load.sum()
    return out
