"""From a session to a study: what can be used, aligned row by row, and what a reader must know of it."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery.discovery_result import Array
from benchmark.discovery.trials.marker_layout import Layout, layout
from benchmark.discovery.trials.rows import (
    RawTrial,
    acceleration,
    bin_means,
    bin_sizes,
    fractions,
    frame_means,
    marker_frames,
    resting_grid,
)
from benchmark.discovery.trials.segments import Segment, segments, stages
from benchmark.discovery.trials.study import ConditionData, Study
from benchmark.errors import InputError
from benchmark.files import Session, Trial
from benchmark.models.scenario_effects import specimen_layers
from benchmark.physics import TrialContext

LEAST_TRIALS = 3
ENOUGH_TRIALS = 6
MOST_RAW = 4000
LEAST_TRAVEL = 1e-6
SPREAD = 3.0
"""Speeds of the trials of one condition lie within this factor, and so do peak depths or else peak forces."""
SAME_TIME = 0.05
LEAST_BINS = 10
NEAR = (-0.04, 0.08)
SPAN = 0.008
"""Bins whose depth comes within `NEAR` (shares of the peak) of contact span no more than `SPAN` of it."""
MOST_IN_ALL, LEAST_IN_TRIAL = 2400, 40
"""Rows of all trials together, and of a trial where there are very many."""

Pieces: TypeAlias = tuple[Segment, ...]


def prepare(session: Session, rows: int) -> Study:
    """Align the trials of each condition.

    Parameters
    ----------
    session
        As loaded.
    rows
        About how many rows a trial is reduced to.

    Raises
    ------
    InputError
        Fewer than three trials, a trial without motion or force, or trials of different protocols in a condition.
    """
    if len(session.trials) < LEAST_TRIALS:
        raise InputError(
            f"session {session.name}: {len(session.trials)} trial(s); at least {LEAST_TRIALS} are needed to tell a "
            f"disagreement from chance, and {ENOUGH_TRIALS} to show it at the 5 % level."
        )
    warnings = list(session.warnings)
    if len(session.trials) < ENOUGH_TRIALS:
        warnings.append(
            f"{len(session.trials)} trials: sign flips of so few cannot reach the 5 % level, so nothing can be shown"
        )
    rows = min(rows, max(LEAST_IN_TRIAL, MOST_IN_ALL // len(session.trials)))
    raw = [_raw(session, trial, warnings) for trial in session.trials]
    groups = [[r for r in raw if r.trial.condition == name] for name in session.conditions]
    kept = [_same_protocol(session, group, warnings) for group in groups]
    camera = session.camera
    seen = _seen(kept)
    grid = None
    if camera is not None and seen is None:
        warnings.append("[camera] is given, but no four markers are seen in all trials: force alone is compared")
    if camera is not None and seen is not None:
        positions = np.array([r.markers for group in kept for r in group if r.markers is not None][:1])
        nominal = resting_grid(camera, positions)
        grid = layout(nominal[seen], camera.marker_spacing)
        if not seen.all():
            warnings.append(f"{int((~seen).sum())} markers were not seen often enough and are left out")
    order = {id(trial): number for number, trial in enumerate(session.trials)}
    conditions = tuple(
        _condition(session, group, grid, seen, np.array([order[id(r.trial)] for r in group]), rows)
        for group in kept
        if group
    )
    interval = float(np.median([np.median(np.diff(r.time)) for r in raw]))
    return Study(conditions, grid, camera.distance if camera else None, interval, tuple(warnings))


def _raw(session: Session, trial: Trial, warnings: list[str]) -> RawTrial:
    table = trial.table
    place = f"session {session.name}, trial {trial.name}"
    if float(np.ptp(table.depth)) < LEAST_TRAVEL:
        raise InputError(f"{place}: no motion, depth_mm stays at {1e3 * table.depth[0]:.4g}; the tool must press.")
    if float(np.ptp(table.force)) <= 0.0:
        raise InputError(f"{place}: force_N does not change; depth without force tells nothing of the tissue.")
    if table.depth.max() <= 0.0:
        raise InputError(f"{place}: depth_mm never rises above 0, so the tool never presses.")
    time, depth, force = _decimated(table.time, table.depth, table.force)
    interval = np.diff(time)
    if interval.max() > 5.0 * np.median(interval):
        warnings.append(f"trial {trial.name}: a gap of {interval.max():.3g} s between rows; nothing is filled in")
    pieces = tuple(segments(time, depth))
    if not any(piece.kind == "press" for piece in pieces):
        raise InputError(f"{place}: the depth never rises by a tenth of its range; a press is needed.")
    seen = marker_frames(trial, session.camera) if session.camera is not None else None
    frames, markers = seen if seen is not None else (None, None)
    return RawTrial(trial, time, depth, force, acceleration(time, depth), frames, markers, pieces)


def _decimated(*columns: Array) -> list[Array]:
    block = -(-columns[0].size // MOST_RAW)
    if block == 1:
        return [np.asarray(column, dtype=float) for column in columns]
    whole = columns[0].size // block * block
    return [np.asarray(column[:whole].reshape(-1, block).mean(axis=1)) for column in columns]


def _kinds(raw: RawTrial) -> tuple[str, ...]:
    return tuple(piece.kind for piece in raw.pieces)


def _without_first_rest(raw: RawTrial) -> RawTrial:
    """A trial whose first rest counts to what follows it."""
    pieces = raw.pieces
    if len(pieces) < 2 or pieces[0].kind != "rest":
        return raw
    return replace(raw, pieces=(replace(pieces[1], first=0), *pieces[2:]))


def _same_protocol(session: Session, group: Sequence[RawTrial], warnings: list[str]) -> list[RawTrial]:
    """Trials with the motion of most, their segments alike."""
    if len({_kinds(raw) for raw in group}) > 1:
        group = [_without_first_rest(raw) for raw in group]
    usual = Counter(_kinds(raw) for raw in group).most_common(1)[0][0]
    model = next(raw for raw in group if _kinds(raw) == usual)
    fitted = [raw if _kinds(raw) == usual else _timed_like(raw, model) for raw in group]
    kept = [raw for raw in fitted if raw is not None]
    name = group[0].trial.condition
    odd = [raw.trial.name for raw, one in zip(group, fitted, strict=True) if one is None]
    peaks = np.array([raw.depth.max() for raw in kept])
    speeds = np.array([_speed(raw) for raw in kept])
    forces = np.array([np.ptp(raw.force) for raw in kept])
    deep = min(peaks.max() / peaks.min(), forces.max() / forces.min()) > SPREAD
    wide = deep or speeds.max() / speeds.min() > SPREAD
    if len(odd) > 0.25 * len(group) or wide:
        raise InputError(
            f"session {session.name}, condition {name}: trials of different protocols ({len(group)} trials; peak depth "
            f"{1e3 * peaks.min():.3g} to {1e3 * peaks.max():.3g} mm, speed {1e3 * speeds.min():.3g} to "
            f"{1e3 * speeds.max():.3g} mm/s); give each protocol a condition of its own."
        )
    if odd:
        warnings.append(f"condition {name}: left out for another motion than the others': {', '.join(odd)}")
    return kept


def _speed(raw: RawTrial) -> float:
    piece = next(piece for piece in raw.pieces if piece.kind == "press")
    last = min(piece.last, raw.time.size - 1)
    return float(abs(raw.depth[last] - raw.depth[piece.first]) / max(raw.time[last] - raw.time[piece.first], 1e-9))


def _timed_like(raw: RawTrial, model: RawTrial) -> RawTrial | None:
    """A trial with the segments of another by their times, if its motion is the same within 5 %."""
    duration, other = np.ptp(raw.time), np.ptp(model.time)
    if abs(duration / other - 1.0) > SAME_TIME:
        return None
    shown = np.interp(model.time - model.time[0], raw.time - raw.time[0], raw.depth)
    if np.abs(shown - model.depth).max() > 0.2 * np.ptp(model.depth):
        return None
    stamps = [model.time[piece.first] - model.time[0] for piece in model.pieces]
    edges = [int(np.searchsorted(raw.time - raw.time[0], stamp - 1e-9)) for stamp in stamps] + [raw.time.size]
    pieces = [
        replace(piece, first=first, last=last)
        for piece, first, last in zip(model.pieces, edges[:-1], edges[1:], strict=True)
    ]
    return replace(raw, pieces=tuple(pieces)) if all(p.last > p.first for p in pieces) else None


def _seen(groups: Sequence[Sequence[RawTrial]]) -> NDArray[np.bool_] | None:
    """Markers (m,) that all trials with markers saw; None without any."""
    each = [np.isfinite(raw.markers[0, :, 0]) for group in groups for raw in group if raw.markers is not None]
    if not each:
        return None
    seen = np.all(each, axis=0)
    return seen if seen.sum() >= 4 else None


def _condition(
    session: Session,
    group: Sequence[RawTrial],
    grid: Layout | None,
    seen: NDArray[np.bool_] | None,
    numbers: NDArray[np.int64],
    rows: int,
) -> ConditionData:
    plan = _plan(group, rows)
    binned = [_binned(raw, plan, grid, seen) for raw in group]
    data = np.array([one.rows for one in binned])
    first = group[0].trial
    time = data[..., 0] - data[:, :1, 0]
    depth = data[..., 1]
    kinds = np.concatenate([[piece] * (edges.size - 1) for piece, edges in plan]).astype(int)
    stage = stages(group[0].pieces, kinds, np.median(depth, axis=0))
    around = TrialContext(
        tool_radius=first.tool.radius,
        thickness=_finite(session.specimen.thickness),
        peak_depth=float(depth.max()),
        peak_force=float(np.median(np.ptp(data[..., 3], axis=1))),
        duration=float(time[:, -1].max()),
        spacing=session.camera.marker_spacing if session.camera and grid is not None else 0.0,
        markers=None if grid is None else grid.rest,
        hole_radius=(first.support.hole_radius or math.inf) if first.support.kind == "hole" else math.inf,
        layers=specimen_layers(session.specimen.layers),
        contact=first.tool.contact,
    )
    return ConditionData(
        first.condition,
        first.tool,
        first.support,
        tuple(raw.trial.name for raw in group),
        numbers,
        time,
        depth,
        data[..., 2],
        data[..., 3:],
        np.array([one.count for one in binned]),
        np.array([one.frame_time for one in binned]) - data[:, :1, 0],
        *stage,
        around,
    )


def _finite(thickness: float) -> float:
    return thickness if np.isfinite(thickness) else 0.05


def _plan(group: Sequence[RawTrial], rows: int) -> list[tuple[int, Array]]:
    """For each segment its number and the edges (0 to 1) of its bins, the same for all trials."""
    lengths = np.median([[piece.last - piece.first for piece in raw.pieces] for raw in group], axis=0)
    share = np.sqrt(lengths) / np.sqrt(lengths).sum()
    out = []
    for number, (length, part) in enumerate(zip(lengths, share, strict=True)):
        edges = fractions(bin_sizes(max(int(length), 1), max(LEAST_BINS, int(rows * part))))
        out.append((number, _finer_at_contact(edges, group[0], number)))
    return out


def _finer_at_contact(edges: Array, raw: RawTrial, number: int) -> Array:
    """Edges with bins near zero depth split, since the mean force over a bend is not the force of the mean depth."""
    piece, peak = raw.pieces[number], float(raw.depth.max())
    marks = piece.first + edges * (piece.last - 1 - piece.first)
    depth = np.interp(marks, np.arange(raw.depth.size), raw.depth) / peak
    parts = []
    for k, (low, high) in enumerate(pairwise(depth)):
        near = min(low, high) < NEAR[1] and max(low, high) > NEAR[0]
        count = int(np.ceil(abs(high - low) / SPAN)) if near else 1
        parts.append(np.linspace(edges[k], edges[k + 1], max(count, 1), endpoint=False))
    return np.concatenate([*parts, edges[-1:]])


@dataclass(frozen=True, eq=False)
class Binned:
    """Rows (n, 3 + C) of time, depth, acceleration and signals; samples (n, C) in them; mean time (n,) of frames."""

    rows: Array
    count: Array
    frame_time: Array


def _binned(
    raw: RawTrial, plan: Sequence[tuple[int, Array]], grid: Layout | None, seen: NDArray[np.bool_] | None
) -> Binned:
    table = np.column_stack([raw.time, raw.depth, raw.acceleration, raw.force])
    parts = [bin_means(table, raw.pieces[k].first, raw.pieces[k].last, edges) for k, edges in plan]
    rows, samples = _rising(np.concatenate([p[0] for p in parts])), np.concatenate([p[1] for p in parts])
    if grid is None:
        return Binned(rows, samples[:, None], rows[:, 0])
    missing = np.full((samples.size, len(grid.names)), np.nan)
    if raw.markers is None or raw.frames is None:
        nothing = np.zeros_like(missing)
        return Binned(np.hstack([rows, missing]), np.column_stack([samples, nothing]), rows[:, 0])
    signals, frames, moment = frame_means(raw.frames, grid.signals(raw.markers[:, seen]), _edges(raw, plan))
    return Binned(np.hstack([rows, signals]), np.column_stack([samples, *[frames] * len(grid.names)]), moment)


def _edges(raw: RawTrial, plan: Sequence[tuple[int, Array]]) -> Array:
    """Times between the bins of all segments, which follow one another, halfway between raw rows."""
    halfway = 0.5 * (raw.time[1:] + raw.time[:-1])
    borders = np.concatenate([[2 * raw.time[0] - halfway[0]], halfway, [2 * raw.time[-1] - halfway[-1]]])
    marks = [np.array([raw.pieces[plan[0][0]].first])]
    for number, edges in plan:
        piece = raw.pieces[number]
        marks.append(piece.first + np.round(edges[1:] * (piece.last - piece.first)).astype(int))
    return np.asarray(borders[np.concatenate(marks)])


def _rising(rows: Array) -> Array:
    """Times that rise, where bins without rows repeat one."""
    rows[:, 0] = np.maximum.accumulate(rows[:, 0] + 1e-9 * np.arange(len(rows)))
    return rows
