"""The contacts between tool and surface: what each refuses, the mesh it needs, and its conditions on the nodes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

import numpy as np

from fem.arrays import BoolArray, FloatArray
from fem.errors import FemError
from fem.interactions.punch import Punch, standing
from fem.mesh.grading import OUTWARD
from fem.mesh.quads import Mesh
from fem.mesh.solid import AnyMesh
from fem.problem.parts import Tool
from fem.problem.problem import Problem
from fem.setup.tool_faces import disc_load, top_areas, under_tool

REACH = 1.5  # radius in tool radii up to which nodes may touch the punch
EDGE_ELEMENTS = 10.0  # elements over the edge radius where it begins and ends
ARC = (1.0, 0.75, 0.5, 0.25, 0.0)  # places on it where elements gather, shares of the edge radius inwards
FINEST_EDGE = 1.0 / 200.0  # element size at a very sharp edge, in tool radii


@dataclass(frozen=True)
class Conditions:
    """Conditions of the contact on the nodes.

    Attributes
    ----------
    held
        Nodes (N,) whose lateral displacement is zero.
    tied
        Nodes (N,) that share one vertical displacement, the tool's.
    load
        Nodal forces (N,) in z of a press of 1 N; they add up to -1 exactly, or are 0 where a punch touches.
    punch
        A rigid punch that presses by touching, or None.
    area
        Area (N,) in m2 of the nodes that may touch it, 0 at others; needed with a punch.
    """

    held: BoolArray
    tied: BoolArray
    load: FloatArray
    punch: Punch | None = None
    area: FloatArray | None = None


@dataclass(frozen=True)
class Resolution:
    """How fine the mesh must be at the tool, in tool radii.

    Attributes
    ----------
    edge
        Element size at the edge.
    under
        Largest element size under the tool.
    fan
        Whether the material turns round the edge, so that a fan of elements is needed there.
    gather
        Where the element size at the edge is wanted, in tool radii.
    growth
        Growth of the element size from there along the surface under the tool, per length.
    """

    edge: float
    under: float
    fan: bool = False
    gather: tuple[float, ...] = (1.0,)
    growth: float = OUTWARD


SMALL_STRAIN = Resolution(edge=1.0 / 200.0, under=1.0 / 3.0)
SPHERE = Resolution(edge=1.0 / 400.0, under=1.0 / 20.0, gather=(0.0,), growth=0.1)
"""A sphere: fine wherever the border of the touch may be, since the force jumps as nodes come into touch one by one.

