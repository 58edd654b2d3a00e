"""Where the three-dimensional block of a problem has its grid lines.

Radially and vertically as in :mod:`fem.setup.layout`, but coarser at the tool's edge: unknowns cost more in three
dimensions, and round the tool few elements are enough. Under a tool that touches the lines gather where its rounded
edge begins and ends, under a sphere at the axis.

The mesh with half as many elements leaves out every second ring and row, but at the rim of a hole and at a stuck edge,
which set the error, only if `discretisation.edge` is 2. Round the axis it has as many: an odd number there has no half,
and with half of an even one the circles themselves would be others, which has nothing to do with that error.

The mesh of a body bounded by a surface is made by :mod:`fem.mesh.surface.specimen`.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from fem.arrays import FloatArray
from fem.assembly.solid import SOLID_ELEMENTS
from fem.errors import FemError
from fem.mesh.grading import Feature, Sizing, every_second, graded_line
from fem.mesh.solid import DiscGrid, SolidMesh, build_block
from fem.mesh.surface.specimen import build_surface_mesh
from fem.mesh.surface.surface_file import Surface
from fem.mesh.surface.surface_mesh import SurfaceMesh
from fem.problem.problem import Problem
from fem.setup.contacts import CONTACT_MODELS, Resolution
from fem.setup.supports import SUPPORT_MODELS, Extent

ELEMENT = "hex27"
PIECES = {"coarse": 2, "default": 2, "fine": 3}
DENSITY = {"coarse": 0.7, "default": 1.0, "fine": 1.5}
TIED = Resolution(edge=0.04, under=1.0, growth=0.7)
FINEST_EDGE, COARSEST_EDGE = 0.01, 0.05  # element size at the edge of a tool that touches, in tool radii
UNDER, GROWTH = 1.0 / 12.0, 0.45  # largest element under a tool that touches, in tool radii, and growth from the edge
VERTICAL_GROWTH = 0.7
HALVED_TOO = 2.0  # factor on the size at an edge from which on half as many elements are half as many there as well
INNER_SQUARE = 0.45  # half side over the radius of the innermost circle that is asked for
THICKEST_RING = 1.4  # radius of the first circle over the half side, at least


def lay_out_block(problem: Problem) -> SolidMesh:
    """Mesh of a problem with `geometry` "block".

    Raises
    ------
    FemError
        If the tool does not fit.
    """
    extent = SUPPORT_MODELS[problem.support.kind].extent(problem)
    resolution = _resolution(problem)
    density = DENSITY[problem.discretisation.density]
    depths = np.concatenate(([0.0], np.cumsum(extent.thickness)))
    edge = resolution.edge * problem.tool.radius
    vertical = Sizing((Feature(0.0, edge, VERTICAL_GROWTH, extent.far), *extent.vertical))
    depth_lines = graded_line(tuple(depths), vertical, density)
    if problem.discretisation.halved:
        depth_lines = every_second(
            depth_lines, tuple(depths), _kept(problem, 0.0, [f.position for f in extent.vertical])
        )
    grid = _grid(problem, extent, resolution, density)
    return build_block(grid, depth_lines, depths[:-1], SOLID_ELEMENTS[ELEMENT].node_places, ELEMENT)


def _resolution(problem: Problem) -> Resolution:
    """How fine the mesh must be at the tool."""
    tool = problem.tool
    if not problem.touches:
        return TIED
    wanted = CONTACT_MODELS[tool.contact].resolution(problem)
    return replace(wanted, edge=min(max(wanted.edge, FINEST_EDGE), COARSEST_EDGE), under=UNDER, growth=GROWTH)


def _grid(problem: Problem, extent: Extent, resolution: Resolution, density: float) -> DiscGrid:
    radius, (x, _) = problem.tool.radius, problem.tool.position
    rims = [f.position for f in extent.radial]
    _require_room(problem, rims, extent.radius)
    pieces = PIECES[problem.discretisation.density]
    smallest = pieces * resolution.edge / INNER_SQUARE
    inner = INNER_SQUARE * min([*rims, *(max(place, smallest) * radius for place in resolution.gather)])
    return DiscGrid(
        rings=_rings(problem, inner, extent, resolution, density),
        pieces=pieces,
        quarters=1 if x == 0.0 and problem.tool.tilt == 0.0 else 2,
        centre=x,
        tool_radius=radius,
        centred_from=min([rim for rim in rims if rim > radius], default=extent.radius),
        round_to=max([radius, *rims]),
    )


def _rings(problem: Problem, inner: float, extent: Extent, resolution: Resolution, density: float) -> FloatArray:
    radius, rims = problem.tool.radius, [f.position for f in extent.radial]
    size = resolution.edge * radius
    edges = [Feature(place * radius, size, resolution.growth, extent.far) for place in resolution.gather]
    sizing = Sizing((*edges, *extent.radial), ((radius, resolution.under * radius),))
    breaks = tuple(sorted({inner, radius, extent.radius, *rims}))
    lines = graded_line(breaks, sizing, density)
    kept: FloatArray = lines[(lines == inner) | (lines >= THICKEST_RING * inner)]
    return every_second(kept, breaks, _kept(problem, radius, rims)) if problem.discretisation.halved else kept


def _kept(problem: Problem, edge: float, rims: list[float]) -> tuple[float, ...]:
    """Where a mesh with half as many elements has small ones: at the edge of a stuck tool and at the rim of a hole."""
    if problem.discretisation.edge >= HALVED_TOO:
        return ()
    return (*([edge] if problem.is_stuck else []), *rims)


def _require_room(problem: Problem, rims: list[float], border: float) -> None:
    radius, (x, _) = problem.tool.radius, problem.tool.position
    limits = [(border, "the border of the block"), *((rim, "the rim of the hole") for rim in rims)]
    for limit, what in limits:
        if x != 0.0 and abs(x) + radius >= limit:
            raise FemError(
                f"tool.position = ({x:g}, 0) m with tool.radius = {radius:g} m: reaches {what} at {limit:g} m; "
                "an off-centre tool must lie inside it"
            )


def lay_out_surface(problem: Problem, surface: Surface, keep: Path | None = None) -> SurfaceMesh:
    """Mesh of a problem with `geometry` "surface" (see :func:`fem.mesh.surface.specimen.build_surface_mesh`)."""
    thickness = tuple(layer.thickness for layer in problem.layers)
    tool = (*problem.tool.position, problem.tool.radius)
    return build_surface_mesh(surface, thickness, tool, DENSITY[problem.discretisation.density], keep)
