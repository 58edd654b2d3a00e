"""A half-space: the last layer is endless.

A far border that is fixed at the distance R takes about a/R of the deflection away, so it stands at 20 000
tool radii or stack thicknesses, reached by geometric grading.
"""

from __future__ import annotations

from dataclasses import dataclass

from fem.arrays import BoolArray
from fem.mesh import AnyMesh
from fem.problem import Problem
from fem.supports.extent import Extent

FAR_BORDER = 2.0e4
FAR_FIELD = 40.0


@dataclass(frozen=True)
class HalfSpace:
    """Lower face and outer border fixed, both very far away."""

    def extent(self, problem: Problem) -> Extent:
        """Border at 20 000 times the larger of tool radius and thickness of the layers above."""
        above = tuple(layer.thickness for layer in problem.layers[:-1])
        unit = max(problem.tool.radius, sum(above))
        border, radius = FAR_BORDER * unit, problem.discretisation.radius
        return Extent(border if radius is None else radius, (*above, border), far=FAR_FIELD * unit)

    def fixed(self, mesh: AnyMesh, problem: Problem) -> BoolArray:
        """Lower face and outer border."""
        del problem
        return mesh.base | mesh.border
