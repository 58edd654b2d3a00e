"""Elastic tables by the wave models: the sheet over a hole, or bonded layers under a large press.

They follow the layers' laws. Their force and face are explicit in depth, so that no steps are needed; setting one up
takes long enough for one change of each parameter alone, so that derivatives are of first order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmark.errors import InputError
from benchmark.files import Setup, Support, Tissue, Tool
from benchmark.models.model_result import LowerFace, UncoveredError
from benchmark.response.elastic_table import POINTS, ElasticTable, SeparableField, SetupDerivative
from benchmark.response.force_curve import Array
from benchmark.response.ramp import Ramp
from benchmark.response.setup_change import CHOICES, RADIUS, changed_setup, natural_change, way_of

if TYPE_CHECKING:
    from wavemodel import PlateWave, WaveLayer

LEVELS = 24
RADII = 90
STEP = 0.06
"""Natural change of a set-up parameter by which tables are differentiated."""
MARGIN = 1.25
"""A table reaches this much deeper than the trials."""

ENDLESS = 0.05
"""Thickness of an endless layer, m."""


def wave_table(
    tissue: Tissue, tool: Tool, support: Support, depth: float, keys: Sequence[str] = (RADIUS,)
) -> ElasticTable:
    """The table of one set-up to a depth, m.

    Parameters
    ----------
    tissue, tool, support
        The set-up.
    depth : float
        Deepest depth of the trials, m.
    keys : sequence of str
        Set-up parameters by which the table is differentiated; the wave has no other choices.

    Raises
    ------
    InputError
        The wave models do not cover the set-up.
    """
    from wavemodel import WaveError

    setup = (tissue, tool, support)
    keys = [key for key in keys if key not in CHOICES]
    try:
        if support.kind == "hole":
            return _sheet(setup, MARGIN * depth, keys)
        return _bonded(setup, MARGIN * depth, keys)
    except WaveError as error:
        raise InputError(f"the base model of {tissue.name!r} cannot be worked out: {error}.") from None


def wave_ramp(tissue: Tissue, tool: Tool, support: Support, levels: Array) -> Ramp:
    """The wave's answer at depths (k,) from 0 up, m, as a ramp; over a hole with the lower face.

    Raises
    ------
    InputError
        The wave models do not cover the set-up.
    """
    from wavemodel import WaveError

    layers = np.zeros((levels.size, 0))
    try:
        if support.kind != "hole":
            return Ramp(levels, _layered_force(tissue, tool, levels), layers)
        radii = np.linspace(0.0, float(support.hole_radius or 0.0), RADII)
        force, outward, sunk = _sheet_fields(tissue, tool, support, levels, levels, radii)
    except WaveError as error:
        raise InputError(f"the wave does not cover {tissue.name!r}: {error}.") from None
    return Ramp(levels, force, layers, LowerFace(levels, radii, outward, sunk))


def _bonded(setup: Setup, depth: float, keys: Sequence[str]) -> ElasticTable:
    grid = np.linspace(0.0, depth, POINTS)
    force = _layered_force(*setup[:2], grid)
    by = {}
    for key in keys:
        step = STEP * natural_change(setup[0], key)
        tissue, tool, _ = changed_setup(*setup, key, step)
        by[key] = SetupDerivative(_slope(force, _layered_force(tissue, tool, grid), key, step))
    return ElasticTable(grid, force, np.array([0.0, 1.0]), by=by)


def _sheet(setup: Setup, depth: float, keys: Sequence[str]) -> ElasticTable:
    grid = np.linspace(0.0, depth, POINTS)
    levels = np.linspace(0.0, 1.0, LEVELS + 1) ** 1.3 * depth
    radii = np.linspace(0.0, float(setup[2].hole_radius or 0.0), RADII)
    force, outward, sink = _sheet_fields(*setup, grid, levels, radii)
    by = {}
    for key in keys:
        step = STEP * natural_change(setup[0], key)
        more = _sheet_fields(*changed_setup(*setup, key, step), grid, levels, radii)
        field = SeparableField.of(levels, (more[1] - outward) / way_of(key, step), grid)
        by[key] = SetupDerivative(_slope(force, more[0], key, step), (field,))
    out, sunk = (SeparableField.of(levels, each, grid) for each in (outward, sink))
    return ElasticTable(grid, force, radii, out, sunk, by)


def _slope(force: Array, more: Array, key: str, step: float) -> Array:
    """(1, k) first order of a force that goes with a power of the parameter, from that of one step."""
    ratio = np.divide(more, force, out=np.ones_like(force), where=(force > 0.0) & (more > 0.0))
    return np.asarray(force * np.log(ratio) / way_of(key, step))[None]


def _sheet_fields(
    tissue: Tissue, tool: Tool, support: Support, grid: Array, levels: Array, radii: Array
) -> tuple[Array, Array, Array]:
    """Force (k,) N on the grid; outward motion and sinking (levels, radii) m of the lower face."""
    from wavemodel import DiscTool, PlateSettings, PlateWave

    hole, settings = float(support.hole_radius or 0.0), PlateSettings(reach=float(grid[-1]))
    layers = _layers(tissue)
    wave = PlateWave(layers, DiscTool(tool.radius, _contact(tool)), "hole", hole, settings, clamp=support.clamp)
    _require_laws(wave, layers)
    faces = np.array([wave.field(float(level), radii)[:, -1] for level in levels[1:]])
    faces = np.concatenate([np.zeros((1, *faces.shape[1:])), faces])
    return wave.force_of_depth(grid), faces[:, 0], faces[:, 1]


@lru_cache(maxsize=16)
def _layered_wave(layers: tuple[Any, ...], radius: float, contact: str, reach: float) -> Any:
    """The wave of a large press, which takes seconds to set up: once for conditions with the same tool and reach."""
    from wavemodel import DiscTool, LayeredWave

    return LayeredWave(list(layers), DiscTool(radius, contact), large_press="corrected", reach=reach)


def _reach(layers: Sequence[WaveLayer], depth: float) -> float:
    """A depth, m, that holds another one: halves of the stack's height, so that like presses share a wave."""
    height = sum(layer.thickness for layer in layers)
    return float(height * 2.0 ** np.ceil(np.log2(depth / height)))


