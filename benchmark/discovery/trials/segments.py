"""A trial's motion in segments between reversals, rests apart, and the stage of each row: phase, cycle and half.

A depth whose sensor scatters is made steady first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import PHASES, Array

FITTED = 5
"""Rows of a local quadratic, which third differences need as well."""
OF_NORMAL = 1.4826
"""A normal standard deviation over the median of the sizes."""


@dataclass(frozen=True)
class Segment:
    """Rows first..last-1 of a trial: `kind` is "rest", "press" or "retract"; `cycle` from 1 (0 before a press)."""

    first: int
    last: int
    kind: str
    cycle: int


def reversals(depth: Array, threshold: float) -> list[int]:
    """Rows of the successive extremes of a depth (n,), each more than `threshold` from the one before."""
    found: list[int] = []
    low = high = 0
    direction = 0
    for row, value in enumerate(depth.tolist()):
        if value > depth[high]:
            high = row
        if value < depth[low]:
            low = row
        if direction >= 0 and value < depth[high] - threshold:
            if direction > 0 or high > 0:
                found.append(high)
            direction, low = -1, row
        elif direction <= 0 and value > depth[low] + threshold:
            if direction < 0 or low > 0:
                found.append(low)
            direction, high = 1, row
    return found


def segments(time: Array, depth: Array, width: float = criteria.LEVEL_WIDTH) -> list[Segment]:
    """Segments of a motion: time (n,) s, depth (n,) m; empty where nothing moves. What stands is within `width`.

    Widths are shares of the travel, of which a long way through air does not count: beside 20 mm of it, a press of 3 mm
    that was held for 10 s seemed to have no hold.
    """
    travel = float(depth.max() - max(depth.min(), -criteria.COUNTED_AIR * depth.max()))
    if travel <= 0.0:
        return []
    turns = reversals(depth, criteria.REVERSAL * travel)
    edges = [0, *turns, depth.size - 1]
    pieces: list[tuple[int, int, str]] = []
    for first, last in pairwise(edges):
        if last > first:
            for piece in _with_rests(time, depth, first, last, width * travel):
                pieces += _with_dwells(time, depth, piece, width * travel)
    return _numbered(_joined(pieces))


def without_dwells(pieces: Sequence[Segment]) -> tuple[Segment, ...]:
    """The same motion with the dwells inside its strokes counted to these."""
    out: list[Segment] = []
    for number, piece in enumerate(pieces):
        stroke = next((each.kind for each in pieces[number + 1 :] if each.kind != "rest"), None)
        inside = out and out[-1].kind != "rest" and stroke == out[-1].kind and pieces[number].kind == "rest"
        if inside or (out and out[-1].kind == piece.kind):
            out[-1] = replace(out[-1], last=piece.last)
        else:
            out.append(piece)
    return tuple(out)


def _with_rests(time: Array, depth: Array, first: int, last: int, width: float) -> list[tuple[int, int, str]]:
    """A monotone piece, its rests at both ends cut off."""
    kind = "press" if depth[last] > depth[first] else "retract"
    piece = depth[first : last + 1]
    if abs(float(depth[last] - depth[first])) <= 2.0 * width:
        return [(first, last, "rest")]
    away = np.flatnonzero(np.abs(piece - np.median(piece[: max(1, _near(piece, piece[0], width) // 2)])) > width)
    start = first + max(int(away[0]) - 1, 0) if away.size else first
    back = piece[::-1]
    level = np.median(back[: max(1, _near(back, back[0], width) // 2)])
    reached = np.flatnonzero(np.abs(piece - level) > width)
    end = first + min(int(reached[-1]) + 1, piece.size - 1) if reached.size else last
    if end <= start:
        return [(first, last, kind)]
    crossing = (time[end] - time[start]) * 2.0 * width / max(abs(float(depth[end] - depth[start])), 1e-12)
    out = []
    if time[start] - time[first] <= criteria.LEAST_REST * crossing:
        start = first
    if time[last] - time[end] <= criteria.LEAST_REST * crossing:
        end = last
    if start > first:
        out.append((first, start, "rest"))
    out.append((start, end, kind))
    if end < last:
        out.append((end, last, "rest"))
    return out


def _with_dwells(time: Array, depth: Array, piece: tuple[int, int, str], width: float) -> list[tuple[int, int, str]]:
    """A stroke with the dwells inside it cut out: steps of a staircase, a pause after the touch.

    A dwell takes longer to cross than the stroke takes beside it, on either side: where the speed changes for good, as
    from the way through air to the press, there is none.
    """
    first, last, kind = piece
    if kind == "rest":
        return [piece]
    way = depth[first : last + 1] if kind == "press" else depth[first : last + 1][::-1]
    stamps = time[first : last + 1] if kind == "press" else -time[first : last + 1][::-1]
    dwells = [(a, b) for a, b in _dwells(stamps, way, width) if way[a] > criteria.IN_AIR * float(depth.max())]
    if kind == "retract":
        dwells = [(way.size - 1 - b, way.size - 1 - a) for a, b in reversed(dwells)]
    out, start = [], first
    for a, b in dwells:
        out += [(start, first + a, kind), (first + a, first + b, "rest")]
        start = first + b
    return [*out, (start, last, kind)]


def _dwells(time: Array, way: Array, width: float) -> list[tuple[int, int]]:
    """First and last rows of the dwells inside a way that rises; time (n,) s, way (n,) m."""
    levels = np.arange(way[0] + 4.0 * width, way[-1] - 4.0 * width, 0.25 * width)
    if not levels.size:
        return []
    risen = np.maximum.accumulate(way)

    def crossing(centre: Array) -> Array:
        edges = np.searchsorted(risen, [centre - width, centre + width])
        stamps = time[np.minimum(edges, way.size - 1)]
        return np.asarray(stamps[1] - stamps[0])

    beside = np.maximum(crossing(levels - 2.0 * width), crossing(levels + 2.0 * width))
    least = float(np.median(np.diff(time)))
    slow = crossing(levels) > criteria.LEAST_REST * np.maximum(beside, least)
    found = []
    for group in np.split(np.flatnonzero(slow), np.flatnonzero(np.diff(np.flatnonzero(slow)) > 1) + 1):
        if group.size:
            inside = np.searchsorted(risen, [levels[group[0]], levels[group[-1]]])
            level = float(np.median(way[inside[0] : max(inside[1], inside[0] + 1)]))
            near = np.flatnonzero(np.abs(way - level) <= width)
            found.append((int(near[0]), int(near[-1])))
    return [(a, b) for a, b in found if b > a]


def _near(piece: Array, level: float, width: float) -> int:
    away = np.flatnonzero(np.abs(piece - level) > width)
    return int(away[0]) if away.size else piece.size


def _joined(pieces: list[tuple[int, int, str]]) -> list[tuple[int, int, str]]:
    out: list[tuple[int, int, str]] = []
    for first, last, kind in pieces:
        if out and out[-1][2] == kind:
            out[-1] = (out[-1][0], last, kind)
        else:
            out.append((first, last, kind))
    return out


def _numbered(pieces: list[tuple[int, int, str]]) -> list[Segment]:
    """Segments with their cycles; a press that goes on after a dwell is of the same."""
    cycle, out, stroke = 0, [], "retract"
    for number, (first, last, kind) in enumerate(pieces):
        cycle += kind == "press" and stroke == "retract"
        stroke = kind if kind != "rest" else stroke
        end = last + 1 if number == len(pieces) - 1 else last
        if end > first:
            out.append(Segment(first, end, kind, cycle))
    return out


def prescribed(force: Array) -> Array:
    """The course of a force (n,) that the rig prescribed, N over its least, averaged over rows where it scatters much.

    Segments of such a trial are told by it: the depth is the answer, and creeps while the force stands.
    """
    from scipy.ndimage import uniform_filter1d

    course = uniform_filter1d(force, _averaged(force), mode="nearest")
    return np.asarray(course - course.min())


def _averaged(force: Array) -> int:
    width = criteria.LEVEL_WIDTH * max(float(np.ptp(force)), 1e-300)
    return int(np.clip(np.ceil((criteria.FLAT * scatter_of(force) / width) ** 2), 1, max(force.size // 20, 1)))


def forced(time: Array, force: Array) -> list[Segment]:
    """Segments of a trial whose force (n,), N, was prescribed: its turns are corners of the depth.

    The rest before the first step of a staircase is short beside the way of all steps, and told by that step alone.
    """
    course, scatter = prescribed(force), scatter_of(force) / _averaged(force) ** 0.5
    width = float(
        np.clip(criteria.FLAT * scatter / max(float(np.ptp(course)), 1e-300), criteria.LEAST_FLAT, criteria.LEVEL_WIDTH)
    )
    pieces: list[tuple[int, int, str]] = []
    for each in segments(time, course, width):
        first, last = each.first, min(each.last, time.size - 1)
        stroke = each.kind != "rest" and last > first
        pieces += _with_rests(time, course, first, last, width * course.max()) if stroke else [(first, last, "rest")]
    return _numbered(_joined(pieces))


def scatter_of(signal: Array) -> float:
    """Standard deviation of what a signal (n,) scatters by from row to row, by third differences; 0 for a few rows."""
    if signal.size <= FITTED:
        return 0.0
    return float(OF_NORMAL * np.median(np.abs(np.diff(signal, 3))) / np.sqrt(20.0))


def steadied(time: Array, depth: Array, force: Array, forced: Sequence[Segment] = ()) -> Array:
    """A depth (n,), m, without the scatter of its sensor, each stroke and rest by itself; the same one without any.

    A scatter that the force (n,), N, follows is motion and stays. One that it does not follow favours whatever lags in
    a model, since between two rows that meets their mean (errors in variables), and hides where a stroke ends. Strokes
    become lines or cubic splines of a few pieces. Where the force was prescribed its segments, `forced`, tell where
    they meet, and bends of the depth inside a stroke of the force, during which friction may hold the tool; a row there
    takes the side that is nearer to it.
    """
    turns = [piece.first for piece in forced[1:]]
    if not _scatters(depth, force, turns):
        return depth
    out, met = depth.copy(), np.full(depth.size, np.inf)
    borders = _borders_through(time, depth)
    if forced:
        strokes = [each for each in forced if each.kind != "rest"]
        inside = [row for row in borders for each in strokes if each.first + 3 <= row <= each.last - 3]
        borders = sorted({0, *turns, *inside, depth.size - 1})
    for first, last in pairwise(borders):
        whole = slice(first, last + 1)
        if last - first >= 2 * FITTED:
            smooth = _smooth(time[whole], depth[whole], scatter_of(depth))
            off = np.abs(smooth - depth[whole])
            out[whole] = np.where(off < met[whole], smooth, out[whole]) if forced else smooth
            met[whole] = off
    return out


def at_steady(force: Array, read: Array, steady: Array) -> Array:
    """A force (n,), N, as at the depth made steady: less what the scatter that was taken out is worth.

    Under a prescribed force the depth's scatter is the noise of the trial. A smoothed one hides it: the rows of a hold
    then share one error where its own were as good as independent, and strokes of a few rows scatter as before.
    """
    stiffness = float(np.ptp(force)) / max(float(read.max()), 1e-300)
    touching = steady > -criteria.SURELY_OUT * scatter_of(read)
    return np.asarray(force - np.where(touching, stiffness * (read - steady), 0.0))


def _scatters(depth: Array, force: Array, turns: Sequence[int]) -> bool:
    """Whether a depth scatters by what counts beside the force's own scatter, and the force does not follow it.

    Differences over the `turns` of a prescribed force are no scatter.
    """
    scatter, reach = scatter_of(depth), max(float(depth.max()), 1e-300)
    stiffness = float(np.ptp(force)) / reach
    if stiffness * scatter <= criteria.SCATTERS * scatter_of(force):
        return False
    inside = depth[:-3] > criteria.IN_CONTACT * reach
    for turn in turns:
        inside[max(turn - 3, 0) : turn + 1] = False
    jumps, answers = np.diff(depth, 3)[inside], np.diff(force, 3)[inside]
    return float(answers @ jumps) < criteria.ANSWERED * stiffness * float(jumps @ jumps)


def _borders_through(time: Array, depth: Array) -> list[int]:
    """Rows at which the strokes and rests of a scattering motion meet, its ends included."""
    from scipy.ndimage import uniform_filter1d

    width = criteria.LEVEL_WIDTH * max(float(np.ptp(depth)), 1e-300)
    rows = int(np.clip((criteria.SMOOTHED * scatter_of(depth) / width) ** 2, FITTED, max(depth.size // 20, FITTED)))
    pieces = segments(time, uniform_filter1d(depth, rows, mode="nearest"))
    marks = [0, *(piece.first for piece in pieces[1:]), depth.size - 1]
    bends = [_bend(time, depth, marks[k - 1 : k + 2], 2 * rows) for k in range(1, len(marks) - 1)]
    return [0, *bends, depth.size - 1]


def _bend(time: Array, depth: Array, marks: Sequence[int], reach: int) -> int:
    """The row within `reach` of the middle of three marks at which two lines that meet there leave least."""
    before, at, after = marks
    rows = range(max(at - reach, before + FITTED), min(at + reach, after - FITTED) + 1)
    if not rows:
        return at
    around = slice(max(before, at - 3 * reach), min(after, at + 3 * reach) + 1)
    stamps, way = time[around] - time[at], depth[around]

    def left(row: int) -> float:
        past = np.maximum(stamps - (time[row] - time[at]), 0.0)
        lines = np.column_stack([np.ones(stamps.size), stamps, past])
        return float(np.sum((way - lines @ np.linalg.lstsq(lines, way, rcond=None)[0]) ** 2))

    return min(rows, key=left)


def _smooth(time: Array, depth: Array, scatter: float) -> Array:
    """A line, or the cubic spline of as many pieces as Akaike's criterion wants, through a stroke or rest (n,)."""
    from scipy.interpolate import make_lsq_spline

    pieces = 2 ** np.arange(int(np.log2(max(depth.size / (2 * FITTED), 1.0))) + 1)
    fits = [np.polynomial.Polynomial.fit(time, depth, 1)]
    for count in pieces.tolist():
        inner = np.quantile(time, np.arange(1, count) / count)
        knots = np.concatenate([[time[0]] * 4, inner, [time[-1]] * 4])
        fits.append(make_lsq_spline(time, depth, knots))
    told = [np.asarray(each(time)) for each in fits]
    sizes = [2, *(pieces + 3)]
    lost = [np.sum(((depth - each) / scatter) ** 2) + 2.0 * size for each, size in zip(told, sizes, strict=True)]
    return told[int(np.argmin(lost))]


