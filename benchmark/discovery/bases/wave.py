"""The wave models as an elastic base: the sheet over a hole, or bonded layers under a large press."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from benchmark.discovery.bases.law import MARGIN, POINTS, STEP, BaseLaw, reduced, resized
from benchmark.discovery.discovery_result import Array
from benchmark.errors import InputError
from benchmark.files import Support, Tissue, Tool

LEVELS = 24
RADII = 90


def wave_law(tissue: Tissue, tool: Tool, support: Support, depth: float) -> BaseLaw:
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
    force = _layered_force(tissue, tool, grid)
    more = _layered_force(tissue, resized(tool, STEP), grid)
    return BaseLaw(grid, force, _first_order(force, more), np.array([0.0, 1.0]))


@lru_cache(maxsize=16)
def _layered_wave(layers: tuple[Any, ...], radius: float, contact: str) -> Any:
    """The wave of a large press, which takes seconds to set up: once for all conditions with the same tool."""
    from wavemodel import DiscTool, LayeredWave

    return LayeredWave(list(layers), DiscTool(radius, contact), large_press="corrected")


def _layered_force(tissue: Tissue, tool: Tool, grid: Array) -> Array:
    """Force (k,) of a large press as far as its range goes, then on with the growth over the linear law."""
    wave = _layered_wave(tuple(_layers(tissue)), tool.radius, _contact(tool))
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


def _first_order(force: Array, more: Array) -> Array:
    """(2, k) orders in the radius: setting the wave up takes long enough for one step of it alone."""
    return np.stack([(more - force) / STEP, np.zeros_like(force)])


def _sheet(tissue: Tissue, tool: Tool, hole: float, depth: float) -> BaseLaw:
    grid = np.linspace(0.0, depth, POINTS)
    levels = np.linspace(0.0, 1.0, LEVELS + 1) ** 1.3 * depth
    radii = np.linspace(0.0, hole, RADII)
    force, outward, sink = _sheet_tables(tissue, tool, hole, grid, levels, radii)
    more = _sheet_tables(tissue, resized(tool, STEP), hole, grid, levels, radii)
    return BaseLaw(
        grid,
        force,
        _first_order(force, more[0]),
        radii,
        reduced(levels, outward, grid),
        reduced(levels, sink, grid),
        (reduced(levels, (more[1] - outward) / STEP, grid),),
    )


def _sheet_tables(
    tissue: Tissue, tool: Tool, hole: float, grid: Array, levels: Array, radii: Array
) -> tuple[Array, Array, Array]:
    from wavemodel import DiscTool, PlateWave

    wave = PlateWave(_layers(tissue), DiscTool(tool.radius, _contact(tool)), "hole", hole, reach=float(grid[-1]))
    faces = np.array([wave.field(float(level), radii)[:, -1] for level in levels[1:]])
    faces = np.concatenate([np.zeros((1, *faces.shape[1:])), faces])
    return wave.force_of_depth(grid), faces[:, 0], faces[:, 1]
