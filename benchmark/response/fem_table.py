"""Elastic tables by the finite elements: one depth ramp of the set-up as told, with the solver's own derivatives.

Where the solver stops early, or does not cover the tool, the force is that of the nearest tools that it follows, and
goes on like the wave model's; where there is none, the wave's table serves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from benchmark.errors import InputError, TissuebenchError
from benchmark.files import Session, Setup, Support, Tissue, Tool
from benchmark.response.differentiated_ramp import (
    DIFFERENCE,
    DifferentiatedRamp,
    RampDerivative,
    at_places,
    differentiated_ramp,
    elastic_ramp,
)
from benchmark.response.elastic_table import POINTS, Addition, ElasticTable, SeparableField, SetupDerivative, TableOf
from benchmark.response.force_curve import Array
from benchmark.response.nearest_curve import nearest_curve, stuck_tool
from benchmark.response.ramp import Ramp
from benchmark.response.setup_change import (
    CHOICES,
    HOLE_RADIUS,
    PRETENSION,
    RADIUS,
    THICKNESS,
    changed_setup,
    other_choice,
)
from benchmark.response.wave_table import MARGIN, wave_table

STEPS = 24
TENSE = (0.02, 0.1, 0.5, 2.5, 10.0)
"""Shares of the deepest force, about, that tensions make of which a table is told what they add.

