"""Where the mesh of a problem has its grid lines.

Radially the lines gather at the tool's edge and at what the support names; vertically they gather at the
top face. The stress is singular at the edge of a stuck tool and where a clamp begins: the element size there sets
the accuracy. In linear kinematics the edge elements may be tiny. In finite strain they fold under a tool stuck to a
thick soft layer, where the material turns round the edge: there they form a fan whose rings become smaller towards the
edge, as few as a deep press bears. Over a hole it holds the square root of the distance, as that at the rim does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fem.arrays import FloatArray
from fem.mesh.fan import Fan
from fem.mesh.grading import Feature, Sizing, every_second, graded_line
from fem.mesh.quads import Mesh, build_mesh
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
# Each half as large as the one round it. With a fourth a tool no longer goes 7 mm into soft 15 mm; in a ring that holds
# the square root of the distance the next node is half as far away.
TOOL_RINGS, SQUARE_ROOT_RINGS = 3, 2
FEWER_RINGS = 2.0  # up to this factor on the size at the edge the fan has fewer rings, beyond it is larger


def lay_out(problem: Problem) -> Mesh:
    """Mesh of a problem whose contact is available."""
    return _layout(problem).mesh()


def tool_fan(problem: Problem) -> Fan | None:
    """The fan of elements round the tool's edge; None without one."""
    return _layout(problem).tool_fan if problem.geometry == "axisymmetric" else None


def holds_edge(problem: Problem) -> bool:
    """Whether a fan of elements round the tool's edge holds the square root of the distance from it."""
    fan = tool_fan(problem)
    return fan is not None and fan.square_root


def _layout(problem: Problem) -> _Layout:
    return _Layout(
        radius=problem.support.specimen_radius or problem.tool.radius,
        extent=SUPPORT_MODELS[problem.support.kind].extent(problem),
        resolution=CONTACT_MODELS[problem.tool.contact].resolution(problem),
        density=DENSITY[problem.discretisation.density],
        edge=problem.discretisation.edge,
        halved=problem.discretisation.halved,
    )


