"""The equations of a mesh whose conditions are known, for every geometry."""

from __future__ import annotations

import numpy as np

from fem.analysis.equilibrium import Equilibrium
from fem.arrays import BoolArray, FloatArray
from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.elements import make_elements
from fem.assembly.scatter import Numbering, build_scatter, number_unknowns
from fem.assembly.system import make_system
from fem.linear_solver import make_solver
from fem.materials.components import Components
from fem.materials.element_laws import element_laws
from fem.mesh.quads import Mesh
from fem.mesh.solid import AnyMesh
from fem.problem.problem import Problem
from fem.setup.contacts import Conditions
from fem.setup.items import make_items


def set_up(
    problem: Problem,
    mesh: AnyMesh,
    geometry: ElementGeometry,
    fixed: BoolArray,
    conditions: Conditions,
    linear_solver: str,
) -> Equilibrium:
    """Equations, linear solver, unit load and depth probe.

    Parameters
    ----------
    problem
        What was asked.
    mesh, geometry
        The mesh and its geometry at the Gauss points.
    fixed
        Displacements (components, N) that are zero.
    conditions
        Conditions of the contact; what it holds is in `fixed` already.
    linear_solver
        See :func:`fem.prepare`.
    """
    displacements = _numbered(problem, mesh, fixed, conditions.tied)
    numbering, items, tool = make_items(problem, mesh, displacements, conditions)
    laws = element_laws(
        tuple(layer.material for layer in problem.layers),
        mesh.layer,
        tuple(layer.relaxation for layer in problem.layers),
        _pretension(problem, geometry.components),
    )
    elements = make_elements(geometry, laws, _stabilisation(problem))
    system = make_system(elements, numbering, build_scatter(mesh.elements, numbering), items)
    solver = make_solver(linear_solver, system.scatter.indptr, system.scatter.indices)
    if tool is not None:
        return Equilibrium(system, solver, -np.eye(1, numbering.count, tool)[0], tool)
    nodal = np.zeros(fixed.shape)
    nodal[-1] = conditions.load
    load: FloatArray = numbering.reduce(nodal)
    return Equilibrium(system, solver, load, int(numbering.unknown[-1, mesh.interfaces[0][0]]))


def _numbered(problem: Problem, mesh: AnyMesh, fixed: BoolArray, tied: BoolArray) -> Numbering:
    """The displacements' numbers; in small strain the sides of an interface that slips stay level."""
    if isinstance(mesh, Mesh) and problem.kinematics == "linear":
        return number_unknowns(fixed, tied, zip(mesh.undersides, mesh.interfaces[1:], strict=True))
    return number_unknowns(fixed, tied)


def _pretension(problem: Problem, components: Components) -> FloatArray | None:
    """In-plane stress (components, 1, 1) in Pa; the last axis is the normal of the layers."""
    if problem.pretension == 0.0:
        return None
    in_plane = components.identity.copy()
    in_plane[components.normal[-1]] = 0.0
    out: FloatArray = problem.pretension * in_plane.reshape(-1, 1, 1)
    return out


def _stabilisation(problem: Problem) -> float:
    """Small strain needs none."""
    return problem.discretisation.stabilisation if problem.kinematics == "finite" else 0.0
