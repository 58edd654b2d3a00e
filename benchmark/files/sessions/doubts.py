"""Remarks on the numbers of single trials and of their markers: a glitch, a sensor's end, signs, units and origins."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from bench_hw.tables import MarkerTable, TrialTable, calm
from benchmark.errors import InputError
from benchmark.files.sessions.description import Camera, Drive, SessionFile

STANDS: Final = 0.1
"""Share of the travel over which a force that does not change by one digit is no tissue's."""
TURNED: Final = 0.2
"""Of the way down that a press with its signs turned goes up at most."""
STRAIGHT: Final = 0.1
"""Of the force's range, from its middle, at half the depth, within which a curve is as good as straight."""
LEVELS: Final = 20
"""Values of the upper half of a force, below which its digits are too coarse to tell that it stands."""


def doubtful_forces(names: Sequence[str], tables: Sequence[TrialTable]) -> list[str]:
    """A warning for each trial whose force no tissue makes: a glitch of single rows, a sensor's end, signs turned."""
    turned = [(name, table) for name, table in zip(names, tables, strict=True) if _upside_down(table)]
    said = [_turned(turned)] if turned else []
    for name, table in zip(names, tables, strict=True):
        if any(table is each for _, each in turned):
            continue
        lone = np.flatnonzero(calm(table.force) != table.force)
        if len(lone):
            row = int(lone[0])
            said.append(
                f"{name}: the force is {table.force[row]:g} N at {table.time[row]:.6g} s, in a single row far beyond "
                f"all others (such rows: {len(lone)}): a glitch, which the fit takes for the press; take the row out"
            )
        elif (way := _standing(table)) > 0.0:
            said.append(
                f"{name}: the force stands at {table.force.max():g} N, its largest value, while the depth goes on over "
                f"{1e3 * way:.3g} mm: at the end of the sensor's range? What is fitted is then too soft"
            )
    return said


HELD_AT, HELD_WITHIN = 0.2, 0.01
"""Share of a force's range, from its least, above which a hold of it is one, and within which it then stands."""
CREEPS, ABOVE_FORCE, SLOWER = 0.02, 10.0, 1.5
"""Share of its travel by which a depth creeps under a force that stands, between the means of a hold's first and last
quarter, times the share by which that force moves meanwhile, and times its pace at the end that at the beginning is: a
plateau of foam and a sensor at its end are passed at one speed."""
SURE_CREEP, LEAST_HELD = 5.0, 24
"""Standard errors by which it creeps to the end, where a depth that was driven there stands; rows of such a hold."""
CREEPING, MOST_HOLDS = 3, 0.75
"""Trials, and share of those in which the force is held, that must show it for its force to be the prescribed one."""


def force_driven(tables: Sequence[TrialTable]) -> bool | None:
    """Whether the rig prescribed the force: held, it stands while the depth creeps on, ever slower; None if in some.

    Nothing tells where the tissue does not creep: then both stand in a hold, whichever was prescribed.
    """
    held = [creeps for table in tables if (creeps := _creeps_under_force(table)) is not None]
    if not any(held):
        return False
    return True if sum(held) >= max(CREEPING, MOST_HOLDS * len(held)) else None


def with_drive(file: SessionFile, tables: Sequence[TrialTable]) -> tuple[SessionFile, list[str]]:
    """The session, driven by force where its trials surely show that and nobody says so; and a warning."""
    found = False if "channel" in file.drive.model_fields_set else force_driven(tables)
    if found is False:
        return file, []
    if found is None:
        return file, [
            "in some trials the force stands while the depth creeps on, as under a prescribed force (dead weights, a "
            'force loop): say [drive] channel = "force", or "depth", as which all are taken'
        ]
    return file.model_copy(update={"drive": Drive(channel="force")}), [
        "the force stands while the depth creeps on: taken for prescribed, the depth for its answer (dead weights, a "
        'force loop); say [drive] channel = "force", or "depth" if that was prescribed'
    ]


