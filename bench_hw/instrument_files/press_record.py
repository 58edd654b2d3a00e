"""A block of columns to the record of a press: its rows and times, which way is pressing, where the tool touches.

Everything that is decided here is said in `notes`; what two signs could be is asked for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import TableError
from bench_hw.instrument_files.blocks import Block
from bench_hw.instrument_files.column_choice import Taken, check_decimal, header_line, kinds, takes
from bench_hw.instrument_files.text_sheet import ONE_UNIT, is_absent, unit_in
from bench_hw.instrument_files.told import AUTOMATIC, KEPT, TARGETS, Told, asking, asking_key, parse_source
from bench_hw.instrument_files.vocabulary import COMPRESSION, DIMENSIONS, MASSES, TENSION, role_of, unit_scale
from bench_hw.tables.columns import LARGEST, check_increasing, check_row_count
from bench_hw.tables.measurement import TrialTable, calm, check_totals
from bench_hw.tables.units import FloatArray

SURE: Final = 6.0
"""Of its noise, above which a force is one."""
BESIDE: Final = 5
"""Written times beside the first or last from which its rows' step is taken, as rows in each differ by one."""
SMALL_TRAVEL: Final = 0.1
"""Of the whole travel, below which the place of the peak force does not tell which way is pressing."""
ALIKE: Final = 0.6
"""Share of the larger of two opposite forces from which on either could be the press."""
OWN_ZERO: Final = 0.05
"""Of the travel: an instrument's own zero that near to the first touch is kept."""
IN_AIR: Final = 0.02
"""Of the travel that must be in air before the touch for the touch to be looked for."""
TOUCH_FORCE: Final = 5e-4
"""Of the peak, which the force must exceed to be a touch, besides four times its noise."""
MOST_MEANT: Final = 0.1
"""Of the rows in air, and of those up to a tenth of the peak, over which a noisy force is averaged at most."""
STEEP: Final = 0.4
"""Of what a parabola rises by that reaches a tenth of the peak, above which a force rises already."""
MEDIANS: Final = 3.2
"""Of the noise's median second difference over the root of the rows: three standard deviations between two medians."""
FEWEST: Final = 4
"""Rows that tell whether a force rises."""


@dataclass(frozen=True, eq=False)
class PressRecord:
    """One trial as read.

    Parameters
    ----------
    name : str
        Of the sheet, group or test; "" where the file holds but one.
    table : TrialTable
        SI, press positive.
    columns : Mapping[str, str]
        Where each quantity stood, with its unit.
    notes : tuple of str
        What was found out or changed, a sentence each.
    kind : str
        press | compression | tension: of a tool on a specimen, or of a block between plates.
    """

    name: str
    table: TrialTable
    columns: Mapping[str, str]
    notes: tuple[str, ...]
    kind: str = "press"


def record_of(block: Block, told: Told) -> PressRecord:
    """Read a block as a trial.

    Raises
    ------
    TableError
        A column, a unit or a sign is missing or can be two things, a cell is no number, time does not increase, or
        there are fewer than 20 rows.
    """
    found = takes(block, told)
    notes = _told_otherwise(block, found, told)
    if "force" not in found or "depth" not in found:
        found = _of_stress(block, found, told)
    if "time" not in found and not told.rate:
        allowed = f"a column of times, {asking('time', 'COLUMN:s')}; or rows per second, {asking_key('rate', '100 Hz')}"
        raise TableError(block.path, f"no column is the time (it has {block.header})", allowed, row=header_line(block))
    rows = _rows(block, found, told, notes)
    check_row_count(block.path, len(rows))
    lines = block.lines[rows]
    values = {role: block.numbers(taken.column, rows) * taken.scale for role, taken in found.items()}
    _check_sizes(block, found, values, lines)
    check_totals(block.path, {block.names[found[role].column]: values[role] for role in found if role != "time"}, lines)
    time = np.arange(len(rows)) / told.rate if told.rate else _times(block.path, values["time"], lines, notes)
    if not told.rate and (clock := block.clock(found["time"].column)):
        notes.append(f"times are counted from its first, {clock}")
        time = time - time[0]
    kind = _kind(block, found, told)
    if kind != "press":
        notes.append(f"this is {kind} of a cylinder or block, not a press of a tool: depth and force are its faces'")
    depth, force = _si_press(found, values, told)
    gripped = replace(told, touch=KEPT) if kind == "tension" and told.touch == AUTOMATIC else told
    table = _pressing(block, found, time, depth, force, values, gripped, notes)
    if kind == "tension" and told.touch == AUTOMATIC:
        table = replace(table, depth=table.depth - table.depth[0])
    shown = {role: taken.shown for role, taken in found.items()}
    return PressRecord(block.name, table, shown, tuple(notes), kind)