Index = NDArray[np.int64]


def stages(pieces: Sequence[Segment], number: Index, depth: Array) -> tuple[Index, Index, Index]:
    """Phase (n,) as an index of PHASES, cycle (n,) and half (n,) of rows of segments `number` at depths (n,), m."""
    phase, cycle, part = (np.zeros(depth.size, dtype=np.int64) for _ in range(3))
    peaks = _peaks(pieces, number, depth)
    for k, piece in enumerate(pieces):
        rows = np.flatnonzero(number == k)
        peak = peaks.get(piece.cycle, float(depth.max()))
        names, half = _of_piece(piece, depth[rows], peak)
        phase[rows] = [PHASES.index(name) for name in names]
        cycle[rows], part[rows] = piece.cycle, half
    return phase, cycle, part


def _peaks(pieces: Sequence[Segment], number: Index, depth: Array) -> dict[int, float]:
    cycles = np.array([piece.cycle for piece in pieces])[number]
    return {int(c): float(depth[cycles == c].max()) for c in np.unique(cycles)}


def _of_piece(piece: Segment, depth: Array, peak: float) -> tuple[list[str], Index]:
    deep = (depth >= criteria.DEEP * peak).astype(np.int64)
    if piece.kind == "press":
        return ["load" if d > 0.0 else "approach" for d in depth], deep
    if piece.kind == "retract":
        names = [
            "after_lift_off" if d <= 0.0 else "unload_high" if d >= criteria.DEEP * peak else "unload_low"
            for d in depth
        ]
        return names, np.zeros_like(deep)
    if np.median(depth) <= criteria.IN_AIR * peak:
        return ["approach" if piece.cycle == 0 else "after_lift_off"] * depth.size, np.zeros_like(deep)
    late = (np.arange(depth.size) >= 0.5 * depth.size).astype(np.int64)
    return ["hold"] * depth.size, late