def _creeps_under_force(table: TrialTable) -> bool | None:
    """Whether in the longest hold of the force the depth goes on, surely and slower to the end; None without a hold."""
    first, last = force_hold(table.force)
    if last - first < LEAST_HELD:
        return None
    depth, force = (_quarters(values[first:last]) for values in (table.depth, table.force))
    moved = abs(float(force[-1] - force[0])) / float(np.ptp(table.force))
    steps, scatter = np.diff(depth), float(np.std(np.diff(table.depth[first:last], 2))) / 6.0**0.5
    surely = bool((steps > SURE_CREEP * scatter * (8.0 / (last - first)) ** 0.5).all())
    share = float(depth[-1] - depth[0]) / max(float(np.ptp(table.depth)), 1e-300)
    return surely and share >= max(CREEPS, ABOVE_FORCE * moved) and bool(steps[0] >= SLOWER * steps[-1])


def force_hold(force: NDArray[np.float64]) -> tuple[int, int]:
    """First row, and that behind the last, of the longest run in which a pressing force (n,) stands; 0, 0 without."""
    span = max(float(np.ptp(force)), 1e-300)
    mean = np.convolve(np.pad(force, 2, mode="edge"), np.ones(5) / 5.0, "valid")
    share = (mean - force.min()) / span
    counts = np.bincount(np.round(share[share > HELD_AT] / HELD_WITHIN).astype(int), minlength=1)
    if not counts.any():
        return 0, 0
    near = np.abs(share - HELD_WITHIN * int(np.argmax(counts))) <= 1.5 * HELD_WITHIN
    edges = np.flatnonzero(np.diff(np.concatenate([[False], near, [False]]).astype(int)))
    first, last = max(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True), key=lambda run: run[1] - run[0])
    quarters = _quarters(force[first:last]) if last - first >= 4 else np.array([0.0, span])
    return (first, last) if abs(float(quarters[-1] - quarters[0])) <= 0.5 * HELD_WITHIN * span else (0, 0)


