"""A rigid punch with a rounded edge by real contact, with or without friction, in finite strain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray
from fem.contact.conditions import Conditions, Resolution
from fem.contact.punch import Punch
from fem.contact.rigid import RigidFrictionless
from fem.errors import FemError
from fem.mesh import Mesh
from fem.mesh.rows import ring_areas
from fem.parts import Tool
from fem.problem import Problem

REACH = 1.5  # radius in tool radii up to which nodes may touch the punch
EDGE_ELEMENTS = 5.0  # elements over the edge radius where it begins and ends
FINEST_EDGE = 1.0 / 200.0  # element size at a very sharp edge, in tool radii
SPHERE = 1.0 / 200.0  # element size under the tip of a sphere, in tool radii
AXIS_SHARE = 0.1  # area of the node on the axis, which is 0 by Simpson's rule, over its neighbour's


@dataclass(frozen=True)
class RoundedPunch:
    """Nodes of the surface touch a rigid surface and come off it."""

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
        """The edge is resolved over its arc, the tip of a sphere near the axis."""
        tool = problem.tool
        share = (tool.edge_radius or tool.radius) / tool.radius
        if share >= 1.0:
            return Resolution(edge=SPHERE, under=1.0 / 6.0, gather=(0.0,))
        edge = max(share / EDGE_ELEMENTS, FINEST_EDGE)
        return Resolution(edge=edge, under=1.0 / 6.0, gather=(1.0 - share, 1.0))

    def conditions(self, mesh: Mesh, problem: Problem) -> Conditions:
        """No tie; the nodes near the tool may touch the punch."""
        free, reach = np.zeros(len(mesh.nodes), dtype=np.bool_), REACH * problem.tool.radius
        return Conditions(free, free, np.zeros(len(mesh.nodes)), punch_of(problem.tool), _areas(mesh, reach))


@dataclass(frozen=True)
class FrictionlessPunch:
    """Tied and sharp in linear kinematics, real contact with a rounded edge in finite strain."""

    def check(self, problem: Problem) -> tuple[str, ...]:
        """Finite strain needs a rounded edge."""
        return self._of(problem).check(problem)

    def resolution(self, problem: Problem) -> Resolution:
        """How fine the mesh must be at the tool."""
        return self._of(problem).resolution(problem)

    def conditions(self, mesh: Mesh, problem: Problem) -> Conditions:
        """Conditions on the nodes of the mesh."""
        return self._of(problem).conditions(mesh, problem)

    def _of(self, problem: Problem) -> RoundedPunch | RigidFrictionless:
        return RigidFrictionless() if problem.kinematics == "linear" else RoundedPunch("rigid_frictionless")


def punch_of(tool: Tool) -> Punch:
    """The tool as a punch that touches; without an edge radius a sphere."""
    friction = tool.friction_coefficient if tool.contact == "rigid_frictional" else 0.0
    return Punch(tool.radius, tool.edge_radius or tool.radius, friction or 0.0, tool.adhesion_force)


def _areas(mesh: Mesh, reach: float) -> FloatArray:
    """Area (N,) in m2 of each node of the top face up to a radius in m, by Simpson's rule; 0 elsewhere."""
    top = mesh.interfaces[0]
    r = mesh.nodes[top, 0]
    area = ring_areas(r)
    area[0] = AXIS_SHARE * area[1]
    out = np.zeros(len(mesh.nodes))
    out[top[r <= reach]] = area[r <= reach]
    return out