On a sheet of 2 mm a pascal adds a third more than a membrane's under a small tension, a tenth less under a large one in
a deep press; between these the whole force is within 0.2 % of that of a press of its own.
"""
TENSE_STEPS = 12
"""Load steps of their presses."""
MESH = "fem.mesh"
SECOND_TERMS = 2
"""Terms of the second order of a field, which is small."""


def fem_or_wave_table(session: Session, keys: Sequence[str] = (RADIUS,)) -> TableOf:
    """The table of each set-up of a session: the finite elements', or the wave's where they do not cover it.

    Parameters
    ----------
    session : Session
    keys : sequence of str
        Set-up parameters by which the tables are differentiated.
    """
    return partial(_fem_or_wave, session, keys)


def _fem_or_wave(
    session: Session, keys: Sequence[str], tissue: Tissue, tool: Tool, support: Support, depth: float
) -> ElasticTable:
    """See `fem_or_wave_table`; a function of the module, so that processes can be given it."""
    try:
        return _fem_table(session, (tissue, tool, support), depth, keys)
    except TissuebenchError as error:
        return _noted(_wave(tissue, tool, support, depth, keys), str(error))


def fem_table(session: Session, keys: Sequence[str] = (RADIUS,)) -> TableOf:
    """The table of each set-up of a session by the finite elements; an error where they do not cover it."""

    def table(tissue: Tissue, tool: Tool, support: Support, depth: float) -> ElasticTable:
        try:
            return _fem_table(session, (tissue, tool, support), depth, keys)
        except TissuebenchError as error:
            raise InputError(f"--model fem: {error}; --model wave goes on without them.") from None

    return table


def _fem_table(session: Session, setup: Setup, depth: float, keys: Sequence[str]) -> ElasticTable:
    """The table of one set-up.

    Raises
    ------
    TissuebenchError
        The solver has no answer for it, nor for a tool near it.
    """
    tissue, tool, support = setup
    known = [key for key in keys if _has(setup, key)]
    told: list[DifferentiatedRamp] = []

    def ramp_of(other: Tool) -> Ramp:
        if other != tool:
            return elastic_ramp(session, tissue, other, support, MARGIN * depth, STEPS)
        told.append(
            differentiated_ramp(session, tissue, tool, support, MARGIN * depth, known, steps=STEPS, second=True)
        )
        return told[0].ramp

    curve = nearest_curve(tool, ramp_of)
    if told and told[0].depth[-1] >= depth:
        table = ramp_table(told[0], np.linspace(0.0, float(told[0].depth[-1]), POINTS))
        table = with_choices(session, setup, table, [key for key in keys if key in CHOICES])
        return _with_pretension(session, setup, table)
    note = curve.remark(MARGIN * depth) or "the finite elements stop early for a slightly changed set-up"
    if curve.reach < depth:
        note = f"{note}; beyond {1e3 * curve.reach:.3g} mm the base goes on like the wave model"
    return _noted(_with_force(_wave(*setup, depth, keys), curve.depth, curve.force), note)


def _has(setup: Setup, key: str) -> bool:
    """Whether a set-up has a parameter."""
    try:
        changed_setup(*setup, key, 0.0)
    except InputError:
        return False
    return True


def with_choices(session: Session, setup: Setup, table: ElasticTable, keys: Sequence[str]) -> ElasticTable:
    """The table with the way to each other choice, where the solver follows that as deep."""
    by = dict(table.by)
    for key in keys:
        try:
            ramp = elastic_ramp(session, setup[0], *other_choice(*setup[1:], key), float(table.depth[-1]), STEPS)
        except TissuebenchError:
            continue
        if ramp.depth[-1] >= table.depth[-1] * (1.0 - 1e-9):
            by[key] = _way_to(ramp, table)
    return replace(table, by=by)


def _with_pretension(session: Session, setup: Setup, table: ElasticTable) -> ElasticTable:
    """The table of a sheet with what tensions before the press add, as far as the solver follows them as deep.

    By the difference of presses on a coarse mesh, which is that of a finer one to 1 %: one without, the others under
    tensions that make about the shares `TENSE` of the deepest force.
    """
    tissue, tool, support = setup
    if support.hole_radius is None or PRETENSION in session.settings:
        return table
    coarse = replace(session, settings={MESH: "coarse", **session.settings})
    ramp = _ramp_to(coarse, setup, table)
    if ramp is None:
        return table
    plain = _on_grid(ramp, table)
    per_stress = 2.0 * np.pi * tissue.thickness * float(table.depth[-1]) / np.log(support.hole_radius / tool.radius)
    presses = {}
    for stress in np.array(TENSE) * float(table.force[-1]) / per_stress:
        tense = _ramp_to(coarse, setup, table, stress)
        if tense is not None:
            presses[float(stress)] = tense
    if not presses:
        return table
    amounts = np.array(list(presses))
    force = np.array([_force_over(ramp, table) for ramp in presses.values()]) - plain.force
    faces = [fields for stress, ramp in presses.items() if (fields := _fields_to(ramp, plain, stress))]
    outward, sink = (tuple(fields[side][0] for fields in faces) for side in (0, 1))
    middle = amounts.size // 2
    powers = _powers(coarse, setup, plain, float(amounts[middle]), force[middle])
    return replace(table, added={PRETENSION: Addition(amounts, force / amounts[:, None], outward, sink, powers)})


def _ramp_to(session: Session, setup: Setup, table: ElasticTable, stress: float = 0.0) -> Ramp | None:
    """A press of a sheet under a tension, Pa, as deep as a table; None where the solver does not follow it."""
    tension = {PRETENSION: f"{stress:.12g} Pa"} if stress else {}
    deepest = float(table.depth[-1])
    try:
        ramp = elastic_ramp(replace(session, settings={**session.settings, **tension}), *setup, deepest, TENSE_STEPS)
    except TissuebenchError:
        return None
    return ramp if ramp.depth[-1] >= deepest * (1.0 - 1e-9) else None


def _on_grid(ramp: Ramp, table: ElasticTable) -> ElasticTable:
    """A press on the depths and radii of a table, which changes with the set-up as that does."""
    face, force = ramp.face, _force_over(ramp, table)
    grown = np.divide(force, table.force, out=np.ones_like(force), where=table.force > 0.0)
    by = {key: replace(each, force=grown * each.force) for key, each in table.by.items()}
    if face is None or table.outward is None:
        return replace(table, force=force, outward=None, sink=None, by=by)
    outward, sink = (
        SeparableField.of(ramp.depth, at_places(face, each, table.radius, ramp.depth), table.depth)
        for each in (face.outward, face.sunk)
    )
    return replace(table, force=force, outward=outward, sink=sink, by=by)


def _force_over(ramp: Ramp, table: ElasticTable) -> Array:
    return np.asarray(CubicSpline(ramp.depth, ramp.force)(table.depth))


def _powers(session: Session, setup: Setup, plain: ElasticTable, stress: float, more: Array) -> dict[str, Array]:
    """Powers (k,) of the set-up's lengths with which goes what a tension adds, (k,) N; of all thicknesses together.

    By one more press under it with each length changed, less the force of the press without so changed.
    """
    layers = {f"{layer.name}.{THICKNESS}": layer.thickness / setup[0].thickness for layer in setup[0].layers}
    powers: dict[str, Array] = {}
    for key, parts in {RADIUS: {RADIUS: 1.0}, HOLE_RADIUS: {HOLE_RADIUS: 1.0}, THICKNESS: layers}.items():
        if not set(parts) <= set(plain.by):
            continue
        ramp = _ramp_to(session, changed_setup(*setup, key, DIFFERENCE), plain, stress)
        if ramp is None:
            continue
        there = _force_over(ramp, plain) - plain.force_with(dict.fromkeys(parts, DIFFERENCE))
        ratio = np.divide(there, more, out=np.ones_like(more), where=(more > 0.0) & (there > 0.0))
        powers |= {part: share * np.log(ratio) / np.log1p(DIFFERENCE) for part, share in parts.items()}
    return powers


def _way_to(ramp: Ramp, table: ElasticTable) -> SetupDerivative:
    """From a table to another ramp: the logarithm of the force and the fields go with the share of the way."""
    other = _force_over(ramp, table)
    ratio = np.divide(other, table.force, out=np.ones_like(other), where=table.force > 0.0)
    force = (table.force * np.log(np.maximum(ratio, 1e-3)))[None]
    return SetupDerivative(force, *_fields_to(ramp, table))


def _fields_to(ramp: Ramp, table: ElasticTable, way: float = 1.0) -> list[tuple[SeparableField, ...]]:
    """Outward motion and sinking of a ramp less the table's, over the way to it; none where no face is known."""
    if ramp.face is None or table.outward is None or table.sink is None:
        return []
    rows = np.searchsorted(table.depth, ramp.depth[ramp.depth <= table.depth[-1] * (1.0 + 1e-9)] * (1.0 - 1e-9))
    levels = table.depth[np.unique(np.clip(rows, 0, table.depth.size - 1))]
    fields: list[tuple[SeparableField, ...]] = []
    for name, told in (("outward", table.outward), ("sunk", table.sink)):
        there = at_places(ramp.face, getattr(ramp.face, name), table.radius, levels)
        here = told.table[np.searchsorted(table.depth, levels)]
        fields.append((SeparableField.of(levels, (there - here) / way, table.depth),))
    return fields


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


