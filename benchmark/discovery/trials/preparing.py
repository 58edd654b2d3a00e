"""From a session to a study: what can be used, aligned row by row, and what a reader must know of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import Array
from benchmark.discovery.trials.marker_layout import Layout, layout
from benchmark.discovery.trials.rows import (
    RawTrial,
    acceleration,
    bin_plan,
    binned,
    marker_frames,
    resting_grid,
)
from benchmark.discovery.trials.segments import segments, stages
from benchmark.discovery.trials.study import ConditionData, Study
from benchmark.errors import InputError
from benchmark.files import Camera, Session, Trial
from benchmark.models.scenario_effects import open_radius, specimen_layers
from benchmark.physics import TrialContext

MOST_RAW = 4000
"""Raw rows of a trial; more are averaged in blocks."""
MOST_IN_ALL, LEAST_IN_TRIAL = 2400, 40
"""Rows of all trials together, and of a trial where there are very many."""


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
    warnings = [*session.warnings, *_few(session)]
    rows = min(rows, max(LEAST_IN_TRIAL, MOST_IN_ALL // len(session.trials)))
    raw = [_raw(session, trial, warnings) for trial in session.trials]
    groups = [[r for r in raw if r.trial.condition == name] for name in session.conditions]
    kept = [_same_protocol(session, group, warnings) for group in groups]
    camera, seen = session.camera, _seen(kept)
    grid = None if camera is None else _grid(camera, kept, seen, warnings)
    order = {id(trial): number for number, trial in enumerate(session.trials)}
    conditions = tuple(
        _condition(session, group, grid, seen, np.array([order[id(r.trial)] for r in group]), rows)
        for group in kept
        if group
    )
    interval = float(np.median([np.median(np.diff(r.time)) for r in raw]))
    return Study(conditions, grid, camera.distance if camera else None, interval, tuple(warnings))


def _few(session: Session) -> list[str]:
    """What few trials cannot show."""
    count = len(session.trials)
    if count < criteria.LEAST_TRIALS:
        raise InputError(
            f"session {session.name}: {count} trial(s); at least {criteria.LEAST_TRIALS} are needed to tell a "
            f"disagreement from chance, and {criteria.ENOUGH_TRIALS} to show it at the 5 % level."
        )
    if count < criteria.ENOUGH_TRIALS:
        return [f"{count} trials: sign flips of so few cannot reach the 5 % level, so nothing can be shown"]
    return []


def _grid(
    camera: Camera, groups: Sequence[Sequence[RawTrial]], seen: NDArray[np.bool_] | None, warnings: list[str]
) -> Layout | None:
    """The combinations of the markers (m,) that all trials saw; None without any."""
    if seen is None:
        warnings.append("[camera] is given, but no four markers are seen in all trials: force alone is compared")
        return None
    if not seen.all():
        warnings.append(f"{int((~seen).sum())} markers were not seen often enough and are left out")
    positions = np.array([r.markers for group in groups for r in group if r.markers is not None][:1])
    return layout(resting_grid(camera, positions)[seen], camera.marker_spacing)


def _raw(session: Session, trial: Trial, warnings: list[str]) -> RawTrial:
    table = trial.table
    place = f"session {session.name}, trial {trial.name}"
    if float(np.ptp(table.depth)) < criteria.LEAST_TRAVEL:
        raise InputError(f"{place}: no motion, depth_mm stays at {1e3 * table.depth[0]:.4g}; the tool must press.")
    if float(np.ptp(table.force)) <= 0.0:
        raise InputError(f"{place}: force_N does not change; depth without force tells nothing of the tissue.")
    if table.depth.max() <= 0.0:
        raise InputError(f"{place}: depth_mm never rises above 0, so the tool never presses.")
    time, depth, force = _decimated(table.time, table.depth, table.force)
    interval = np.diff(time)
    if interval.max() > criteria.LONG_GAP * np.median(interval):
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
    odd = [raw.trial.name for raw, one in zip(group, fitted, strict=True) if one is None]
    _check_protocol(session, group, kept)
    if odd:
        warnings.append(
            f"condition {group[0].trial.condition}: left out for another motion than the others': {', '.join(odd)}"
        )
    return kept


def _check_protocol(session: Session, group: Sequence[RawTrial], kept: Sequence[RawTrial]) -> None:
    """Refuse a condition whose trials differ in more than chance in motion, speed, or both depth and force."""
    peaks = np.array([raw.depth.max() for raw in kept])
    speeds = np.array([_speed(raw) for raw in kept])
    forces = np.array([np.ptp(raw.force) for raw in kept])
    deep = min(_ratio(peaks), _ratio(forces)) > criteria.PROTOCOL_SPREAD
    wide = deep or _ratio(speeds) > criteria.PROTOCOL_SPREAD
    if len(group) - len(kept) > criteria.MOST_ODD * len(group) or wide:
        raise InputError(
            f"session {session.name}, condition {group[0].trial.condition}: trials of different protocols "
            f"({len(group)} trials; peak depth {1e3 * peaks.min():.3g} to {1e3 * peaks.max():.3g} mm, speed "
            f"{1e3 * speeds.min():.3g} to {1e3 * speeds.max():.3g} mm/s); give each protocol a condition of its own."
        )


def _ratio(values: Array) -> float:
    return float(values.max() / values.min())


def _speed(raw: RawTrial) -> float:
    piece = next(piece for piece in raw.pieces if piece.kind == "press")
    last = min(piece.last, raw.time.size - 1)
    return float(abs(raw.depth[last] - raw.depth[piece.first]) / max(raw.time[last] - raw.time[piece.first], 1e-9))


def _timed_like(raw: RawTrial, model: RawTrial) -> RawTrial | None:
    """A trial with the segments of another by their times, if its motion is the same."""
    duration, other = np.ptp(raw.time), np.ptp(model.time)
    if abs(duration / other - 1.0) > criteria.PROTOCOL_TIME:
        return None
    shown = np.interp(model.time - model.time[0], raw.time - raw.time[0], raw.depth)
    if np.abs(shown - model.depth).max() > criteria.PROTOCOL_DEPTH * np.ptp(model.depth):
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
    return seen if seen.sum() >= criteria.LEAST_MARKERS else None


def _condition(
    session: Session,
    group: Sequence[RawTrial],
    grid: Layout | None,
    seen: NDArray[np.bool_] | None,
    numbers: NDArray[np.int64],
    rows: int,
) -> ConditionData:
    """The trials of a condition row by row; `numbers` are their places in the session."""
    plan = bin_plan(group, rows)
    means = [binned(raw, plan, grid, seen) for raw in group]
    data = np.array([one.rows for one in means])
    kinds = np.concatenate([[piece] * (edges.size - 1) for piece, edges in plan]).astype(int)
    phase, cycle, part = stages(group[0].pieces, kinds, np.median(data[..., 1], axis=0))
    first = group[0].trial
    return ConditionData(
        name=first.condition,
        tool=first.tool,
        support=first.support,
        trials=tuple(raw.trial.name for raw in group),
        numbers=numbers,
        time=data[..., 0] - data[:, :1, 0],
        depth=data[..., 1],
        acceleration=data[..., 2],
        signals=data[..., 3:],
        count=np.array([one.count for one in means]),
        frame_time=np.array([one.frame_time for one in means]) - data[:, :1, 0],
        phase=phase,
        cycle=cycle,
        part=part,
        around=_context(session, first, data, grid),
    )


def _context(session: Session, first: Trial, data: Array, grid: Layout | None) -> TrialContext:
    """What effects may know of a condition with rows (R, n, 3 + C)."""
    return TrialContext(
        tool_radius=first.tool.radius,
        thickness=_finite(session.specimen.thickness),
        peak_depth=float(data[..., 1].max()),
        peak_force=float(np.median(np.ptp(data[..., 3], axis=1))),
        duration=float((data[:, -1, 0] - data[:, 0, 0]).max()),
        spacing=session.camera.marker_spacing if session.camera and grid is not None else 0.0,
        markers=None if grid is None else grid.rest,
        hole_radius=open_radius(first.support),
        layers=specimen_layers(session.specimen.layers),
        contact=first.tool.contact,
    )


def _finite(thickness: float) -> float:
    return thickness if np.isfinite(thickness) else 0.05
