"""The equations of a mesh whose conditions are known, for every geometry."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fem.analysis.equilibrium import Equilibrium
from fem.arrays import BoolArray, FloatArray
from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.scatter import Numbering, build_scatter, number_unknowns
from fem.assembly.system import System
from fem.interactions.interface import Slipping
from fem.interactions.punch import Punch
from fem.interactions.tool_contact import STIFFNESS, Contact, ContactSystem
from fem.linear_solver import make_solver
from fem.materials.components import Components
from fem.materials.element_laws import element_laws
from fem.mesh.quads import Mesh
from fem.mesh.solid import AnyMesh
from fem.problem.problem import Problem
from fem.setup.contacts import Conditions
from fem.setup.items import OWN_UNKNOWNS, slipping_interfaces, with_interfaces


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
    numbering, interfaces = _numbered(problem, mesh, fixed, conditions.tied)
    numbering = replace(numbering, count=numbering.count + sum(OWN_UNKNOWNS * len(part.start) for part in interfaces))
    if conditions.punch is not None and conditions.area is not None:
        more = 1 + _multipliers(conditions.punch, len(fixed)) * int(np.sum(conditions.area > 0.0))
        numbering = replace(numbering, count=numbering.count + more)
    laws = element_laws(
        tuple(layer.material for layer in problem.layers),
        mesh.layer,
        tuple(layer.relaxation for layer in problem.layers),
        _pretension(problem, geometry.components),
    )
    scatter = with_interfaces(build_scatter(mesh.elements, numbering), numbering.count, interfaces)
    if conditions.punch is not None and conditions.area is not None:
        contact = _contact(problem, mesh, numbering, conditions.punch, conditions.area)
        touched = ContactSystem(geometry, laws, numbering, scatter, _stabilisation(problem), contact)
        solver = make_solver(linear_solver, touched.scatter.indptr, touched.scatter.indices)
        push = -np.eye(1, numbering.count, contact.tool)[0]
        return Equilibrium(touched.slipping(interfaces), solver, push, contact.tool)
    solver = make_solver(linear_solver, scatter.indptr, scatter.indices)
    nodal = np.zeros(fixed.shape)
    nodal[-1] = conditions.load
    load: FloatArray = numbering.reduce(nodal)
    probe = int(numbering.unknown[-1, mesh.interfaces[0][0]])
    system = System(geometry, laws, numbering, scatter, _stabilisation(problem))
    return Equilibrium(system.slipping(interfaces), solver, load, probe)


def _numbered(
    problem: Problem, mesh: AnyMesh, fixed: BoolArray, tied: BoolArray
) -> tuple[Numbering, tuple[Slipping, ...]]:
    """The displacements' numbers and the interfaces that slip; in small strain their sides stay level."""
    if not isinstance(mesh, Mesh):
        return number_unknowns(fixed, tied), ()
    if problem.kinematics == "linear":
        return number_unknowns(fixed, tied, zip(mesh.undersides, mesh.interfaces[1:], strict=True)), ()
    numbering = number_unknowns(fixed, tied)
    return numbering, slipping_interfaces(problem, mesh, numbering)


def _contact(problem: Problem, mesh: AnyMesh, numbering: Numbering, punch: Punch, area: FloatArray) -> Contact:
    nodes = np.flatnonzero(area > 0.0)
    stiffness = STIFFNESS * problem.layers[0].material.shear_modulus / punch.radius
    kinds = _multipliers(punch, len(numbering.unknown))
    multipliers = numbering.count + np.arange(-kinds * len(nodes), 0).reshape(kinds, -1)
    tool = np.full((1, len(nodes)), multipliers[0, 0] - 1)
    place: FloatArray = mesh.nodes[nodes].T.copy()
    unknowns = np.concatenate((numbering.unknown[:, nodes], tool, multipliers))
    gap = punch.gap(place)
    anchor = place[:-1] if gap is None else gap.path
    return Contact(punch, place, stiffness * area[nodes], unknowns, anchor, np.zeros(len(nodes)))


def _multipliers(punch: Punch, components: int) -> int:
    """Multipliers a node: one against the punch and, with friction, one a direction on it."""
    return 1 if punch.friction == 0.0 else components


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