def _layered_force(tissue: Tissue, tool: Tool, grid: Array) -> Array:
    """Force (k,) of a large press as far as its range goes, then on with the growth over the linear law."""
    layers = tuple(_layers(tissue))
    wave = _layered_wave(layers, tool.radius, _contact(tool), _reach(layers, float(grid[-1])))
    linear = grid / wave.law.compliance
    reach = 0.999 * wave.law.large.deepest if wave.law.large is not None else grid[-1]
    inside = grid <= reach
    ratio = np.ones_like(grid)
    ratio[inside] = np.divide(
        wave.law(grid[inside]), linear[inside], out=np.ones(inside.sum()), where=linear[inside] > 0
    )
    ratio[0] = ratio[1]
    if not inside.all():
        known, beyond = grid[inside], grid[~inside]
        growth = np.polyfit(known[1:], np.log(ratio[inside][1:]), 2)
        slope = max(float(np.polyval(np.polyder(growth), known[-1])), 0.0)
        ratio[~inside] = ratio[inside][-1] * np.exp(slope * (beyond - known[-1]))
    return np.asarray(linear * ratio)


def _layers(tissue: Tissue) -> list[WaveLayer]:
    """The layers with their laws; an endless one as thick as the wave needs it.

    Raises
    ------
    InputError
        For fibres in one direction, which the wave does not have, or constants that a law does not take.
    """
    from benchmark.models.solver_layers import wave_layers

    for one in tissue.layers:
        if one.fibre is not None and one.fibre.directed:
            raise InputError(
                f"the wave does not cover {tissue.name!r}: the layer {one.name} has fibres in one direction; leave the "
                "angle out (fibres spread evenly over the plane), or take the finite elements."
            )
    try:
        layers = wave_layers(tissue.layers)
    except UncoveredError as error:
        raise InputError(f"the wave does not cover {tissue.name!r}: {error}.") from None
    return [one if np.isfinite(one.thickness) else replace(one, thickness=ENDLESS) for one in layers]


def _require_laws(wave: PlateWave, layers: Sequence[WaveLayer]) -> None:
    """Refuse laws that the plate theory, which is left for this tool, would take for neo-Hookean."""
    from wavemodel import NotCoveredError

    if wave.tension != "layered" and any(layer.law is not None for layer in layers):
        raise NotCoveredError(
            f"under a tool with contact {wave.tool.contact!r} a sheet over a hole follows no law of its layers; under "
            "uniform_pressure and rigid_bonded it does, and so do the finite elements"
        )


def _contact(tool: Tool) -> str:
    return "rigid_bonded" if tool.contact == "rigid_frictional" else tool.contact
