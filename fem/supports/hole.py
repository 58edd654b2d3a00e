"""A sheet clamped round a hole: lower face fixed outside the hole, free inside."""

from __future__ import annotations

from dataclasses import dataclass

from fem.arrays import BoolArray
from fem.errors import FemError
from fem.mesh import AnyMesh, Feature
from fem.problem import Problem
from fem.supports.extent import Extent

CLAMP_IN_THICKNESSES = 4.0
# A sheet bends: the tool's edge weighs little, but the press goes several thicknesses deep.
EDGE_FACTOR = 1.5


@dataclass(frozen=True)
class Hole:
    """Lower face fixed for r >= hole_radius, outer border fixed."""

    def extent(self, problem: Problem) -> Extent:
        """Border several thicknesses outside the hole; the rim of the hole is resolved."""
        hole, thickness = hole_radius(problem), tuple(layer.thickness for layer in problem.layers)
        total = sum(thickness)
        radius = problem.discretisation.radius
        if radius is None:
            radius = max(hole, problem.tool.radius) + CLAMP_IN_THICKNESSES * total
        size = min(total, hole) / 8.0
        rim = Feature(hole, size, 0.4)
        underside = Feature(total, 2.0 * size, 0.5)
        return Extent(radius, thickness, (rim,), (underside,), edge_factor=EDGE_FACTOR)

    def fixed(self, mesh: AnyMesh, problem: Problem) -> BoolArray:
        """Lower face outside the hole, rim included, and the outer border."""
        return on_the_plate(mesh, problem) | mesh.border


def on_the_plate(mesh: AnyMesh, problem: Problem) -> BoolArray:
    """Nodes (N,) of the lower face outside the hole, rim included."""
    return mesh.base & (mesh.specimen_distance >= hole_radius(problem) * (1.0 - 1e-9))


def hole_radius(problem: Problem) -> float:
    """Radius of the hole in m.

    Raises
    ------
    FemError
        If the support has none.
    """
    radius = problem.support.hole_radius
    if radius is None:
        raise FemError("support.hole_radius is missing: needed for the support 'hole'")
    return radius
