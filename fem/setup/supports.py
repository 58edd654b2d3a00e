"""The supports: how far the mesh reaches and what it must resolve, and which nodes are held."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

from fem.arrays import BoolArray
from fem.errors import FemError
from fem.mesh.fan import Fan
from fem.mesh.grading import Feature
from fem.mesh.solid import AnyMesh
from fem.problem.problem import Problem

BORDER_IN_DECAY_LENGTHS = 6.0
FAR_BORDER = (
    2.0e4  # in tool radii or stack thicknesses: fixed at the distance R it takes about a/R of the deflection away
)
FAR_FIELD = 40.0  # in the same, from where the mesh grows geometrically
# A sheet bends: the tool's edge weighs little, but the press goes several thicknesses deep.
EDGE_FACTOR = 1.5
CORNER_RINGS = (1.0, 0.5, 0.25)  # of the fans where a clamped edge meets the faces
PLATE_CORNER = 16.0  # elements over the radius or height of a cylinder, whichever is less, at its corners
SLIDING_RIM = 0.33  # size of the elements at a rim on which a sheet slides, over the usual one; it has no fan


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
    square_root
        Whether the fan at the tool's edge holds the square root of the distance: below a sheet that gives way the
        region of large strain is smaller than its elements, on a rigid base soon larger, where elements that hold it
        snap one after another.
    fans
        Fans of elements that are wanted besides that at the tool's edge.
    """

    radius: float
    thickness: tuple[float, ...]
    radial: tuple[Feature, ...] = ()
    vertical: tuple[Feature, ...] = ()
    far: float = math.inf
    edge_factor: float = 1.0
    square_root: bool = False
    fans: tuple[Fan, ...] = ()


class SupportModel(Protocol):
    """One kind of support."""

    def extent(self, problem: Problem) -> Extent:
        """How far the mesh reaches."""
        ...

    def fixed(self, mesh: AnyMesh, problem: Problem) -> BoolArray:
        """Nodes (N,) that are held in both directions."""
        ...


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


@dataclass(frozen=True)
class Hole:
    """Lower face fixed for r >= hole_radius, outer border fixed; a clamp at the rim is the outer border alone."""

    def extent(self, problem: Problem) -> Extent:
        """Border several decay lengths outside the hole, or at its rim; the rim of the hole is resolved."""
        hole, thickness = hole_radius(problem), tuple(layer.thickness for layer in problem.layers)
        total = sum(thickness)
        radius = problem.discretisation.radius
        if radius is None:
            radius = max(hole, problem.tool.radius) + BORDER_IN_DECAY_LENGTHS * decay_length(problem)
        size = min(total, hole) / 8.0
        fans: tuple[Fan, ...] = ()
        if problem.support.clamp == "rim":
            radius = hole
            fans = _corner_fans(hole, size, thickness)
        elif problem.support.clamp_shear_limit is None:
            fans = (Fan(hole, min(size, thickness[-1]), (1.0,), depth=total, square_root=True),)
        smaller = 1.0 if fans else SLIDING_RIM
        rim = Feature(hole, smaller * size, 0.4)
        underside = Feature(total, 2.0 * smaller * size, 0.5)
        return Extent(radius, thickness, (rim,), (underside,), edge_factor=EDGE_FACTOR, square_root=True, fans=fans)

    def fixed(self, mesh: AnyMesh, problem: Problem) -> BoolArray:
        """Lower face outside the hole, rim included, and the outer border."""
        return on_the_plate(mesh, problem) | mesh.border


@dataclass(frozen=True)
class Plates:
    """The lower face held vertically, and along the plate where it sticks; the border is the specimen's free side."""

    def extent(self, problem: Problem) -> Extent:
        """The specimen itself; the corners of faces that stick are resolved."""
        radius, thickness = problem.support.specimen_radius or 0.0, tuple(layer.thickness for layer in problem.layers)
        if problem.slides_on_plates:
            return Extent(radius, thickness)
        size, total = min(sum(thickness), radius) / PLATE_CORNER, sum(thickness)
        corner, faces = Feature(radius, size, 0.4), (Feature(0.0, size, 0.5), Feature(total, size, 0.5))
        return Extent(radius, thickness, (corner,), faces, fans=_corner_fans(radius, size, thickness))

    def fixed(self, mesh: AnyMesh, problem: Problem) -> BoolArray:
        """Lower face; a cylinder that slides leaves it along the plate."""
        del problem
        return mesh.base


def _corner_fans(radius: float, size: float, thickness: tuple[float, ...]) -> tuple[Fan, ...]:
    """Fans where a held edge or face meets the border, above and below."""
    return (
        Fan(radius, min(size, thickness[0]), CORNER_RINGS),
        Fan(radius, min(size, thickness[-1]), CORNER_RINGS, depth=sum(thickness)),
    )


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


SUPPORT_MODELS: Mapping[str, SupportModel] = MappingProxyType(
    {"bonded": Bonded(), "hole": Hole(), "half_space": HalfSpace(), "plates": Plates()}
)
