"""A changed problem on the mesh and the unknowns of the problem as told: its moved nodes and its equations.

The mesh keeps its topology. Radii move linearly between the axis, where the tool's face ends, the tool's radius, the
rim of the hole and the outer border, which stays; depths move linearly between the layers' faces. The lines of a mesh
go through these places, so its elements stay straight.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from fem.analysis.equilibrium import State
from fem.analysis.prepared import Model
from fem.arrays import FloatArray
from fem.assembly.axisymmetric import gauss_geometry
from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.elements import make_elements
from fem.assembly.solid import solid_geometry
from fem.assembly.system import System
from fem.errors import NotDifferentiableError
from fem.mesh.quads import Mesh
from fem.mesh.solid import AnyMesh
from fem.problem.problem import Problem
from fem.setup.building import layer_laws, stabilisation
from fem.setup.contacts import CONTACT_MODELS, Conditions
from fem.setup.items import make_items

AnyOf = TypeVar("AnyOf", bound=AnyMesh)


@dataclass(frozen=True)
class ChangedEquations:
    """Equations with a parameter at an offset from its value.

    Attributes
    ----------
    system
        Residual, with what its items and elements remember.
    unit_load
        Forces (n,) of a press of 1 N.
    offset
        Of the parameter, in its own unit.
    nodes
        Places (N, components) in m of the nodes at rest.
    """

    system: System
    unit_load: FloatArray
    offset: float
    nodes: FloatArray

    def beside(self, state: State, dy: FloatArray, df: float) -> State:
        """The state to first order at this offset, of derivatives dy (n,) and df by the parameter."""
        return replace(state, y=state.y + self.offset * dy, force=state.force + self.offset * df)

    def unbalanced(self, state: State) -> FloatArray:
        """Forces (n,) that are unbalanced at a state in finite strain.

        Raises
        ------
        NotDifferentiableError
            If there are none there.
        """
        found = self.system.evaluate(state.y, state.pressure)
        if found is None:
            raise NotDifferentiableError("the changed problem has no forces at this state; take a smaller change")
        return found.residual - state.force * self.unit_load

    def unbalanced_linear(self, state: State) -> FloatArray:
        """Forces (n,) that are unbalanced at a state in small strain."""
        system = self.system.plain
        rest = system.evaluate(*system.rest())
        if rest is None:
            raise ArithmeticError("the mesh has an element without volume")
        out = system.linear_residual(rest, state.y) - state.force * self.unit_load
        if self.system.offset is not None:
            out += system.scatter.vector(system.elements.linear_force(rest.elements, self.system.offset))
        return out


def changed_equations(model: Model, problem: Problem, offset: float) -> ChangedEquations:
    """The equations of a problem that differs from a model's in numbers.

    Raises
    ------
    NotDifferentiableError
        If it differs in kind, or the mesh cannot follow.
    """
    told, equilibrium = model.problem, model.equilibrium
    _require_same_kind(told, problem)
    mesh = moved_mesh(model.mesh, told, problem)
    system = equilibrium.system
    geometry = system.elements.geometry if mesh is model.mesh else _geometry(mesh)
    elements = make_elements(geometry, layer_laws(problem, mesh, geometry.components), stabilisation(problem))
    displacements = replace(system.numbering, count=int(system.numbering.unknown.max()) + 1)
    conditions = _held_conditions(model, mesh, problem)
    numbering, items, tool = make_items(problem, mesh, displacements, conditions)
    if numbering.count != system.numbering.count:
        raise NotDifferentiableError("the changed problem has other unknowns; take a smaller change")
    load = equilibrium.unit_load
    if tool is None:
        nodal = np.zeros((mesh.nodes.shape[1], len(mesh.nodes)))
        nodal[-1] = conditions.load
        load = numbering.reduce(nodal)
    return ChangedEquations(replace(system, elements=elements, items=items), load, offset, mesh.nodes)


def _geometry(mesh: AnyMesh) -> ElementGeometry:
    return gauss_geometry(mesh) if isinstance(mesh, Mesh) else solid_geometry(mesh)


def _held_conditions(model: Model, mesh: AnyMesh, problem: Problem) -> Conditions:
    """The contact's conditions on the nodes that they are on in the problem as told."""
    contact = CONTACT_MODELS[problem.tool.contact]
    told, found = contact.conditions(model.mesh, model.problem), contact.conditions(mesh, problem)
    area = found.area
    if told.area is not None and area is not None:
        wide = replace(problem, tool=replace(problem.tool, radius=2.0 * problem.tool.radius))
        every = contact.conditions(mesh, wide).area
        area = np.where(told.area > 0.0, area if every is None else every, 0.0)
    return replace(found, held=told.held, tied=told.tied, area=area)


