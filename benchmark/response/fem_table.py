"""Elastic tables by the finite elements: a depth ramp of the set-up as told, and two of each parameter that is changed.

Where the solver stops early, or does not cover the tool, the force is that of the nearest tools that it follows, and
goes on like the wave model's; where there is none, the wave's table serves.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from benchmark.errors import InputError, TissuebenchError
from benchmark.files import Session, Support, Tissue, Tool
from benchmark.models import UncoveredError, prepare
from benchmark.models.model_result import LowerFace
from benchmark.response.elastic_table import (
    POINTS,
    ElasticTable,
    SeparableField,
    SetupDerivative,
    TableOf,
    orders,
)
from benchmark.response.force_curve import Array
from benchmark.response.nearest_curve import nearest_curve, stuck_tool
from benchmark.response.ramp import Ramp, depth_ramp, setup_scenario
from benchmark.response.setup_change import RADIUS, changed_setup
from benchmark.response.wave_table import MARGIN, STEP, wave_table

STEPS = 24


def fem_or_wave_table(session: Session, keys: Sequence[str] = (RADIUS,)) -> TableOf:
    """The table of each set-up of a session: the finite elements', or the wave's where they do not cover it.

    Parameters
    ----------
    session : Session
    keys : sequence of str
        Set-up parameters by which the tables are differentiated.
    """

    def table(tissue: Tissue, tool: Tool, support: Support, depth: float) -> ElasticTable:
        try:
            return _fem_table(session, (tissue, tool, support), depth, keys)
        except TissuebenchError as error:
            return _noted(_wave(tissue, tool, support, depth, keys), str(error))

    return table


def fem_table(session: Session, keys: Sequence[str] = (RADIUS,)) -> TableOf:
    """The table of each set-up of a session by the finite elements; an error where they do not cover it."""

    def table(tissue: Tissue, tool: Tool, support: Support, depth: float) -> ElasticTable:
        try:
            return _fem_table(session, (tissue, tool, support), depth, keys)
        except TissuebenchError as error:
            raise InputError(f"--model fem: {error}; --model wave goes on without them.") from None

    return table


def _fem_table(
    session: Session, setup: tuple[Tissue, Tool, Support], depth: float, keys: Sequence[str]
) -> ElasticTable:
    """The table of one set-up.

    Raises
    ------
    TissuebenchError
        The solver has no answer for it, nor for a tool near it.
    """
    tissue, tool, support = setup

    def ramp_of(other: Tool) -> Ramp:
        return _ramp(session, tissue, other, support, MARGIN * depth)

    curve = nearest_curve(tool, ramp_of)
    told = curve.under(tool)
    if told is not None and told.depth[-1] >= depth:
        pairs = {key: pair for key in keys if (pair := _changed_ramps(session, setup, key, depth))}
        reached = min(float(ramp.depth[-1]) for ramp in (told, *(one for pair in pairs.values() for one in pair)))
        if RADIUS in pairs or RADIUS not in keys:
            return _table(told, pairs, np.linspace(0.0, reached, POINTS))
    note = curve.remark(MARGIN * depth) or "the finite elements stop early for a slightly changed set-up"
    if curve.reach < depth:
        note = f"{note}; beyond {1e3 * curve.reach:.3g} mm the base goes on like the wave model"
    return _noted(_with_force(_wave(*setup, depth, keys), curve.depth, curve.force), note)


def _changed_ramps(session: Session, setup: tuple[Tissue, Tool, Support], key: str, depth: float) -> tuple[Ramp, ...]:
    """Ramps with a set-up parameter smaller and larger; none where one of them cannot be pressed to the depth."""
    try:
        pair = tuple(_ramp(session, *changed_setup(*setup, key, sign * STEP), MARGIN * depth) for sign in (-1.0, 1.0))
    except TissuebenchError:
        return ()
    return pair if all(ramp.depth[-1] >= depth for ramp in pair) else ()


def _wave(tissue: Tissue, tool: Tool, support: Support, depth: float, keys: Sequence[str]) -> ElasticTable:
    """The wave's table; for a tool that the wave does not cover, that of one to which the surface sticks."""
    try:
        return wave_table(tissue, tool, support, depth, keys)
    except InputError as error:
        stuck = stuck_tool(tool)
        if stuck == tool:
            raise
        table = wave_table(tissue, stuck, support, depth, keys)
        reason = str(error).rpartition(": ")[0] or str(error)
        return replace(
            table, note=f"the wave model's changes with depth and radius are those of a tool that sticks ({reason})"
        )


def _ramp(session: Session, tissue: Tissue, tool: Tool, support: Support, deepest: float) -> Ramp:
    elastic = tissue.model_copy(
        update={"layers": tuple(one.model_copy(update={"relaxation": ()}) for one in tissue.layers)}
    )
    try:
        model = prepare("fem", setup_scenario(session, elastic, (tool, support)), every_field=True)
        return depth_ramp(model, deepest, STEPS, face=support.kind == "hole")
    except UncoveredError as error:
        raise InputError(f"the finite elements do not cover {session.name}: {error}") from None


def _table(told: Ramp, pairs: Mapping[str, tuple[Ramp, ...]], grid: Array) -> ElasticTable:
    """The table on a grid of depths that all ramps reached."""
    force = _force(told, grid)
    by_force = {
        key: np.stack(orders(_force(less, grid), force, _force(more, grid), STEP))
        for key, (less, more) in pairs.items()
    }
    face = told.face
    if face is None:
        plain = {key: SetupDerivative(each) for key, each in by_force.items()}
        return ElasticTable(grid, force, np.array([0.0, 1.0]), by=plain)
    levels = face.depth[face.depth <= grid[-1] * (1.0 + 1e-9)]
    outward = _at(face, face.outward, levels, face.radius)
    by = {}
    for key, (less, more) in pairs.items():
        sides = [_at(ramp.face, ramp.face.outward, levels, face.radius) for ramp in (less, more) if ramp.face]
        fields = tuple(SeparableField.of(levels, one, grid) for one in orders(sides[0], outward, sides[1], STEP))
        by[key] = SetupDerivative(by_force[key], fields)
    sunk = SeparableField.of(levels, face.sunk[: levels.size], grid)
    return ElasticTable(grid, force, face.radius, SeparableField.of(levels, outward, grid), sunk, by)


def _force(ramp: Ramp, grid: Array) -> Array:
    return np.asarray(CubicSpline(ramp.depth, ramp.force)(grid))


def _at(face: LowerFace, table: Array, levels: Array, radius: Array) -> Array:
    """A table of a lower face at other depths (levels,) and radii (q,)."""
    over_depth = CubicSpline(face.depth, table)(levels)
    return np.asarray(CubicSpline(face.radius, over_depth, axis=1)(np.clip(radius, 0.0, face.radius[-1])))


def _with_force(wave: ElasticTable, depth: Array, force: Array) -> ElasticTable:
    """The wave's table with another force; beyond the last depth it grows like the wave's."""
    inside = wave.depth <= depth[-1]
    ratio = np.ones_like(wave.force)
    curve = PchipInterpolator(depth, force)(np.minimum(wave.depth, depth[-1]))
    np.divide(curve, wave.force, out=ratio, where=inside & (wave.force > 0.0))
    ratio[~inside] = ratio[inside][-1]
    by = {key: replace(each, force=ratio * each.force) for key, each in wave.by.items()}
    return replace(wave, force=ratio * wave.force, by=by)


def _noted(table: ElasticTable, note: str) -> ElasticTable:
    note = "; ".join(text for text in (note, table.note) if text)
    return replace(table, note=f"{note}; what the wave model itself misses there may be taken for an effect")
