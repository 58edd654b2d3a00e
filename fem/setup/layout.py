"""Where the mesh of a problem has its grid lines.

Radially the lines gather at the tool's edge and at what the support names; vertically they gather at the
top face. The edge stress is singular, so its element size sets the accuracy. In linear kinematics the edge
elements may be tiny. In finite strain they would fold, so they are larger, and under a tool stuck to a thick
soft layer, where the material turns round the edge, they form a fan.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray
from fem.mesh.grading import Feature, Sizing, graded_line
from fem.mesh.quads import Fan, Mesh, build_mesh
from fem.problem.problem import Problem
from fem.setup.contacts import CONTACT_MODELS, Resolution
from fem.setup.supports import SUPPORT_MODELS, Extent

DENSITY = {"coarse": 0.6, "default": 1.0, "fine": 2.0}
VERTICAL_GROWTH = 0.5
# In tool radii: size of the fan's box and of its outer elements, and the thinnest first layer it fits into.
FAN_HALF_WIDTH = 0.1
FAN_ELEMENT = 0.05
FAN_LEAST_LAYER = 0.06
LARGEST_FAN = 4.0  # times the usual one; a larger one would come near the axis


def lay_out(problem: Problem) -> Mesh:
    """Mesh of a problem whose contact is available."""
    return _Layout(
        radius=problem.tool.radius,
        extent=SUPPORT_MODELS[problem.support.kind].extent(problem),
        resolution=CONTACT_MODELS[problem.tool.contact].resolution(problem),
        density=DENSITY[problem.discretisation.density],
        edge=problem.discretisation.edge,
    ).mesh()


@dataclass(frozen=True)
class _Layout:
    """Tool radius (m), extent, resolution at the tool, density, and factor on the size of the fan."""

    radius: float
    extent: Extent
    resolution: Resolution
    density: float
    edge: float

    def mesh(self) -> Mesh:
        half_width = self._fan_half_width()
        return self._graded() if half_width is None else self._fanned(half_width)

    @property
    def _depths(self) -> FloatArray:
        return np.concatenate(([0.0], np.cumsum(self.extent.thickness)))

    @property
    def _fan_factor(self) -> float:
        return min(self.extent.edge_factor * self.edge, LARGEST_FAN)

    def _graded(self) -> Mesh:
        edge = self.resolution.edge * self.radius
        breaks = {0.0, self.radius, self.extent.radius, *(f.position for f in self.extent.radial)}
        r_lines = graded_line(tuple(sorted(breaks)), self._radial(self.radius, edge), self.density)
        depth_lines = graded_line(tuple(self._depths), self._vertical(0.0, edge), self.density)
        return build_mesh(r_lines, depth_lines, self._depths[:-1])

    def _fan_half_width(self) -> float | None:
        """Half width of the fan in m, or None where the edge needs none or there is no room."""
        first = self.extent.thickness[0]
        wanted = FAN_HALF_WIDTH * self._fan_factor * self.radius
        half_width = first if first < 2.0 * wanted else wanted
        in_the_way = any(abs(f.position - self.radius) <= 2.0 * half_width for f in self.extent.radial)
        room = self.extent.radius > self.radius + half_width and first >= FAN_LEAST_LAYER * self.radius
        return half_width if self.resolution.fan and room and not in_the_way else None

    def _fanned(self, half_width: float) -> Mesh:
        element = FAN_ELEMENT * self._fan_factor * self.radius
        pieces = max(1, round(half_width / element))
        count = max(1, round(pieces * self.density))
        fan = Fan(self.radius, half_width, _rings(self.density))
        r_lines = self._lines_round_the_box(half_width, half_width / pieces, count)
        below = (half_width, *self._depths[self._depths > half_width * (1.0 + 1e-9)])
        sizing = self._vertical(half_width, half_width / pieces)
        box = np.linspace(0.0, half_width, count + 1)[:-1]
        depth_lines = np.concatenate((box, graded_line(below, sizing, self.density)))
        return build_mesh(r_lines, depth_lines, self._depths[:-1], fan)

    def _lines_round_the_box(self, half_width: float, size: float, count: int) -> FloatArray:
        inner, outer = self.radius - half_width, self.radius + half_width
        named = [f.position for f in self.extent.radial]
        within = tuple(sorted({0.0, inner, *(at for at in named if at < inner)}))
        beyond = tuple(sorted({outer, self.extent.radius, *(at for at in named if at > outer)}))
        left = graded_line(within, self._radial(inner, size), self.density)
        right = graded_line(beyond, self._radial(outer, size), self.density)
        return np.concatenate((left[:-1], np.linspace(inner, outer, 2 * count + 1)[:-1], right))

    def _radial(self, position: float, size: float) -> Sizing:
        places = [position + (share - 1.0) * self.radius for share in self.resolution.gather]
        edges = [Feature(place, size, self.resolution.growth, self.extent.far) for place in places]
        under = (self.radius, self.resolution.under * self.radius)
        return Sizing((*edges, *self.extent.radial), (under,))

    def _vertical(self, position: float, size: float) -> Sizing:
        return Sizing((Feature(position, size, VERTICAL_GROWTH, self.extent.far), *self.extent.vertical))


def _rings(density: float) -> tuple[float, ...]:
    """Ring sizes from 1 down to the collapsed ring: (1, 0.5) by default, twice as many when fine."""
    count = max(1, round(2.0 * density))
    return tuple(float(1.0 - k / count) for k in range(count))