Round a smooth curve over depth it leaves 0.06 % (rms) from a hundredth of the radius on; a growth of 0.2 left 0.25 %.
"""
SLIDING_PLATE = Resolution(edge=1.0 / 20.0, under=1.0 / 6.0)  # no edge is stuck


class ContactModel(Protocol):
    """One kind of contact."""

    def check(self, problem: Problem) -> tuple[str, ...]:
        """Refuse what this contact cannot do (FemError); return warnings for what it ignores."""
        ...

    def resolution(self, problem: Problem) -> Resolution:
        """How fine an axisymmetric mesh must be at the tool."""
        ...

    def conditions(self, mesh: AnyMesh, problem: Problem) -> Conditions:
        """Conditions on the nodes of the mesh."""
        ...


@dataclass(frozen=True)
class UniformPressure:
    """A uniform dead traction on the reference disc r <= tool radius, always along the axis; no constraint."""

    def check(self, problem: Problem) -> tuple[str, ...]:
        """An edge radius means nothing here."""
        if problem.tool.edge_radius is None:
            return ()
        return ("tool.edge_radius has no effect on the contact 'uniform_pressure'",)

    def resolution(self, problem: Problem) -> Resolution:
        """The edge is only weakly singular, but the surface under the tool bends."""
        return SMALL_STRAIN if problem.kinematics == "linear" else Resolution(edge=1.0 / 25.0, under=1.0 / 6.0)

    def conditions(self, mesh: AnyMesh, problem: Problem) -> Conditions:
        """Work-equivalent nodal forces of 1 N over the disc."""
        return Conditions(_nowhere(mesh), _nowhere(mesh), disc_load(mesh, problem.tool.radius))


@dataclass(frozen=True)
class RigidBonded:
    """A flat tool stuck to the surface: one vertical and no lateral displacement for the whole disc under it."""

    def check(self, problem: Problem) -> tuple[str, ...]:
        """Only the sharp flat tool is there."""
        edge = problem.tool.edge_radius
        if edge is not None:
            raise FemError(
                f"tool.edge_radius = {edge:g} m: contact 'rigid_bonded' with a rounded edge is not available; "
                "leave edge_radius out for the sharp flat tool"
            )
        return ()

    def resolution(self, problem: Problem) -> Resolution:
        """The edge is singular; at large strain the material turns round it."""
        if problem.kinematics == "linear":
            return SMALL_STRAIN
        return Resolution(edge=1.0 / 60.0, under=1.0 / 3.0, fan=True)

    def conditions(self, mesh: AnyMesh, problem: Problem) -> Conditions:
        """Tie all nodes under the tool."""
        inside = under_tool(mesh, problem.tool.radius)
        return Conditions(inside, inside, _master_load(mesh))


@dataclass(frozen=True)
class RigidFrictionless:
    """Uniform vertical displacement and no shear under the tool, in linear kinematics or under a plate."""

    def check(self, problem: Problem) -> tuple[str, ...]:
        """An edge radius means nothing here."""
        ignored = "tool.edge_radius has no effect on the contact 'rigid_frictionless' in linear kinematics"
        return () if problem.tool.edge_radius is None else (ignored,)

    def resolution(self, problem: Problem) -> Resolution:
        """The edge is singular, but for a plate that goes past the specimen."""
        return SLIDING_PLATE if problem.slides_on_plates else SMALL_STRAIN

    def conditions(self, mesh: AnyMesh, problem: Problem) -> Conditions:
        """Tie the vertical displacement only."""
        return Conditions(_nowhere(mesh), under_tool(mesh, problem.tool.radius), _master_load(mesh))


@dataclass(frozen=True)
class RoundedPunch:
    """Nodes of the surface touch a rigid surface with a rounded edge and come off it, in finite strain."""

    contact: str

    def check(self, problem: Problem) -> tuple[str, ...]:
        """An edge radius, finite strain and, for friction, its coefficient are needed."""
        tool = problem.tool
        if problem.kinematics == "linear":
            raise FemError(f"tool.contact = {self.contact!r}: real contact is for kinematics = 'finite' only")
        if tool.edge_radius is None:
            raise FemError(
                f"tool.edge_radius is missing: contact {self.contact!r} with kinematics = 'finite' needs "
                "a rounded edge (a sharp tied edge loses stability); give edge_radius or use kinematics = 'linear'"
            )
        if tool.adhesion_force > 0.0 and tool.edge_radius >= tool.radius:
            raise FemError(
                f"tool.adhesion_force = {tool.adhesion_force:g} N: needs a flat face: edge_radius below radius"
            )
        return ()

    def resolution(self, problem: Problem) -> Resolution:
        """The edge is resolved over its arc, the tip of a sphere near the axis.

        The border of the touch moves over the arc: elements that were twice as large at its ends, and larger between
        them, left jumps of 0.1 to 0.4 % (rms) of the force over depth, these a half to a third of that.
        """
        tool = problem.tool
        share = (tool.edge_radius or tool.radius) / tool.radius
        if share >= 1.0:
            return SPHERE
        edge = max(share / EDGE_ELEMENTS, FINEST_EDGE)
        return Resolution(edge=edge, under=1.0 / 6.0, gather=tuple(1.0 - share * part for part in ARC))

    def conditions(self, mesh: AnyMesh, problem: Problem) -> Conditions:
        """No tie; the nodes near the tool may touch the punch."""
        tool = problem.tool
        punch, reach = punch_of(tool), REACH * tool.radius
        if isinstance(mesh, Mesh):
            near = mesh.top & (mesh.nodes[:, 0] <= reach)
        else:
            stood = standing(punch, tool.position, tool.tilt)
            x, y, _ = stood.tip
            near = mesh.top & (np.hypot(mesh.nodes[:, 0] - x, mesh.nodes[:, 1] - y) <= reach)
            punch = stood.lowered(mesh.nodes[near].T)
        area = np.where(near, top_areas(mesh), 0.0)
        return Conditions(_nowhere(mesh), _nowhere(mesh), np.zeros(len(mesh.nodes)), punch, area)


@dataclass(frozen=True)
class FrictionlessPunch:
    """Tied in linear kinematics and under a plate, real contact with a rounded edge in finite strain."""

    def check(self, problem: Problem) -> tuple[str, ...]:
        """Finite strain needs a rounded edge."""
        return self._of(problem).check(problem)

    def resolution(self, problem: Problem) -> Resolution:
        """How fine an axisymmetric mesh must be at the tool."""
        return self._of(problem).resolution(problem)

    def conditions(self, mesh: AnyMesh, problem: Problem) -> Conditions:
        """Conditions on the nodes of the mesh."""
        return self._of(problem).conditions(mesh, problem)

    def _of(self, problem: Problem) -> RoundedPunch | RigidFrictionless:
        tied = problem.kinematics == "linear" or problem.slides_on_plates
        return RigidFrictionless() if tied else RoundedPunch("rigid_frictionless")


CONTACT_MODELS: Mapping[str, ContactModel] = MappingProxyType(
    {
        "uniform_pressure": UniformPressure(),
        "rigid_bonded": RigidBonded(),
        "rigid_frictionless": FrictionlessPunch(),
        "rigid_frictional": RoundedPunch("rigid_frictional"),
    }
)


def punch_of(tool: Tool) -> Punch:
    """The tool as a punch that touches; without an edge radius a sphere."""
    friction = tool.friction_coefficient if tool.contact == "rigid_frictional" else 0.0
    return Punch(tool.radius, tool.edge_radius or tool.radius, friction or 0.0, tool.adhesion_force)


def _nowhere(mesh: AnyMesh) -> BoolArray:
    return np.zeros(len(mesh.nodes), dtype=np.bool_)


def _master_load(mesh: AnyMesh) -> FloatArray:
    """The press of 1 N on the tool's displacement, that of the node on the axis."""
    load = np.zeros(len(mesh.nodes))
    load[mesh.interfaces[0][0]] = -1.0
    return load