def ramp_table(ramp: DifferentiatedRamp, grid: Array) -> ElasticTable:
    """The table on a grid of depths that the ramp reached."""
    force = np.asarray(CubicSpline(ramp.depth, ramp.force)(grid))
    face = ramp.face
    levels = ramp.depth
    by = {key: _setup_derivative(ramp, each, force, grid) for key, each in ramp.by.items()}
    if face is None:
        return ElasticTable(grid, force, np.array([0.0, 1.0]), by=by)
    outward, sunk = (SeparableField.of(levels, each, grid) for each in (face.outward, face.sunk))
    return ElasticTable(grid, force, face.radius, outward, sunk, by)


def _setup_derivative(ramp: DifferentiatedRamp, by: RampDerivative, force: Array, grid: Array) -> SetupDerivative:
    """Both orders of the force, and those of the face that are known; see `RampDerivative`.

    Shares of the force are read between the steps, not forces: near rest both go to zero.
    """
    levels, second = ramp.depth, by.second
    parts = [by.force] if second is None else [by.force, 0.5 * second.force]
    share = np.divide(parts, ramp.force, out=np.zeros((len(parts), levels.size)), where=ramp.force > 0.0)
    orders = force * np.asarray(PchipInterpolator(levels[1:], share[:, 1:], axis=1)(np.maximum(grid, levels[1])))
    if by.outward is None:
        return SetupDerivative(orders)
    fields = [SeparableField.of(levels, by.outward, grid)]
    if second is not None and second.outward is not None:
        fields.append(SeparableField.of(levels, 0.5 * second.outward, grid, SECOND_TERMS))
    return SetupDerivative(orders, tuple(fields))


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