@dataclass(frozen=True)
class _Layout:
    """Pressed radius (m), extent, resolution at the tool, density, factor on the size at an edge, halved or not."""

    radius: float
    extent: Extent
    resolution: Resolution
    density: float
    edge: float
    halved: bool

    def mesh(self) -> Mesh:
        tool = self.tool_fan
        fans = self._support_fans(tool)
        r_lines = self._radial_lines(tool, fans)
        return build_mesh(
            r_lines, self._depth_lines(tool, fans), self._depths[:-1], fans if tool is None else (tool, *fans)
        )

    @property
    def _depths(self) -> FloatArray:
        return np.concatenate(([0.0], np.cumsum(self.extent.thickness)))

    @property
    def _covered(self) -> bool:
        """Whether the tool is a plate that covers the face and has no edge on it."""
        return self.radius >= self.extent.radius

    @property
    def _fan_element(self) -> float:
        """Size of the outer elements of the tool's fan in m."""
        factor = self.extent.edge_factor * max(self.edge / FEWER_RINGS, 1.0)
        return FAN_ELEMENT * min(factor, LARGEST_FAN) * self.radius

    @property
    def tool_fan(self) -> Fan | None:
        """The fan at the tool's edge; None where the edge needs none or there is no room."""
        first = self.extent.thickness[0]
        wanted = self._fan_element * FAN_HALF_WIDTH / FAN_ELEMENT
        half_width = first if first < 2.0 * wanted else wanted
        in_the_way = any(abs(f.position - self.radius) <= 2.0 * half_width for f in self.extent.radial)
        room = self.extent.radius > self.radius + half_width and first >= FAN_LEAST_LAYER * self.radius
        if not self.resolution.fan or not room or in_the_way:
            return None
        fewer = round(math.log2(min(self.edge, FEWER_RINGS)))
        root = self.extent.square_root
        rings = self._rings((SQUARE_ROOT_RINGS if root else TOOL_RINGS) - fewer)
        return Fan(self.radius, half_width, rings, square_root=root)

    def _support_fans(self, tool: Fan | None) -> tuple[Fan, ...]:
        """The fans of the support for which there is room; on the upper face they are as high as the tool's."""
        box = 0.0 if tool is None else tool.half_width
        found = []
        for fan in self.extent.fans:
            half_width = box if box and fan.depth == 0.0 else fan.half_width * self._coarsening(fan)
            fewer = round(math.log2(self.edge)) if self._covered else 0
            fitted = replace(fan, half_width=half_width, rings=self._rings(len(fan.rings) - fewer))
            if self._has_room(fitted, box):
                found.append(fitted)
        return tuple(found)

    def _coarsening(self, fan: Fan) -> float:
        """A fan of few rings is made coarser by its size."""
        return 2.0 if self.halved and len(fan.rings) == 1 and 2.0 * fan.half_width <= self.extent.thickness[-1] else 1.0

    def _has_room(self, fan: Fan, box: float) -> bool:
        """Whether a fan is clear of the tool's, whose half width is told, and of axis and border, or at the border."""
        clear = (self._covered or abs(fan.radius - self.radius) > fan.half_width + box) and fan.radius > fan.half_width
        inside = fan.radius + fan.half_width < self.extent.radius or fan.radius == self.extent.radius
        return clear and inside and (fan.depth == 0.0 or fan.depth - fan.half_width > box)

    def _rings(self, usual: int) -> tuple[float, ...]:
        """Ring sizes from 1 down to the collapsed ring: the usual number by default, one more when fine."""
        count = max(1, usual + round(math.log2(self.density)) - self.halved)
        return tuple(0.5**k for k in range(count))

    def _radial_lines(self, tool: Fan | None, fans: tuple[Fan, ...]) -> FloatArray:
        sides = [fan.radius + side * fan.half_width for fan in fans for side in (-1.0, 1.0)]
        places = {0.0, self.extent.radius, *(f.position for f in self.extent.radial)}
        places |= {side for side in sides if side < self.extent.radius}
        if tool is None:
            edge = self.resolution.edge * self.radius
            return self._lines(places | {self.radius}, self._radial(self.radius, edge))
        count, size = self._pieces(tool)
        inner, outer = tool.radius - tool.half_width, tool.radius + tool.half_width
        left = self._lines({inner, *(at for at in places if at < inner)}, self._radial(inner, size))
        right = self._lines({outer, *(at for at in places if at > outer)}, self._radial(outer, size))
        return np.concatenate((left[:-1], np.linspace(inner, outer, 2 * count + 1)[:-1], right))

    def _depth_lines(self, tool: Fan | None, fans: tuple[Fan, ...]) -> FloatArray:
        first, last = self.extent.thickness[0], self.extent.thickness[-1]
        levels = set(self._depths.tolist())
        levels |= {fan.half_width for fan in fans if fan.depth == 0.0 and fan.half_width < first}
        levels |= {fan.depth - fan.half_width for fan in fans if fan.depth > 0.0 and fan.half_width < last}
        if tool is None:
            return self._lines(levels, self._vertical(0.0, self.resolution.edge * self.radius))
        count, size = self._pieces(tool)
        below = {tool.half_width, *(level for level in levels if level > tool.half_width * (1.0 + 1e-9))}
        box = np.linspace(0.0, tool.half_width, count + 1)[:-1]
        return np.concatenate((box, self._lines(below, self._vertical(tool.half_width, size))))

    def _pieces(self, tool: Fan) -> tuple[int, float]:
        """Elements over the half width of the tool's fan, and their usual size in m."""
        pieces = max(1, round(tool.half_width / self._fan_element))
        count = max(1, round(pieces * self.density))
        return max(1, count // 2) if self.halved else count, tool.half_width / pieces

    def _lines(self, breaks: set[float], sizing: Sizing) -> FloatArray:
        places = tuple(sorted(breaks))
        lines = graded_line(places, sizing, self.density)
        return every_second(lines, places) if self.halved else lines

    def _radial(self, position: float, size: float) -> Sizing:
        places = [position + (share - 1.0) * self.radius for share in self.resolution.gather]
        growth, far = self.resolution.growth, self.extent.far
        edges = [Feature(place, size, growth, far, near=max(self.radius - place, 0.0)) for place in places]
        under = (self.radius, self.resolution.under * self.radius)
        return Sizing((*edges, *self.extent.radial), (under,))

    def _vertical(self, position: float, size: float) -> Sizing:
        return Sizing((Feature(position, size, VERTICAL_GROWTH, self.extent.far), *self.extent.vertical))