def _require_same_kind(told: Problem, changed: Problem) -> None:
    """Refuse a change that is no change of numbers."""

    def kind(problem: Problem) -> tuple[object, ...]:
        laws = tuple((layer.name, layer.material.law, len(layer.relaxation)) for layer in problem.layers)
        tool = (problem.tool.contact, problem.tool.edge_radius is None, problem.tool.tilt, problem.tool.position)
        slips = tuple(limit is None for limit in problem.shear_limits)
        clamp = problem.support.clamp_shear_limit is None
        return laws, tool, problem.support.kind, problem.kinematics, problem.geometry, slips, clamp

    if kind(told) != kind(changed):
        raise NotDifferentiableError(
            "a derivative is by numbers: laws, contact, support, tilt and place of the tool must stay"
        )


def moved_mesh(mesh: AnyOf, told: Problem, changed: Problem) -> AnyOf:
    """The mesh of a problem as told with its nodes where those of the changed one are; itself if nothing moves.

    Raises
    ------
    NotDifferentiableError
        The mesh cannot follow the change.
    """
    nodes = mesh.nodes.copy()
    places, moved = (_depths(problem, mesh) for problem in (told, changed))
    if not np.array_equal(places, moved):
        if told.geometry == "surface":
            raise NotDifferentiableError("thickness: the mesh of a body from a surface cannot follow it")
        nodes[:, -1] = -np.interp(-nodes[:, -1], places, moved)
    places, moved = (_radii(problem, mesh) for problem in (told, changed))
    if not np.array_equal(places, moved):
        if isinstance(mesh, Mesh):
            nodes[:, 0] = np.interp(nodes[:, 0], places, moved)
        elif not (told.touches and told.support == changed.support):
            raise NotDifferentiableError(
                f"geometry = {told.geometry!r}: its mesh cannot follow another radius of a tool that is tied, or of a "
                "hole"
            )
    return mesh if np.array_equal(nodes, mesh.nodes) else replace(mesh, nodes=nodes)


def _depths(problem: Problem, mesh: AnyMesh) -> FloatArray:
    """Depths (L + 1,) in m of the layers' faces; an endless layer ends where the mesh does."""
    thickness = np.array([layer.thickness for layer in problem.layers])
    depths = np.concatenate(([0.0], np.cumsum(thickness)))
    if problem.support.kind == "half_space" or problem.geometry == "surface":
        depths[-1] = -mesh.nodes[:, -1].min()
    return _increasing(depths)


def _radii(problem: Problem, mesh: AnyMesh) -> FloatArray:
    """Radii in m of what the mesh's radial lines go through."""
    tool = problem.tool
    if problem.support.specimen_radius is not None:
        return np.array([0.0, problem.support.specimen_radius])
    face = tool.radius - tool.edge_radius if problem.touches and tool.edge_radius is not None else 0.0
    inner = [face] if face > 0.0 else []
    rim = [] if problem.support.hole_radius is None else [problem.support.hole_radius]
    return _increasing(np.array([0.0, *inner, tool.radius, *rim, float(mesh.specimen_distance.max())]))


def _increasing(places: FloatArray) -> FloatArray:
    if not (np.diff(places) > 0.0).all():
        raise NotDifferentiableError(
            "the mesh cannot follow this change: tool, rim of the hole, border or layers would meet"
        )
    return places
