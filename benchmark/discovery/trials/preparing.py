"""From a session to a study: what can be used, aligned row by row, and what a reader must know of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import Array
from benchmark.discovery.trials.cycles import by_cycles
from benchmark.discovery.trials.marker_layout import Layout, layout
from benchmark.discovery.trials.printed_grid import printed_grid, resting_places
from benchmark.discovery.trials.protocols import by_height, by_protocol, most_odd, specimens
from benchmark.discovery.trials.rows import (
    RawTrial,
    acceleration,
    bin_plan,
    binned,
    depth_step,
    earlier_rows,
    marker_frames,
    no_rows,
    record,
    resting_grid,
)
from benchmark.discovery.trials.segments import (
    FITTED,
    at_steady,
    forced,
    prescribed,
    scatter_of,
    segments,
    stages,
    steadied,
)
from benchmark.discovery.trials.study import ConditionData, Study
from benchmark.errors import InputError
from benchmark.files import Camera, Session, Tissue, Trial, stretched_tissue
from benchmark.files.sessions.specimens import ONE_HEIGHT
from benchmark.models.scenario_effects import measured_height, open_radius, specimen_layers
from benchmark.physics import TrialContext

MOST_RAW = 4000
"""Raw rows of a trial; more are averaged in blocks."""
LEAST_IN_PRESS = 50
"""But not below so many between a fifth and four fifths of the peak: a hold of minutes took all rows, and a press of
0.3 s before it, at 1 kHz, was left with four, over whose bend the mean force is not that of the mean depth."""
MOVES, RESTS = 0.7, 0.02
"""Of the largest speed in air on that way, above which a tool moves there, and below which it rests."""
DRIVEN_BY = '; if the force was prescribed (dead weights, a force loop), say [drive] channel = "force"'
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
        Fewer than three trials (or presses of one long record), more than single ones without motion or force, or
        of a motion that no other has.
    """
    session, split = by_cycles(session)
    warnings = [*session.warnings, *split, *_few(session)]
    rows = min(rows, max(LEAST_IN_TRIAL, MOST_IN_ALL // len(session.trials)))
    raw = _usable(session, warnings)
    groups = [[r for r in raw if r.trial.condition == name] for name in session.conditions]
    parts = [part for group in groups if group for part in by_height(group, warnings)]
    kept = [each for part in parts for each in by_protocol(session.name, part, warnings)]
    camera, seen = session.camera if any(map(_over_hole, session.trials)) else None, _seen(kept)
    grid = None if camera is None else _grid(camera, kept, seen, warnings)
    warnings += [*_held(session), *_told_relaxation(session.specimen)]
    order = {trial.name: number for number, trial in enumerate(session.trials)}
    conditions = tuple(
        _condition(session, group, grid, seen, np.array([order[r.trial.name] for r in group]), rows) for group in kept
    )
    warnings += [*_scatter(raw), *_guided(raw)]
    interval = float(np.median([np.median(np.diff(r.time)) for r in raw]))
    step = float(np.median([_step(r) for r in raw]))
    return Study(
        conditions, grid, camera.distance if camera else None, interval, step, tuple(warnings), session.drive == "force"
    )


def _over_hole(trial: Trial) -> bool:
    return trial.support.kind == "hole"


def _held(session: Session) -> list[str]:
    """That markers of specimens whose lower face does not move are left out."""
    if all(_over_hole(trial) or trial.markers is None for trial in session.trials):
        return []
    return ["the markers of trials without a hole are left out: the lower face, on which they are, is held there"]


def _told_relaxation(specimen: Tissue) -> list[str]:
    """That a relaxation the specimen is told to have is no part of the base."""
    layers = [layer.name for layer in specimen.layers if layer.relaxation]
    if not layers:
        return []
    return [
        f"the relaxation that {', '.join(layers)} is told to have is left out of the base, which is elastic: what acts "
        "of it is found anew, as viscoelastic relaxation, and may be compared with what was told"
    ]


def _scatter(raw: Sequence[RawTrial]) -> list[str]:
    """That depths scatter and were made steady."""
    sizes = [scatter_of(each.trial.table.depth) for each in raw if each.steadied]
    if not sizes:
        return []
    return [
        f"the depth of {len(sizes)} of {len(raw)} trials scatters by {1e6 * np.median(sizes):.2g} um from row to row, "
        "which the force does not follow: strokes and rests were smoothed"
        + (", and the force is as at that depth" if raw[0].by_force else DRIVEN_BY)
    ]


def _guided(raw: Sequence[RawTrial]) -> list[str]:
    """That the force in air goes with the direction of motion, as a guide's friction does, N: told in all trials.

    More than `TOGETHER` standard errors over the trials on the way down and on the way up, of one size within a factor
    of two, and more than a force is right to anyway.
    """
    found = np.array([each for trial in raw if (each := _direction_in_air(trial)) is not None])
    if len(found) < criteria.LEAST_TRIALS:
        return []
    mean, error = found.mean(axis=0), found.std(axis=0, ddof=1) / np.sqrt(len(found))
    peak = float(np.median([np.ptp(each.force) for each in raw]))
    if (
        np.any(mean <= np.maximum(criteria.TOGETHER * error, criteria.LEAST_FORCE * peak))
        or mean.max() > 2 * mean.min()
    ):
        return []
    return [
        f"before the touch and after lift-off, in air, the force is {mean.mean():.2g} N (give or take "
        f"{error.mean():.1g}) higher while the tool moves down and as much lower while it moves up: the bench's own "
        "friction, of a guide, not the tissue's. It is in all forces and was not taken off: it may be what stands as a "
        "dry friction, or as outside the catalogue"
    ]


def _direction_in_air(raw: RawTrial) -> tuple[float, float] | None:
    """By how much the force is higher as a tool moves down in air, and lower as it moves up, N; None where unseen.

    Beside a level and a drift: each way against the rest beside it, or, without these rests, both ways against each
    other. The near half of the way up is left out, in which a surface may hold the tool.
    """
    ahead, back = (np.clip(np.arange(raw.time.size) + way, 0, raw.time.size - 1) for way in (2, -2))
    speed = (raw.depth[ahead] - raw.depth[back]) / (raw.time[ahead] - raw.time[back])
    air = raw.depth < -criteria.EARLY_TOUCH * raw.depth.max()
    if not air.any():
        return None
    most = [float(np.clip(sign * speed[air], 1e-300, None).max()) for sign in (1.0, -1.0)]
    fast = np.abs(speed) / np.where(speed > 0.0, *most)
    air &= ((fast > MOVES) | (fast < RESTS)) & ~((speed < 0.0) & (fast > MOVES) & (raw.depth > 0.5 * raw.depth.min()))
    way = np.where(fast > MOVES, np.sign(speed), 0.0)
    pressed = np.flatnonzero(raw.depth >= 0.0)
    place = np.arange(raw.time.size)
    before, after = air & (place < pressed[0]) & (way >= 0.0), air & (place > pressed[-1]) & (way <= 0.0)
    sides = [(before, 1.0), (after, -1.0)]
    if all(min((side & (way == sign)).sum(), (side & (way == 0.0)).sum()) >= FITTED for side, sign in sides):
        return _along(raw, before, way), _along(raw, after, way)
    if min((air & (way == sign)).sum() for sign in (1.0, -1.0)) < FITTED:
        return None
    both = _along(raw, air, way)
    return both, both


def _along(raw: RawTrial, rows: NDArray[np.bool_], way: Array) -> float:
    """Force over direction (n,) in some rows, N, beside a level and a drift."""
    columns = np.column_stack([np.ones(int(rows.sum())), raw.time[rows] - raw.time[rows].mean(), way[rows]])
    return float(np.linalg.lstsq(columns, raw.force[rows], rcond=None)[0][2])


def _step(raw: RawTrial) -> float:
    """The smallest change that a trial's depth shows, m: of one made steady a deviation of what it scattered by."""
    read = raw.trial.table.depth
    return scatter_of(read) if raw.steadied else depth_step(read)


def _few(session: Session) -> list[str]:
    """What few trials cannot show; a session of cylinders is refused."""
    count = len(session.trials)
    if any(trial.support.cylinder for trial in session.trials):
        raise InputError(
            f"session {session.name}: a cylinder between plates or grips (support.kind); discover looks for what the "
            "press of a tool lacks. Allowed here: run --trials and fit, which set finite elements beside the trials."
        )
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
    """The combinations of the markers (m,) that all trials saw, at their own resting places; None without any."""
    if seen is None:
        warnings.append("[camera] is given, but no four markers are seen in all trials: force alone is compared")
        return None
    if not seen.all():
        warnings.append(f"{int((~seen).sum())} markers were not seen often enough and are left out")
    positions = np.array([r.markers for group in groups for r in group if r.markers is not None][:1])
    nominal = resting_grid(camera, positions)[seen]
    printed = printed_grid(camera, nominal, resting_places([raw for group in groups for raw in group], seen))
    plain = replace(
        layout(nominal, camera.marker_spacing),
        scale_error=printed.scale_error,
        lens=printed.lens,
        lens_error=printed.lens_error,
    )
    if printed.exact:
        return plain
    warnings.append(printed.remark)
    off = printed.centre_error / float(np.sqrt(np.sum(printed.places**2, axis=1).max()))
    return replace(plain, rest=printed.places, origin=printed.origin, zeros=plain.names, centre_error=off)


def _usable(session: Session, warnings: list[str]) -> list[RawTrial]:
    """The trials in which a tool presses; single others are set aside and named."""
    found: list[RawTrial] = []
    refused: list[InputError] = []
    for trial in session.trials:
        try:
            found.append(_raw(session, trial, warnings))
        except InputError as error:
            refused.append(error)
    if refused and (len(refused) > most_odd(len(session.trials)) or len(found) < criteria.LEAST_TRIALS):
        raise refused[0]
    warnings += [f"left out: {error}" for error in refused]
    return found


def _raw(session: Session, trial: Trial, warnings: list[str]) -> RawTrial:
    table = trial.table
    place = f"session {session.name}, trial {trial.name}"
    if float(np.ptp(table.depth)) < criteria.LEAST_TRAVEL:
        raise InputError(f"{place}: no motion, depth_mm stays at {1e3 * table.depth[0]:.4g}; the tool must press.")
    if float(np.ptp(table.force)) <= 0.0:
        raise InputError(f"{place}: force_N does not change; depth without force tells nothing of the tissue.")
    if table.depth.max() <= 0.0:
        raise InputError(f"{place}: depth_mm never rises above 0, so the tool never presses.")
    time, read, force = _decimated(table.time, table.depth, table.force)
    by_force = session.drive == "force"
    held = forced(time, force) if by_force else []
    depth = steadied(time, read, force, held)
    interval = np.diff(time)
    if interval.max() > criteria.LONG_GAP * np.median(interval):
        warnings.append(f"trial {trial.name}: a gap of {interval.max():.3g} s between rows; nothing is filled in")
    led = prescribed(force) if by_force else depth
    pieces = tuple(held if by_force else segments(time, depth))
    if not any(piece.kind == "press" for piece in pieces):
        what = "force" if by_force else "depth"
        raise InputError(f"{place}: the {what} never rises by a tenth of its range; a press is needed.")
    seen = marker_frames(trial, session.camera) if session.camera is not None and _over_hole(trial) else None
    frames, markers = seen if seen is not None else (None, None)
    rate, earlier, steady = acceleration(time, depth), _before(trial, by_force), depth is not read
    shown = at_steady(force, read, depth) if by_force and steady else force
    return RawTrial(trial, time, depth, shown, rate, frames, markers, pieces, led, by_force, steady, earlier)


def _before(trial: Trial, by_force: bool) -> Array:
    """(k, 2) times and depths of the record before a trial that is cut from it; none where a trial is all of it."""
    if trial.earlier is None:
        return no_rows()
    time, depth, force = _decimated(trial.earlier.time, trial.earlier.depth, trial.earlier.force)
    return earlier_rows(time, steadied(time, depth, force, forced(time, force) if by_force else ()))


def _decimated(*columns: Array) -> list[Array]:
    """Time, depth and more (n,) in blocks' means."""
    block = min(-(-columns[0].size // MOST_RAW), max(_rows_in_press(columns[1]) // LEAST_IN_PRESS, 1))
    if block == 1:
        return [np.asarray(column, dtype=float) for column in columns]
    whole = columns[0].size // block * block
    return [np.asarray(column[:whole].reshape(-1, block).mean(axis=1)) for column in columns]


def _rows_in_press(depth: Array) -> int:
    """Rows of the first way from a fifth to four fifths of the peak."""
    peak = float(depth.max())
    last = int(np.argmax(depth >= 0.8 * peak))
    before = np.flatnonzero(depth[:last] <= 0.2 * peak)
    return last - int(before[-1]) if before.size else last


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
        specimen=_pressed(session, group),
        tool=first.tool,
        support=first.support,
        trials=tuple(raw.trial.name for raw in group),
        numbers=numbers,
        time=data[..., 0] - data[:, :1, 0],
        depth=data[..., 1],
        acceleration=data[..., 2],
        records=tuple(record(raw, plan, begin) for raw, begin in zip(group, data[:, 0, 0], strict=True)),
        signals=data[..., 3:],
        count=np.array([one.count for one in means]),
        frame_time=np.array([one.frame_time for one in means]) - data[:, :1, 0],
        phase=phase,
        cycle=cycle,
        part=part,
        around=_context(session, group, data, grid),
        specimens=specimens(group),
    )


def _pressed(session: Session, group: Sequence[RawTrial]) -> Tissue:
    """The specimen of a condition: in the middle of its trials' heights, or the session's where these fall apart."""
    heights = [height for raw in group if (height := raw.trial.height) is not None]
    if len(heights) < len(group) or max(heights) > ONE_HEIGHT * min(heights):
        return session.specimen
    return stretched_tissue(session.specimen, float(np.median(heights)))


def _context(session: Session, group: Sequence[RawTrial], data: Array, grid: Layout | None) -> TrialContext:
    """What effects may know of a condition with rows (R, n, 3 + C)."""
    first, specimen = group[0].trial, _pressed(session, group)
    return TrialContext(
        tool_radius=first.tool.radius,
        thickness=measured_height(specimen.thickness, first.support, first.tool.radius),
        peak_depth=float(data[..., 1].max()),
        peak_force=float(np.median(np.ptp(data[..., 3], axis=1))),
        duration=float((data[:, -1, 0] - data[:, 0, 0]).max()),
        spacing=session.camera.marker_spacing if session.camera and grid is not None else 0.0,
        markers=None if grid is None else grid.rest,
        hole_radius=open_radius(first.support),
        layers=specimen_layers(specimen.layers),
        contact=first.tool.contact,
        edge_radius=first.tool.edge_radius or 0.0,
    )