def _told_otherwise(block: Block, found: Mapping[str, Taken], told: Told) -> list[str]:
    """What a person told of times and units where the file says something else, and a mass in a force's place."""
    notes = []
    times = [name for name in block.names if name and (meaning := role_of(name)) and meaning[0] == "time"]
    if told.rate and times:
        notes.append(
            f"times are counted at {told.rate:g} Hz, as told, not read from the file's own column {times[0]!r}"
        )
    for role in sorted(found.keys() & told.columns.keys()):
        unit, own = parse_source(role, told.columns[role]).unit, block.units[found[role].column]
        if unit and own and unit_scale(own, DIMENSIONS[found[role].role]) not in (None, found[role].scale):
            notes.append(f"the {role} is read in {unit}, as told, where the file says {own}")
    unit = found["force"].shown.rpartition(" [")[2].rstrip("]") if "force" in found else ""
    if unit in MASSES:
        notes.append(f"the force in {unit} is the weight of that mass: 1 {unit} is {found['force'].scale:.6g} N")
    return notes


def _check_sizes(
    block: Block, found: Mapping[str, Taken], values: Mapping[str, FloatArray], lines: NDArray[np.int64]
) -> None:
    """Refuse times, lengths and forces that no bench measures, as a wrong unit makes them."""
    for role, taken in found.items():
        dimension = DIMENSIONS[taken.role]
        wrong = np.flatnonzero(np.abs(values[role]) > LARGEST.get(dimension, np.inf))
        if len(wrong):
            name = block.names[taken.column]
            allowed = (
                f"up to {LARGEST[dimension]:g} {dimension}; or the unit that was meant, {asking(role, f'{name}:UNIT')}"
            )
            row, value = int(lines[wrong[0]]), f"{values[role][wrong[0]]:g} {dimension}"
            raise TableError(block.path, f"the {role} is too large", allowed, row=row, column=name, value=value)


def _kind(block: Block, found: Mapping[str, Taken], told: Told) -> str:
    """What the words of the file call the test, where it has stress or strain, or a cross-section and no tool."""
    pulled, pressed = TENSION.search(block.spoken), COMPRESSION.search(block.spoken)
    of_faces = told.area is not None and not told.tool and (pulled or pressed)
    if not {"stress", "strain"} & found.keys() and not of_faces:
        return "press"
    return "tension" if pulled and not pressed else "compression"


_BY_PLACE: Final = {"time": "#1:s", "depth": "#2:mm", "force": "#3:N"}


def _of_stress(block: Block, found: dict[str, Taken], told: Told) -> dict[str, Taken]:
    """Stress in the place of a force that is missing, strain in that of a depth, where area and height are known."""
    faces = {"force": "stress", "depth": "strain"}
    lacking = [role for role in faces if role not in found]
    if lacking and not any(block.names):
        unsaid = {role: text for role, text in _BY_PLACE.items() if role not in told.columns}
        own = " ".join(f'--set import.{role}="{text}"' for role, text in unsaid.items())
        maps = " ".join(f"--map {TARGETS[role]}={text}" for role, text in unsaid.items())
        problem = f"the columns have no names (it has {block.header})"
        allowed = f"say which is which, by place and unit: {own} (bench_hw import: --no-header {maps})"
        raise TableError(block.path, problem, allowed, row=header_line(block))
    for role in lacking:
        if faces[role] not in found:
            example = "COLUMN:N" if role == "force" else "COLUMN:mm"
            problem = f"no column is the {'force' if role == 'force' else 'depth (or displacement, gap, position)'}"
            allowed = f"name it, {asking(role, example)}; the file has {block.header}"
            raise TableError(block.path, problem, allowed, row=header_line(block))
    names = " and ".join(faces[role] for role in reversed(lacking))
    needed = {"height": told.height, "area": told.area} if "depth" in lacking else {"area": told.area}
    missing = [key for key, value in needed.items() if value is None]
    if missing:
        examples = {"height": "10 mm", "area": "314 mm^2"}
        allowed = " and ".join(asking_key(key, examples[key]) for key in missing)
        problem = f"{names} need{'s' if len(lacking) == 1 else ''} the specimen's {' and '.join(missing)}"
        raise TableError(block.path, f"{problem}, which no header line tells", allowed, row=header_line(block))
    spare = {faces[role] for role in faces if role not in lacking}
    return {role: taken for role, taken in found.items() if role not in spare}


