"""The equations of a changed problem on the unknowns of the problem as told."""

from __future__ import annotations

from dataclasses import dataclass, replace

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
from fem.sensitivity.held_mesh import moved_mesh
from fem.setup.building import layer_laws, stabilisation
from fem.setup.contacts import CONTACT_MODELS, Conditions
from fem.setup.items import make_items


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
