"""From a problem to a model: mesh, conditions, unknowns and equations."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from fem.analysis.equilibrium import Equilibrium
from fem.analysis.newton import NewtonSettings
from fem.analysis.prepared import Model
from fem.arrays import BoolArray, FloatArray
from fem.assembly.axisymmetric import gauss_geometry
from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.elements import make_elements
from fem.assembly.scatter import Numbering, build_scatter, number_unknowns
from fem.assembly.solid import solid_geometry
from fem.assembly.system import System, make_system
from fem.errors import FemError, require_one_of
from fem.linear_solver import LINEAR_SOLVERS, IterativeSolver, SymmetricSolver, make_solver
from fem.materials.components import Components
from fem.materials.element_laws import ElementLaws, element_laws
from fem.mesh.quads import Mesh, split_interfaces
from fem.mesh.solid import AnyMesh, SolidMesh
from fem.problem.problem import Problem
from fem.results.fields import FieldRecovery
from fem.setup.contacts import CONTACT_MODELS, Conditions
from fem.setup.items import make_items, sliding_nodes
from fem.setup.layout import lay_out
from fem.setup.supports import SUPPORT_MODELS

ITERATIVE_FROM = {"linear": 70_000, "finite": 100_000}
"""Unknowns from which on the iterative solver is faster, by kinematics: it does more for each Newton correction."""
OF_TETRAHEDRA = 10.0  # least stabilisation of P2/P0; set on a slab of one layer, docs/fem.md


def build_model(problem: Problem, linear_solver: str, mesh_file: Path | None = None) -> Model:
    """See :func:`fem.prepare`."""
    contact = CONTACT_MODELS.get(problem.tool.contact)
    if contact is None:
        raise FemError(
            f"tool.contact = {problem.tool.contact!r}: not available in this solver; "
            f"available are {', '.join(sorted(CONTACT_MODELS))}"
        )
    warnings = contact.check(problem)
    if problem.geometry == "axisymmetric":
        return _axisymmetric_model(problem, linear_solver, warnings)
    return _solid_model(problem, linear_solver, warnings, mesh_file)


def _solid_model(problem: Problem, linear_solver: str, warnings: tuple[str, ...], mesh_file: Path | None) -> Model:
    from fem.setup.building import solid_model
    from fem.setup.layout_solid import lay_out_block, lay_out_surface

    if problem.surface is None:
        return solid_model(problem, lay_out_block(problem), linear_solver, warnings)
    mesh = lay_out_surface(problem, problem.surface, mesh_file)
    return solid_model(problem, mesh, linear_solver, (*warnings, *mesh.remarks))


def _axisymmetric_model(problem: Problem, linear_solver: str, warnings: tuple[str, ...]) -> Model:
    slipping = [layer for layer, limit in enumerate(problem.shear_limits) if limit is not None]
    mesh = split_interfaces(lay_out(problem), slipping)
    conditions = CONTACT_MODELS[problem.tool.contact].conditions(mesh, problem)
    support = SUPPORT_MODELS[problem.support.kind].fixed(mesh, problem)
    radial = (support & ~sliding_nodes(mesh, problem)) | mesh.axis | conditions.held
    geometry = gauss_geometry(mesh)
    equilibrium = set_up(problem, mesh, geometry, np.stack((radial, support)), conditions, linear_solver)
    elements = equilibrium.system.elements
    recovery = FieldRecovery(mesh, elements.laws, geometry, elements.point_modulus, problem.kinematics == "finite")
    return Model(problem, mesh, equilibrium, recovery, NewtonSettings(), warnings)


def solid_model(problem: Problem, mesh: SolidMesh, linear_solver: str, warnings: tuple[str, ...]) -> Model:
    """Model of a problem on a three-dimensional mesh."""
    tool = problem.tool
    conditions = CONTACT_MODELS[tool.contact].conditions(mesh, problem)
    support = SUPPORT_MODELS[problem.support.kind].fixed(mesh, problem)
    lateral = support | conditions.held
    fixed = np.stack((lateral | mesh.mirror_x, lateral | mesh.mirror_y, support))
    geometry = solid_geometry(mesh)
    equilibrium = set_up(problem, mesh, geometry, fixed, conditions, linear_solver)
    if tool.tilt != 0.0 and conditions.punch is None:
        turned = _turn(mesh, tool.tilt) * conditions.tied
        equilibrium = replace(equilibrium, system=equilibrium.system.displaced(mesh.elements, turned))
    elements = equilibrium.system.elements
    recovery = FieldRecovery(mesh, elements.laws, geometry, elements.point_modulus, problem.kinematics == "finite")
    return Model(problem, mesh, equilibrium, recovery, NewtonSettings(), warnings)


def _turn(mesh: SolidMesh, tilt: float) -> FloatArray:
    """Displacements (3, N) in m of a turn of the top face by `tilt` about the tool's centre, upper end to +x."""
    x = mesh.nodes[:, 0] - mesh.axis_point[0]
    return np.stack(((np.cos(tilt) - 1.0) * x, np.zeros_like(x), -np.sin(tilt) * x))


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
    elements = make_elements(geometry, layer_laws(problem, mesh, geometry.components), stabilisation(problem))
    system = make_system(elements, numbering, build_scatter(mesh.elements, numbering), items)
    solver = _linear_solver(linear_solver, problem, mesh, system)
    if tool is not None:
        return Equilibrium(system, solver, -np.eye(1, numbering.count, tool)[0], tool)
    nodal = np.zeros(fixed.shape)
    nodal[-1] = conditions.load
    load: FloatArray = numbering.reduce(nodal)
    return Equilibrium(system, solver, load, int(numbering.unknown[-1, mesh.interfaces[0][0]]))


