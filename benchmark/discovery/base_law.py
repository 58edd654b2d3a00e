"""The elastic base of a condition: force over depth and the motion of the lower face, with its derivatives by shape.

The fast wave models give it: the sheet over a hole, or bonded layers. A bonded lower face does not move, so markers
under it stay where they are.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np

from benchmark.discovery.result import Array
from benchmark.errors import InputError
from benchmark.files import Support, Tissue, Tool

POINTS = 500
LEVELS = 24
RADII = 90
FIELDS = 4
STEP = 0.06
"""Relative step of the tool's radius by which the base is differentiated."""
MARGIN = 1.25
"""The base reaches this much deeper than the trials."""


@dataclass(frozen=True, eq=False)
class BaseLaw:
    """Tables of a base.

    Attributes
    ----------
    depth : (k,) m from 0
    force, force_by_radius : (k,)
        N at modulus factor 1, and N per relative change of the tool's radius.
    radius : (q,) m
    outward, sink : (FIELDS, k) and (FIELDS, q) each
        Motion of the lower face as a sum of courses over depth times shapes over radius, m.
    outward_by_radius : the same for the derivative of the outward motion
    """

    depth: Array
    force: Array
    force_by_radius: Array
    radius: Array
    outward: tuple[Array, Array] | None = None
    sink: tuple[Array, Array] | None = None
    outward_by_radius: tuple[Array, Array] | None = None


BaseLaws: TypeAlias = Callable[[Tissue, Tool, Support, float], BaseLaw]
"""The base of one set-up to a depth, m."""


def base_law(tissue: Tissue, tool: Tool, support: Support, depth: float) -> BaseLaw:
    """The base of one set-up to a depth, m.

    Raises
    ------
    InputError
        The wave models do not cover the set-up.
    """
    from wavemodel import WaveError

    try:
        if support.kind == "hole":
            return _sheet(tissue, tool, float(support.hole_radius or 0.0), MARGIN * depth)
        return _bonded(tissue, tool, MARGIN * depth)
    except WaveError as error:
        raise InputError(f"the base model of {tissue.name!r} cannot be worked out: {error}.") from None


def _layers(tissue: Tissue) -> list[Any]:
    from wavemodel import WaveLayer

    def thick(value: float) -> float:
        return value if np.isfinite(value) else 0.05

    return [
        WaveLayer(one.name, thick(one.thickness), one.density, one.youngs_modulus, one.poisson_ratio)
        for one in tissue.layers
    ]


def _contact(tool: Tool) -> str:
    return "rigid_bonded" if tool.contact == "rigid_frictional" else tool.contact


def _bonded(tissue: Tissue, tool: Tool, depth: float) -> BaseLaw:
    grid = np.linspace(0.0, depth, POINTS)
    force = _layered_force(tissue, tool, tool.radius, grid)
    wider = _layered_force(tissue, tool, tool.radius * (1.0 + STEP), grid)
    return BaseLaw(grid, force, (wider - force) / STEP, np.array([0.0, 1.0]))


@lru_cache(maxsize=16)
def _layered_wave(layers: tuple[Any, ...], radius: float, contact: str) -> Any:
    """The wave of a large press, which takes seconds to set up: once for all conditions with the same tool."""
    from wavemodel import DiscTool, LayeredWave

    return LayeredWave(list(layers), DiscTool(radius, contact), large_press="corrected")


def _layered_force(tissue: Tissue, tool: Tool, radius: float, grid: Array) -> Array:
    """Force (k,) of a large press as far as its range goes, then on with the growth over the linear law."""
    wave = _layered_wave(tuple(_layers(tissue)), radius, _contact(tool))
    linear = grid / wave.law.compliance
    reach = 0.999 * wave.law.large.deepest if wave.law.large is not None else grid[-1]
    inside = grid <= reach
    ratio = np.ones_like(grid)
    ratio[inside] = np.divide(
        wave.law(grid[inside]), linear[inside], out=np.ones(inside.sum()), where=linear[inside] > 0
    )
    ratio[0] = ratio[1]
    if not inside.all():
        known = grid[inside]
        growth = np.polyfit(known[1:], np.log(ratio[inside][1:]), 2)
        start = np.polyval(growth, known[-1])
        slope = max(float(np.polyval(np.polyder(growth), known[-1])), 0.0)
        beyond = grid[~inside]
        ratio[~inside] = ratio[inside][-1] * np.exp(slope * (beyond - known[-1])) + 0.0 * start
    return np.asarray(linear * ratio)


def _sheet(tissue: Tissue, tool: Tool, hole: float, depth: float) -> BaseLaw:
    grid = np.linspace(0.0, depth, POINTS)
    radii = np.linspace(0.0, hole, RADII)
    force, outward, sink = _sheet_tables(tissue, tool, tool.radius, hole, grid, radii)
    wider = _sheet_tables(tissue, tool, tool.radius * (1.0 + STEP), hole, grid, radii)
    return BaseLaw(
        grid,
        force,
        (wider[0] - force) / STEP,
        radii,
        _reduced(grid, outward),
        _reduced(grid, sink),
        _reduced(grid, (wider[1] - outward) / STEP),
    )


def _levels(depth: float) -> Array:
    return np.linspace(0.0, 1.0, LEVELS + 1) ** 1.3 * depth


def _sheet_tables(
    tissue: Tissue, tool: Tool, radius: float, hole: float, grid: Array, radii: Array
) -> tuple[Array, Array, Array]:
    from wavemodel import DiscTool, PlateWave

    wave = PlateWave(_layers(tissue), DiscTool(radius, _contact(tool)), "hole", hole, reach=float(grid[-1]))
    faces = np.array([wave.field(float(level), radii)[:, -1] for level in _levels(grid[-1])[1:]])
    faces = np.concatenate([np.zeros((1, *faces.shape[1:])), faces])
    return wave.force_of_depth(grid), faces[:, 0], faces[:, 1]


def _reduced(grid: Array, table: Array) -> tuple[Array, Array]:
    """A table (levels, q) as FIELDS courses over the grid (FIELDS, k) times shapes (FIELDS, q)."""
    from scipy.interpolate import CubicSpline

    left, sizes, right = np.linalg.svd(table, full_matrices=False)
    courses = CubicSpline(_levels(grid[-1]), left[:, :FIELDS] * sizes[:FIELDS])(grid)
    return np.ascontiguousarray(courses.T), np.ascontiguousarray(right[:FIELDS])