def _rows(block: Block, found: Mapping[str, Taken], told: Told, notes: list[str]) -> np.ndarray:
    """The rows to read: all but empty ones at the end, and those that lack a number where that was allowed."""
    lacking = np.zeros(block.rows, dtype=bool)
    for taken in found.values():
        lacking |= block.lacking(taken.column)
    last = block.rows - int(np.argmax(~lacking[::-1])) if not lacking.all() else 0
    ended = [k for k in range(last, block.rows) if _empty(block, found, k)]
    within = np.flatnonzero(lacking[: block.rows - len(ended)])
    kept = np.arange(block.rows - len(ended))
    if not len(within):
        return kept
    row = int(within[0])
    taken = next(each for each in found.values() if block.lacking(each.column)[row])
    cell, line = block.columns[taken.column][row], int(block.lines[row])
    check_decimal(block, taken.column, row)
    if told.drop_empty:
        first = f"row {line}, {block.names[taken.column]!r} {str(cell)!r}"
        counted = "1 row" if len(within) == 1 else f"{len(within)} rows"
        left = "is" if len(within) == 1 else "are"
        notes.append(f"{counted} without a number in a column that is needed {left} left out, as told ({first})")
        return np.setdiff1d(kept, within)
    if 2 * len(within) > len(kept):
        problem = f"{len(within)} of {len(kept)} cells of the {taken.role} are no numbers"
        raise TableError(
            block.path, problem, kinds(taken.role), row=line, column=block.names[taken.column], value=str(cell)
        )
    problem, number = "the cell is empty" if cell == "" else "the cell is no finite number", "a number"
    if unit_in(cell, block.decimal) is not None:
        problem, number = "the cell has a unit behind its number, and others have none or another", ONE_UNIT
    allowed = f"{number}; or leave such rows out, {asking_key('drop_empty', 'true')}"
    raise TableError(block.path, problem, allowed, row=line, column=block.names[taken.column], value=str(cell))


def _empty(block: Block, found: Mapping[str, Taken], row: int) -> bool:
    """Whether a row holds nothing in the columns that are needed."""
    cells = [block.columns[taken.column][row] for taken in found.values()]
    return all(cell == "" or is_absent(cell) for cell in cells)


def _times(path: Path, time: FloatArray, lines: np.ndarray, notes: list[str]) -> FloatArray:
    """Times that increase: those that repeat since they were written with few decimals are spread evenly.

    The record begins at its first time. First and last times that stand in fewer rows than the others, as of a record
    that is rounded or ends between two decimals, are spread at the step beside them.
    """
    steps = np.diff(time)
    repeated = int((steps == 0.0).sum())
    if not repeated or (steps < 0.0).any() or repeated > 0.95 * len(steps):
        check_increasing(path, "time", time, lines)
        return time
    first = np.flatnonzero(np.concatenate([[True], steps > 0.0]))
    if np.diff(first).max(initial=1) > 0.01 * len(time) + 20:
        check_increasing(path, "time", time, lines)
    notes.append(f"{repeated} times repeat the one before (written to {np.diff(time[first]).min():g} s): spread")
    knots = np.append(time[first], time[first][-1] + float(np.median(np.diff(time[first]))))
    places = np.append(first, len(time))
    return np.asarray(np.interp(np.arange(len(time)), places, _ends_at_pace(knots, np.diff(places))))


def _ends_at_pace(knots: FloatArray, rows: np.ndarray) -> FloatArray:
    """Knots (g + 1,), s, of times that stand in `rows` (g,), their ends nearer where they stand in fewer rows."""
    out, inner = knots.copy(), rows[1:-1]
    for end, beside, own in ((0, inner[:BESIDE], knots[1:-1]), (-1, inner[::-1][:BESIDE], knots[1:-1][::-1])):
        if len(beside) and rows[end] < np.median(beside):
            pace = (own[len(beside)] - own[0]) / beside.sum()
            out[end] = np.clip(own[0] - pace * rows[end], knots[0], knots[-1])
    return np.asarray(out - (out[0] - knots[0]))


def _si_press(
    found: Mapping[str, Taken], values: Mapping[str, FloatArray], told: Told
) -> tuple[FloatArray, FloatArray]:
    """Travel (n,) m and force (n,) N with the file's signs; of strain and stress those of the specimen's faces."""
    travel = values["depth"] if "depth" in found else values["strain"] * (told.height or 0.0)
    force = values["force"] if "force" in found else values["stress"] * (told.area or 0.0)
    return travel, force