def _linear_solver(choice: str, problem: Problem, mesh: AnyMesh, system: System) -> SymmetricSolver | IterativeSolver:
    """The solver of that name; "auto": iterative where it can be had and the system is large.

    Raises
    ------
    FemError
        If it is not available for this mesh.
    """
    require_one_of("linear_solver", choice, LINEAR_SOLVERS)
    scatter, endless = system.scatter, problem.support.kind == "half_space"
    suited = isinstance(mesh, SolidMesh) and mesh.element == "hex27" and not system.items and not endless
    if choice == "iterative" and not suited:
        raise FemError(
            "linear_solver = 'iterative': only with geometry = 'block', without a tool that touches and comes off, and "
            "not on a half-space; use 'auto'"
        )
    if isinstance(mesh, SolidMesh) and suited and _is_iterative(choice, problem, system.numbering.count):
        from fem.assembly.coarsening import coarse_space

        space = coarse_space(mesh, system.numbering, scatter)
        coarse = make_solver("auto", space.indptr, space.indices)
        return IterativeSolver(space, coarse, lambda: make_solver("auto", scatter.indptr, scatter.indices))
    return make_solver(choice, scatter.indptr, scatter.indices)


def _is_iterative(choice: str, problem: Problem, unknowns: int) -> bool:
    return choice == "iterative" or (choice == "auto" and unknowns >= ITERATIVE_FROM[problem.kinematics])


def _numbered(problem: Problem, mesh: AnyMesh, fixed: BoolArray, tied: BoolArray) -> Numbering:
    """The displacements' numbers; in small strain the sides of an interface that slips stay level."""
    if isinstance(mesh, Mesh) and problem.kinematics == "linear":
        return number_unknowns(fixed, tied, zip(mesh.undersides, mesh.interfaces[1:], strict=True))
    return number_unknowns(fixed, tied)


def layer_laws(problem: Problem, mesh: AnyMesh, components: Components) -> ElementLaws:
    """Laws of the mesh's elements."""
    return element_laws(
        tuple(layer.material for layer in problem.layers),
        mesh.layer,
        tuple(layer.relaxation for layer in problem.layers),
        _pretension(problem, components),
    )


def _pretension(problem: Problem, components: Components) -> FloatArray | None:
    """In-plane stress (components, 1, 1) in Pa; the last axis is the normal of the layers."""
    if problem.pretension == 0.0:
        return None
    in_plane = components.identity.copy()
    in_plane[components.normal[-1]] = 0.0
    out: FloatArray = problem.pretension * in_plane.reshape(-1, 1, 1)
    return out


def stabilisation(problem: Problem) -> float:
    """Part of the bulk modulus, in shear moduli, that acts at the Gauss points.

    Q2/P1 at small strain needs none. The tetrahedra of a body from a surface do at any strain: quadratic displacements
    with a constant pressure (P2/P0) have no node in a face that could keep what flows through it in balance, and are
    too soft by some per cent on each mesh (docs/fem.md has the figures).
    """
    asked = problem.discretisation.stabilisation if problem.kinematics == "finite" else 0.0
    return max(asked, OF_TETRAHEDRA) if problem.geometry == "surface" else asked
