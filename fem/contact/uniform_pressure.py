"""A uniform dead traction on the reference disc r <= tool radius."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray
from fem.contact.conditions import SMALL_STRAIN, Conditions, Resolution
from fem.mesh import Mesh
from fem.problem import Problem


@dataclass(frozen=True)
class UniformPressure:
    """Force spread evenly over the reference disc, always along the axis; no constraint."""

    def check(self, problem: Problem) -> tuple[str, ...]:
        """An edge radius means nothing here."""
        if problem.tool.edge_radius is None:
            return ()
        return ("tool.edge_radius has no effect on the contact 'uniform_pressure'",)

    def resolution(self, problem: Problem) -> Resolution:
        """The edge is only weakly singular, but the surface under the tool bends."""
        return SMALL_STRAIN if problem.kinematics == "linear" else Resolution(edge=1.0 / 25.0, under=1.0 / 6.0)

    def conditions(self, mesh: Mesh, problem: Problem) -> Conditions:
        """Work-equivalent nodal forces of 1 N over the disc."""
        free = np.zeros(len(mesh.nodes), dtype=np.bool_)
        return Conditions(free, free, _disc_load(mesh, problem.tool.radius))


def _disc_load(mesh: Mesh, radius: float) -> FloatArray:
    """Nodal forces -int N 2 r dr / radius^2, (N,), by Simpson's rule, exact for N r with quadratic N."""
    top = mesh.interfaces[0]
    row = top[mesh.nodes[top, 0] <= radius]
    inner, middle, outer = row[:-2:2], row[1:-1:2], row[2::2]
    r0, r1, r2 = (mesh.nodes[n, 0] for n in (inner, middle, outer))
    share = (r2 - r0) / (3.0 * radius**2)
    load = np.zeros(len(mesh.nodes))
    np.add.at(load, inner, -share * r0)
    np.add.at(load, middle, -share * 4.0 * r1)
    np.add.at(load, outer, -share * r2)
    return load
