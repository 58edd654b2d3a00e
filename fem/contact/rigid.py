"""Rigid flat tools tied to the surface: one vertical displacement for the whole disc r <= tool radius."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import BoolArray
from fem.contact.conditions import SMALL_STRAIN, Conditions, Resolution, under_tool
from fem.errors import FemError
from fem.mesh import Mesh
from fem.problem import Problem


@dataclass(frozen=True)
class RigidBonded:
    """Stuck to the tool: one vertical and no radial displacement under it."""

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

    def conditions(self, mesh: Mesh, problem: Problem) -> Conditions:
        """Tie all nodes under the tool."""
        inside = under_tool(mesh, problem)
        return _tied(mesh, held=inside, tied=inside)


@dataclass(frozen=True)
class RigidFrictionless:
    """Uniform vertical displacement and no shear under the tool, in linear kinematics only."""

    def check(self, problem: Problem) -> tuple[str, ...]:
        """An edge radius means nothing here."""
        ignored = "tool.edge_radius has no effect on the contact 'rigid_frictionless' in linear kinematics"
        return () if problem.tool.edge_radius is None else (ignored,)

    def resolution(self, problem: Problem) -> Resolution:
        """Linear kinematics only."""
        del problem
        return SMALL_STRAIN

    def conditions(self, mesh: Mesh, problem: Problem) -> Conditions:
        """Tie the vertical displacement only."""
        return _tied(mesh, held=np.zeros(len(mesh.nodes), dtype=np.bool_), tied=under_tool(mesh, problem))


def _tied(mesh: Mesh, held: BoolArray, tied: BoolArray) -> Conditions:
    load = np.zeros(len(mesh.nodes))
    load[mesh.interfaces[0][0]] = -1.0
    return Conditions(held, tied, load)
