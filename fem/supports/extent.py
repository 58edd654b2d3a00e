"""What a support decides about the mesh, and what every support gives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from fem.arrays import BoolArray
from fem.mesh import AnyMesh, Feature
from fem.problem import Problem


@dataclass(frozen=True)
class Extent:
    """How far the mesh reaches and what it must resolve besides the tool.

    Attributes
    ----------
    radius
        Radius of the outer border in m.
    thickness
        Meshed thickness of each layer in m.
    radial
        Features over r; their positions become grid lines.
    vertical
        Features over the depth.
    far
        Distance in m from the tool beyond which only a decaying far field is left.
    edge_factor
        Factor on the size of the fan at the tool's edge.
    """

    radius: float
    thickness: tuple[float, ...]
    radial: tuple[Feature, ...] = ()
    vertical: tuple[Feature, ...] = ()
    far: float = math.inf
    edge_factor: float = 1.0


class SupportModel(Protocol):
    """One kind of support."""

    def extent(self, problem: Problem) -> Extent:
        """How far the mesh reaches."""
        ...

    def fixed(self, mesh: AnyMesh, problem: Problem) -> BoolArray:
        """Nodes (N,) that are held in both directions."""
        ...
