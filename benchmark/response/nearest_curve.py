"""Force over depth where the finite elements do not cover a set-up, or stop: as told, then on by the nearest tools.

A touching tool folds the elements at its edge; a rounder edge, or a surface that sticks to it, is followed deeper.
Each tool takes over where the one before it stops, with its growth over depth and not with its own size.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from scipy.interpolate import PchipInterpolator

from benchmark.errors import SolverError, TissuebenchError
from benchmark.files import Tool
from benchmark.files.tool import TOUCHING
from benchmark.models import UncoveredError
from benchmark.response.force_curve import Array
from benchmark.response.ramp import Ramp

EDGES = (0.25, 0.5, 1.0)
"""Edge radii that are tried, over the tool's radius; the last is a sphere's."""
LEAST_STEPS = 2
"""A ramp of fewer steps is no curve."""
BEYOND_POINTS = 24
"""Points by which a curve is continued."""
POWERS = (1.0, 8.0)
"""Range of the power of the depth with which a force is continued."""

RampOf: TypeAlias = Callable[[Tool], Ramp]
"""The ramp under a tool to the depth asked for; raises UncoveredError or TissuebenchError where there is none."""


@dataclass(frozen=True, eq=False)
class NearestCurve:
    """Force over depth, put together from ramps under the tool as told and the nearest ones.

    Attributes
    ----------
    depth, force : (k,) array
        m and N, from 0 up.
    followed : tuple of (Tool, Ramp)
        Every tool that was tried and is covered, the one told first, with its own ramp.
    tried : tuple of str
        Each tool that does not reach the depth asked for, how deep it comes, and why no deeper.
    used : tuple of str
        Each other tool by whose growth the curve goes on, and to what depth.
    """

    depth: Array
    force: Array
    followed: tuple[tuple[Tool, Ramp], ...] = ()
    tried: tuple[str, ...] = ()
    used: tuple[str, ...] = ()

    @property
    def reach(self) -> float:
        """Deepest point, m."""
        return float(self.depth[-1])

    def under(self, tool: Tool) -> Ramp | None:
        """The ramp under one tool; None where it is not covered or was not tried."""
        return next((ramp for other, ramp in self.followed if other == tool), None)

    def remark(self, depth: float) -> str:
        """What a reader must know of a curve that was asked for to a `depth`, m; empty where it is as told."""
        if not self.tried:
            return ""
        text = f"the finite elements do not follow the press to {1e3 * depth:.3g} mm: {'; '.join(self.tried)}"
        return f"{text}; the force goes on with the growth of {' and of '.join(self.used)}" if self.used else text


def nearest_curve(tool: Tool, ramp_of: RampOf) -> NearestCurve:
    """Follow a press under the tool as told, and where that stops under the nearest tools, until one comes to its end.

    Raises
    ------
    SolverError
        No tool is followed for two steps; says what became of each.
    """
    found = NearestCurve(np.zeros(1), np.zeros(1))
    for other in nearest_tools(tool):
        name = tool_name(other, tool)
        try:
            ramp = ramp_of(other)
        except (UncoveredError, TissuebenchError) as error:
            found = replace(found, tried=(*found.tried, f"{name} is not covered ({error})"))
            continue
        found = replace(found, followed=(*found.followed, (other, ramp)))
        found = _joined(found, ramp, name, as_told=other is tool)
        if ramp.failure is None:
            break
    if found.depth.size <= LEAST_STEPS:
        raise SolverError(found.remark(0.0).replace("to 0 mm", "at all"))
    return found


def nearest_tools(tool: Tool) -> Iterator[Tool]:
    """The tool as told, upright and centred, with rounder edges up to a sphere's, and stuck to the surface."""
    yield tool
    plain = tool.model_copy(update={"position": (0.0, 0.0), "tilt": 0.0})
    if plain != tool:
        yield plain
    if tool.contact in TOUCHING:
        for edge in EDGES:
            if edge * tool.radius > 1.001 * (tool.edge_radius or 0.0):
                yield plain.model_copy(update={"edge_radius": edge * tool.radius})
    stuck = stuck_tool(plain)
    if stuck != plain:
        yield stuck


def stuck_tool(tool: Tool) -> Tool:
    """The tool with the surface stuck to a flat end, which every model covers."""
    return tool.model_copy(update={"contact": "rigid_bonded", "edge_radius": None})


def tool_name(other: Tool, told: Tool) -> str:
    """What is different about a tool that takes another's place."""
    if other == told:
        return "the tool as told"
    if other.contact != told.contact:
        return "a flat tool to which the surface sticks"
    if other.edge_radius == told.edge_radius:
        return "the tool upright and centred"
    if other.edge_radius is None:
        return "the tool with a sharp edge"
    edge = f"{1e3 * other.edge_radius:.3g} mm"
    return f"a sphere of {edge}" if other.edge_radius == other.radius else f"an edge of {edge}"


def continued(curve: NearestCurve, depth: float) -> tuple[Array, Array, str]:
    """Depth, force (k,) of a curve that goes on to a depth (m) with its last power of the depth, and what was done."""
    end = curve.reach
    if end >= depth * (1.0 - 1e-9):
        return curve.depth, curve.force, ""
    rise = np.log(curve.force[-1] / curve.force[-2]) / np.log(end / curve.depth[-2])
    power = float(np.clip(rise, *POWERS))
    beyond = np.linspace(end, depth, BEYOND_POINTS + 1)[1:]
    force = curve.force[-1] * (beyond / end) ** power
    said = f"beyond {1e3 * end:.3g} mm the force goes on with the power {power:.2g} of the depth"
    return np.append(curve.depth, beyond), np.append(curve.force, force), said


def carried_forces(followed: Sequence[tuple[Tool, Ramp]]) -> list[tuple[Tool, float]]:
    """Each tool that was followed and the most its ramp carries, N; one that was followed to its end has no limit."""
    return [(tool, np.inf if ramp.failure is None else float(_rising(ramp)[1][-1])) for tool, ramp in followed]


def _joined(found: NearestCurve, ramp: Ramp, name: str, *, as_told: bool) -> NearestCurve:
    """The curve, gone on by a ramp where that comes deeper."""
    stop, tried = ramp.failure, found.tried
    if stop is not None:
        tried = (*tried, f"{name} is followed to {1e3 * stop.reached:.3g} mm ({stop.reason.partition(';')[0]})")
    found = replace(found, tried=tried)
    depth, force = _rising(ramp)
    beyond = depth > found.reach
    if depth.size <= LEAST_STEPS or not beyond.any():
        return found
    size = 1.0 if found.reach == 0.0 else found.force[-1] / float(PchipInterpolator(depth, force)(found.reach))
    used = found.used if as_told else (*found.used, f"{name} (to {1e3 * depth[-1]:.3g} mm)")
    return replace(
        found,
        depth=np.append(found.depth, depth[beyond]),
        force=np.append(found.force, size * force[beyond]),
        used=used,
    )


def _rising(ramp: Ramp) -> tuple[Array, Array]:
    """Depth and force of a ramp as far as its force rises."""
    falls = np.flatnonzero(np.diff(ramp.force) <= 0.0)
    end = int(falls[0]) + 1 if falls.size else ramp.force.size
    return ramp.depth[:end], ramp.force[:end]
