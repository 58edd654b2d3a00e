"""What a contact tells the solver, and what every contact gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from fem.arrays import BoolArray, FloatArray
from fem.contact.punch import Punch
from fem.mesh import Mesh
from fem.problem import Problem


@dataclass(frozen=True)
class Conditions:
    """Conditions of the contact on the nodes.

    Attributes
    ----------
    held
        Nodes (N,) whose radial displacement is zero.
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
        Growth of the element size from there along the surface, per length.
    """

    edge: float
    under: float
    fan: bool = False
    gather: tuple[float, ...] = (1.0,)
    growth: float = 0.45


SMALL_STRAIN = Resolution(edge=1.0 / 200.0, under=1.0 / 3.0)


class ContactModel(Protocol):
    """One kind of contact."""

    def check(self, problem: Problem) -> tuple[str, ...]:
        """Refuse what this contact cannot do (FemError); return warnings for what it ignores."""
        ...

    def resolution(self, problem: Problem) -> Resolution:
        """How fine the mesh must be at the tool."""
        ...

    def conditions(self, mesh: Mesh, problem: Problem) -> Conditions:
        """Conditions on the nodes of the mesh."""
        ...


def under_tool(mesh: Mesh, problem: Problem) -> BoolArray:
    """Nodes (N,) of the top face with r <= tool radius."""
    return mesh.top & (mesh.nodes[:, 0] <= problem.tool.radius)