def _pressing(
    block: Block,
    found: Mapping[str, Taken],
    time: FloatArray,
    travel: FloatArray,
    force: FloatArray,
    values: Mapping[str, FloatArray],
    told: Told,
    notes: list[str],
) -> TrialTable:
    """The trial with press positive, its depth counted from the first touch where the record begins in air."""
    moved, pushed = found.get("depth", found.get("strain")), found.get("force", found.get("stress"))
    assert moved is not None
    assert pushed is not None
    way_f = pushed.sign or _force_sign(block, pushed, calm(force))
    way_d = moved.sign or _travel_sign(block, moved, travel, way_f * calm(force))
    if way_f < 0:
        notes.append(f"the force falls as the tool presses: {pushed.shown} is turned")
    if way_d < 0:
        notes.append(f"{moved.role} falls as the tool presses: {moved.shown} is turned")
    depth, force = way_d * travel, way_f * force
    extra = {"gap": values["gap"]} if "gap" in values else {"gap": travel} if moved.role == "gap" else {}
    units = dict.fromkeys(extra, "mm")
    table = TrialTable(time, depth, force, extra, str(block.path), units)
    return _from_touch(table, moved.role, way_d, told, notes)


def _force_sign(block: Block, taken: Taken, force: FloatArray) -> int:
    """+1 where pressing raises the force, -1 where it lowers it; both alike is asked for."""
    base = float(np.median(force[: max(5, len(force) // 50)]))
    up, down = float(force.max() - base), float(base - force.min())
    larger, smaller = max(up, down), min(up, down)
    noise = float(np.median(np.abs(np.diff(force)))) if len(force) > 1 else 0.0
    if smaller > ALIKE * larger and smaller > SURE * noise:
        name = block.names[taken.column]
        problem = f"the force goes as far down ({down:g} N) as up ({up:g} N): which is pressing"
        allowed = asking("force", f"-{name}") + f" where pressing is negative, +{name} where it is positive"
        raise TableError(block.path, problem, allowed, column=name)
    return 1 if up >= down else -1


def _travel_sign(block: Block, taken: Taken, travel: FloatArray, force: FloatArray) -> int:
    """+1 where the tool is deeper at a larger value; a peak of the force where it began is asked for."""
    base = float(np.median(force[: max(5, len(force) // 50)]))
    peak = int(np.argmax(force - base))
    span = float(np.ptp(travel))
    name = block.names[taken.column]
    if span == 0.0:
        allowed = f"the column that moves, {asking('depth', 'COLUMN:mm')}; the file has {block.header}"
        raise TableError(block.path, f"the {taken.role} never changes", allowed, column=name)
    moved = float(travel[peak] - travel[0])
    if abs(moved) < SMALL_TRAVEL * span:
        problem = f"at the largest force the {taken.role} is where it began: which way is pressing"
        allowed = asking("depth", f"-{name}") + f" where pressing is negative, +{name} where it is positive"
        raise TableError(block.path, problem, allowed, column=name)
    return 1 if moved > 0.0 else -1


def _from_touch(table: TrialTable, role: str, way: int, told: Told, notes: list[str]) -> TrialTable:
    """Depth and force counted from the first touch, where the record begins in air and the zero is not there yet."""
    if told.touch != AUTOMATIC:
        return table
    quiet = replace(table, force=calm(table.force))
    row, level = first_touch(quiet)
    span = float(np.ptp(table.depth))
    at = float(table.depth[row])
    in_air = at - float(table.depth[: row + 1].min()) > IN_AIR * span
    absolute = role in ("position", "gap")
    if abs(at) > OWN_ZERO * span or absolute:
        where = "the first touch" if in_air else "the first row, which touches already"
        at = at if in_air else float(table.depth[0])
        notes.append(f"depth is counted from {where}, at {1e3 * way * at:.4g} mm of the file")
        table = replace(table, depth=table.depth - at)
    peak = float(quiet.force.max())
    if in_air and abs(level) > 0.02 * max(peak - level, 1e-12):
        notes.append(f"the force reads {level:.4g} N in air: counted from there")
        table = replace(table, force=table.force - level)
    return table


def first_touch(table: TrialTable) -> tuple[int, float]:
    """The row before the force rises for good on the way to its first peak, and the force's level before it.

    Of the rows up to a tenth of the peak the last within four times the noise of the level, or within `TOUCH_FORCE` of
    the peak. Where the noise is more than that, means over neighbouring rows are looked at: a force that begins flat is
    long within the noise of single rows (0.5 mm of a press of 2 mm by the depth's square, with 1 % of noise).
    """
    force = table.force
    level = float(np.median(force[: max(5, len(force) // 50)]))
    rise = float(force.max()) - level
    above = np.flatnonzero(force - level > 0.1 * rise)
    until = int(above[0]) if len(above) else len(force)
    start = _in_air(force[: max(until, 1)])
    if start is None:
        return 0, float(force[0])
    level, noise = _level_and_noise(start)
    least, most = max(TOUCH_FORCE * rise, float(np.finfo(float).tiny)), MOST_MEANT * min(len(start), until)
    wanted = min(4.0 * noise / least, most) ** 2
    means = _means(force[: max(until, 1)], int(min(wanted, most)) // 2)
    _, noise = _level_and_noise(means[: len(start)])
    quiet = np.flatnonzero(means - level <= max(4.0 * noise, TOUCH_FORCE * rise))
    return (int(quiet[-1]) if len(quiet) else 0), level


def _level_and_noise(force: FloatArray) -> tuple[float, float]:
    """Median and robust standard deviation of a force in air, N."""
    level = float(np.median(force))
    return level, 1.4826 * float(np.median(np.abs(force - level)))


def _means(force: FloatArray, side: int) -> FloatArray:
    """Means over each row and as many beside it on either side, fewer at the ends."""
    total = np.concatenate([[0.0], np.cumsum(force)])
    last = np.minimum(np.arange(len(force)) + side + 1, len(force))
    first = np.maximum(np.arange(len(force)) - side, 0)
    return np.asarray((total[last] - total[first]) / (last - first))


def _in_air(force: FloatArray) -> FloatArray | None:
    """The rows at the beginning of a first rise in which the force does not rise yet; None where it does at once.

    It rises where its second half is above its first by more than noise, and nearly as a parabola would be that reaches
    as high. The first half of the rows is looked at, then the first half of that, and so on: any power of the depth is
    flat at last, and a parabola as flat as it.
    """
    noise = float(np.median(np.abs(np.diff(force, 2)))) if len(force) > 2 else 0.0
    rise = float(force[-1]) - float(force[0])
    start = force[: max(5, len(force) // 2)]
    if len(start) < FEWEST:
        return start
    while len(start) >= FEWEST:
        half = len(start) // 2
        gained = float(np.median(start[half:]) - np.median(start[:half]))
        parabola = 0.5 * rise * (len(start) / len(force)) ** 2
        if gained <= max(MEDIANS * noise / half**0.5, STEEP * parabola):
            return start
        start = start[:half]
    return None


def phases(table: TrialTable) -> tuple[int, float]:
    """How many presses a record holds, by its depth, and the longest time (s) that it stands pressed in."""
    depth = table.depth - float(table.depth.min())
    deep, shallow = depth > 0.6 * float(depth.max()), depth < 0.4 * float(depth.max())
    state, presses = False, 0
    for is_deep, is_shallow in zip(deep.tolist(), shallow.tolist(), strict=True):
        if is_deep and not state:
            presses, state = presses + 1, True
        elif is_shallow:
            state = False
    return presses, _dwell(table, depth)


def _dwell(table: TrialTable, depth: FloatArray) -> float:
    """The longest time in which the depth goes no faster than once through its travel in the record, s.

    Pressed in by a fifth at least, and within 0.2 % of the travel from row to row. Over means of rows where the depth's
    noise is as much: 0.5 um of it had left 37 of 397 s.
    """
    travel = float(depth.max())
    slow = 2e-3 * travel / max(1.0, len(depth) / 500.0)
    noise = 1.4826 * float(np.median(np.abs(np.diff(depth, 2)))) / 6.0**0.5
    rows = max(1, int(np.ceil((SURE * noise / max(slow, 1e-300)) ** (2.0 / 3.0)))) if noise > 0.5 * slow else 1
    starts = np.arange(0, len(depth), rows)
    level = np.add.reduceat(depth, starts) / np.diff(np.append(starts, len(depth)))
    still = np.abs(np.diff(level)) <= rows * slow
    still &= level[1:] > 0.2 * travel
    edges = np.flatnonzero(np.diff(np.concatenate([[False], still, [False]]).astype(int)))
    least = 1 if rows == 1 else FEWEST  # the turn of a press alone is the middle of two means or three
    spans = [pair for pair in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True) if pair[1] - pair[0] >= least]
    ends = np.append(starts[1:], len(depth)) - 1
    return max((float(table.time[ends[last]] - table.time[starts[first]]) for first, last in spans), default=0.0)
