"""A laterally endless specimen bonded to a rigid base."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fem.arrays import BoolArray
from fem.mesh import AnyMesh
from fem.problem import Problem
from fem.supports.extent import Extent

BORDER_IN_DECAY_LENGTHS = 6.0


def decay_length(problem: Problem) -> float:
    """Length in m over which the pressed surface of a bonded stack goes back to rest.

    A single layer decays over about its thickness. A stiff skin spreads the in-plane pull of the tool over
    sqrt(H sum(G_i h_i) / G), G the modulus of the softest layer and H the whole thickness (shear-lag theory).
    """
    total = sum(layer.thickness for layer in problem.layers)
    softest = min(layer.material.shear_modulus for layer in problem.layers)
    pull = sum(layer.material.shear_modulus * layer.thickness for layer in problem.layers)
    return math.sqrt(total * pull / softest)


@dataclass(frozen=True)
class Bonded:
    """Lower face and outer border fixed; the border is so far away that it costs at most 0.1 %."""

    def extent(self, problem: Problem) -> Extent:
        """Border at the prescribed radius, or several decay lengths outside the tool, wherever it stands."""
        radius = problem.discretisation.radius
        if radius is None:
            reach = abs(problem.tool.position[0]) + 2.0 * problem.tool.radius
            radius = reach + BORDER_IN_DECAY_LENGTHS * decay_length(problem)
        return Extent(radius, tuple(layer.thickness for layer in problem.layers))

    def fixed(self, mesh: AnyMesh, problem: Problem) -> BoolArray:
        """Lower face and outer border."""
        del problem
        return mesh.base | mesh.border