def _quarters(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(4,) means of the quarters of values (n,)."""
    return np.array([part.mean() for part in np.array_split(values, 4)])


EITHER_WAY: Final = (
    '--set import.force="force_N:N" --set import.depth="depth_mm:mm" finds out from each file which way is pressing'
)
"""What to write for trial tables whose signs are turned, in all files or in some."""


def _turned(trials: Sequence[tuple[str, TrialTable]]) -> str:
    """What to say of trials upside down, by the first of them."""
    name, table = trials[0]
    force, depth = float(table.force.min()), float(table.depth.min())
    others = [each for each, _ in trials[1:]]
    too = f" (so do {_listed(others)})" if others else ""
    return (
        f"{name}: force and depth only fall, to {force:.4g} N and {1e3 * depth:.4g} mm, as where pressing is "
        f"negative{too}; allowed: press positive. It is used as it is; {EITHER_WAY}"
    )


SLOW_ROWS, SLOW_PRESS = 1.0, 5e-6
"""Seconds between rows, and m/s, beyond which times may be in ms: a press of 5 mm/s, or slower, sampled at 1 kHz."""
NEAR_DEEPEST: Final = 0.95
"""Of the largest depth, where a press has ended and a hold begins, whose noise reaches the largest depth anywhere."""


def doubtful_times(names: Sequence[str], tables: Sequence[TrialTable]) -> list[str]:
    """A warning of trials so slow, with so few rows a second, that their times may be milliseconds."""
    found = []
    for name, table in zip(names, tables, strict=True):
        step, lasts = float(np.median(np.diff(table.time))), float(np.ptp(table.time))
        deepest = int(np.argmax(table.depth >= NEAR_DEEPEST * table.depth.max()))
        way = float(table.depth[deepest] - table.depth[: deepest + 1].min())
        if step >= SLOW_ROWS and way < SLOW_PRESS * (table.time[deepest] - table.time[0]):
            found.append(f"{name} ({step:.3g} s from row to row, {lasts:.4g} s in all)")
    if not found:
        return []
    return [f"times may be milliseconds where seconds are read: {_listed(found)}"]


TWO_KINDS, CLOSER = 1.25, 3.0
"""Fold between the peak forces of two kinds of trials, and times the spread within either, from which they are two."""


def doubtful_kinds(names: Sequence[str], tables: Sequence[TrialTable], conditions: Sequence[str]) -> list[str]:
    """A warning for each condition whose trials, which move alike, are of two kinds by their peak force."""
    said = []
    for condition in dict.fromkeys(conditions):
        mine = [k for k, each in enumerate(conditions) if each == condition and np.ptp(tables[k].force) > 0.0]
        peaks = sorted((float(np.ptp(tables[k].force)), names[k]) for k in mine)
        gaps = np.diff(np.log([peak for peak, _ in peaks]))
        split = int(np.argmax(gaps)) + 1 if gaps.size else 0
        spread = sum(np.log(each[-1][0] / each[0][0]) for each in (peaks[:split], peaks[split:]) if each)
        if not 2 <= split <= len(peaks) - 2 or gaps[split - 1] < max(np.log(TWO_KINDS), CLOSER * spread):
            continue
        weak, strong = peaks[:split], peaks[split:]
        said.append(
            f"{condition}: {len(weak)} trials reach {weak[0][0]:.3g} to {weak[-1][0]:.3g} N ({weak[0][1]}, ...) and "
            f"{len(strong)} that move alike {strong[0][0]:.3g} to {strong[-1][0]:.3g} N ({strong[0][1]}, ...): another "
            "tool or specimen? Give them a condition of their own"
        )
    return said


def pressed_negative(table: TrialTable) -> bool:
    """Whether a press surely has both its signs turned: it only falls, and most where the depth is least.

    A record that begins pressed and ends in air falls, too, but its force changes where the depth is largest. Where a
    straight line tells neither, the force itself does, which is hardly above zero where pressing is negative.
    """
    if not _upside_down(table):
        return False
    low, span = float(table.depth.min()), float(np.ptp(table.depth))
    away = [np.abs(table.depth - (low + share * span)) for share in (0.0, 0.5, 1.0)]
    least, middle, most = (float(np.median(table.force[each <= max(0.1 * span, each.min())])) for each in away)
    bent = (middle - least) / (most - least) - 0.5 if most > least else -0.5
    return bent > STRAIGHT or (bent > -STRAIGHT and float(table.force.max()) < TURNED * -float(table.force.min()))


def _upside_down(table: TrialTable) -> bool:
    """Whether force and depth leave where they began downwards, and not a fifth as far upwards."""
    few = max(5, len(table.force) // 50)
    moved = [values - float(np.median(values[:few])) for values in (table.force, table.depth)]
    return all(float(each.max()) < TURNED * -float(each.min()) for each in moved)


def _standing(table: TrialTable) -> float:
    """The longest way (m) over which the force stays at its largest value to the last digit; 0 where it is no more."""
    peak = float(table.force.max())
    if len(np.unique(table.force[table.force > 0.5 * peak])) < LEVELS:
        return 0.0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], table.force == peak, [False]]).astype(int)))
    spans = zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
    way = max(float(np.ptp(table.depth[first:last])) for first, last in spans)
    return way if way > STANDS * float(np.ptp(table.depth)) else 0.0


OFF_SPACING: Final = 0.2
"""Of the spacing told, by which markers at rest may be nearer or farther apart: a poor scale, no other unit."""
LENGTHS: Final = {"inch": 1.0 / 25.4, "cm": 0.1, "m": 1e-3, "um": 1e3}
"""Numbers of other units among mm, in mm as they are read, for each mm that they mean."""
LEAST_PICTURES: Final = 6
"""Pictures within the trial's time below which a fit has no use for its markers."""
FAR_LONGER: Final = 100.0
"""Times the trial's duration that markers by the second or slower last only where they are in milliseconds."""
MIRRORED: Final = 1.1
"""Times as well as turned alone that a grid fits mirrored where it is; one row fits both ways."""
AT_EDGE: Final = 0.9
"""Of half the grid's size, from its middle, beyond which the origin of its places is no tool's axis."""


def check_markers(trial: TrialTable, markers: MarkerTable, camera: Camera) -> None:
    """Refuse markers in another unit than mm, or at other times than their trial.

    Raises
    ------
    InputError
        Markers at rest (first seen) are not as far from their neighbours as `camera` tells; they last far longer than
        the trial; or, on one clock, fewer than `LEAST_PICTURES` of more lie within its time.
    """
    rest, printed = _at_rest(markers, camera)
    if len(rest) > 1:
        apart = float(np.median(_to_next(rest)) / np.median(_to_next(printed))) * camera.marker_spacing
        if abs((ratio := apart / camera.marker_spacing) - 1.0) > OFF_SPACING:
            raise InputError(
                f"{markers.source}: x_mm, y_mm: markers at rest are {1e3 * apart:.4g} mm apart, camera.marker_spacing "
                f"tells {1e3 * camera.marker_spacing:.4g} mm ({_unit(ratio)}?); allowed: x_mm and y_mm in mm, "
                f"and marker_spacing as printed, within {100 * OFF_SPACING:.0f} %."
            )
    times = np.unique(markers.time)
    begin, end = float(trial.time[0]), float(trial.time[-1])
    inside = int(((times >= begin) & (times <= end)).sum())
    thousandfold = np.ptp(times) > FAR_LONGER * (end - begin) and np.median(np.diff(times)) >= SLOW_ROWS
    if thousandfold or (camera.clock == "shared" and inside < min(LEAST_PICTURES, len(times))):
        asked = "milliseconds?" if thousandfold else 'another clock? Then camera.clock = "press" finds it'
        raise InputError(
            f"{markers.source}: time_s: markers from {times[0]:.6g} to {times[-1]:.6g} s, the trial from {begin:.6g} "
            f"to {end:.6g} s: {inside} of {len(times)} pictures lie within it ({asked}); allowed: seconds on the "
            "trial's clock."
        )


def doubtful_markers(names: Sequence[str], tables: Sequence[MarkerTable], camera: Camera) -> list[str]:
    """Warnings of grids whose middle is far from the origin of their places, the tool's axis, or that are mirrored."""
    away, mirrored = {}, []
    for name, table in zip(names, tables, strict=True):
        rest, printed = _at_rest(table, camera)
        low, high = rest.min(axis=0, initial=np.inf), rest.max(axis=0, initial=-np.inf)
        reach = np.maximum(high - low, camera.marker_spacing)
        if len(rest) and (np.abs(low + high) > AT_EDGE * reach).any():
            away[name] = 0.5e3 * (low + high)
        seen, grid = ((each - each.mean(axis=0)) @ [1.0, 1.0j] for each in (rest, printed))
        if len(rest) > 2 and abs(np.sum(grid * seen)) > MIRRORED * abs(np.vdot(grid, seen)):
            mirrored.append(name)
    said = []
    if away:
        x, y = next(iter(away.values()))
        said.append(
            f"{_listed(list(away))}: the middle of the markers is at ({x:.3g}, {y:.3g}) mm, so that the origin of x_mm "
            "and y_mm, which the tool's axis is taken to meet, is at the grid's edge or beyond; allowed: x_mm and y_mm "
            "from the tool's axis"
        )
    if mirrored:
        said.append(
            f"{_listed(mirrored)}: the markers' grid is mirrored (x and y exchanged, or one turned?); allowed: "
            "numbered row by row from 0, x along the rows and y from row to row"
        )
    return said


def _listed(names: Sequence[str]) -> str:
    """The first three of many names."""
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def _unit(ratio: float) -> str:
    """What may have been taken for mm: the unit that makes the ratio one, else pixels or another spacing."""
    found = [name for name, each in LENGTHS.items() if abs(ratio / each - 1.0) <= OFF_SPACING]
    return found[0] if found else "pixels, or another grid"


def _at_rest(markers: MarkerTable, camera: Camera) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(k, 2) places, m, of the grid's markers where each was first seen, and where they are on the grid as told."""
    numbers, first = np.unique(markers.marker, return_index=True)
    mine = numbers < camera.marker_rows * camera.marker_columns
    row, column = np.divmod(numbers[mine], camera.marker_columns)
    rest = np.column_stack([markers.x, markers.y])[first[mine]]
    return rest, camera.marker_spacing * np.column_stack([column, row]).astype(float)


def _to_next(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) distances of places (k, 2) to the nearest of the others."""
    apart = np.hypot(*(places[:, None] - places).T)
    np.fill_diagonal(apart, np.inf)
    return np.asarray(apart.min(axis=0))
