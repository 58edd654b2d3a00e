"""Where the three-dimensional block of a problem has its grid lines.

Radially and vertically as in :mod:`fem.layout`, but coarser at the tool's edge: unknowns cost more in three
dimensions, and round the tool few elements are enough.
"""

from __future__ import annotations

import numpy as np

from fem.arrays import FloatArray
from fem.assembly.solid_element import SOLID_ELEMENTS
from fem.errors import FemError
from fem.mesh import DiscGrid, Feature, Sizing, SolidMesh, build_block, graded_line
from fem.problem import Problem
from fem.supports import SUPPORT_MODELS, Extent

ELEMENT = "hex27"
PIECES = {"coarse": 2, "default": 2, "fine": 3}
DENSITY = {"coarse": 0.7, "default": 1.0, "fine": 1.5}
EDGE = 0.04  # element size at the tool's edge, in tool radii
RADIAL_GROWTH = 0.7
VERTICAL_GROWTH = 0.7
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
    density = DENSITY[problem.discretisation.density]
    edge = EDGE * problem.tool.radius
    depths = np.concatenate(([0.0], np.cumsum(extent.thickness)))
    vertical = Sizing((Feature(0.0, edge, VERTICAL_GROWTH, extent.far), *extent.vertical))
    depth_lines = graded_line(tuple(depths), vertical, density)
    grid = _grid(problem, extent, edge, density)
    return build_block(grid, depth_lines, depths[:-1], SOLID_ELEMENTS[ELEMENT].node_places, ELEMENT)


def _grid(problem: Problem, extent: Extent, edge: float, density: float) -> DiscGrid:
    radius, (x, _) = problem.tool.radius, problem.tool.position
    rims = [f.position for f in extent.radial]
    _require_room(problem, rims, extent.radius)
    return DiscGrid(
        rings=_rings(radius, rims, extent, edge, density),
        pieces=PIECES[problem.discretisation.density],
        quarters=1 if x == 0.0 and problem.tool.tilt == 0.0 else 2,
        centre=x,
        tool_radius=radius,
        centred_from=min([rim for rim in rims if rim > radius], default=extent.radius),
        round_to=max([radius, *rims]),
    )


def _rings(radius: float, rims: list[float], extent: Extent, edge: float, density: float) -> FloatArray:
    inner = INNER_SQUARE * min([radius, *rims])
    features = (Feature(radius, edge, RADIAL_GROWTH, extent.far), *extent.radial)
    breaks = sorted({inner, radius, extent.radius, *rims})
    lines = graded_line(tuple(breaks), Sizing(features), density)
    kept: FloatArray = lines[(lines == inner) | (lines >= THICKEST_RING * inner)]
    return kept


def _require_room(problem: Problem, rims: list[float], border: float) -> None:
    radius, (x, _) = problem.tool.radius, problem.tool.position
    limits = [(border, "the border of the block"), *((rim, "the rim of the hole") for rim in rims)]
    for limit, what in limits:
        if x != 0.0 and abs(x) + radius >= limit:
            raise FemError(
                f"tool.position = ({x:g}, 0) m with tool.radius = {radius:g} m: reaches {what} at {limit:g} m; "
                "an off-centre tool must lie inside it"
            )
