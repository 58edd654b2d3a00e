"""Rows of a trial as they are compared: means of raw rows, small ones next to turning points, never across them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import Array
from benchmark.discovery.trials.marker_layout import Layout, grid
from benchmark.discovery.trials.segments import FITTED, Segment, scatter_of, segments
from benchmark.errors import InputError
from benchmark.files import Camera, Trial
from benchmark.physics import DepthRecord

GROWTH = 1.35
"""Each bin is so many times as large as the one before it, away from a turning point."""
LEAST_BINS = 10
"""Of a segment."""
MOST_RECORD = 20_000
"""Rows of a record that is kept whole; of a longer one the raw rows are kept, which are means themselves."""
SAME_DEPTH = 1e-10
"""Depths that differ by no more are the same, m."""
NEAR = (-0.04, 0.08)
SPAN = 0.008
"""Bins whose depth comes within `NEAR` (shares of the peak) of contact span no more than `SPAN` of it."""

EARLIER_ROWS, LEAST_EARLIER = 240, 6
"""Rows of what a record has before a trial, about, and of each of its segments at least."""

BinPlan: TypeAlias = Sequence[tuple[int, Array]]
"""For each segment its number and the edges (0 to 1) of its bins."""


def no_rows() -> Array:
    """(0, 2): nothing before a trial."""
    return np.empty((0, 2))


@dataclass(frozen=True, eq=False)
class RawTrial:
    """One trial as measured, its repeated rates taken out: (n,) arrays; markers (f, m, 2) at the frames (f,) s.

    A marker that a frame missed is interpolated in time; one that was hardly seen is NaN. Where the depth's scatter was
    the sensor's, and is taken out of it, `steadied` says so. `earlier` (k, 2) has times and depths by which the record
    goes on from its beginning to the trial, where that is cut from a longer one. `led` is what the rig prescribed, by
    which segments and protocols are told: the depth, m, or (`by_force`) the force over its least, N.
    """

    trial: Trial
    time: Array
    depth: Array
    force: Array
    acceleration: Array
    frames: Array | None
    markers: Array | None
    pieces: tuple[Segment, ...]
    led: Array
    by_force: bool = False
    steadied: bool = False
    earlier: Array = field(default_factory=no_rows)


def bin_sizes(rows: int, target: int) -> list[int]:
    """Sizes that add up to `rows`, one at the ends and growing towards the middle, about `target` in number."""
    if rows <= target:
        return [1] * rows
    largest = 2
    while True:
        sizes = _sizes(rows, largest)
        if len(sizes) <= target or largest >= rows:
            return sizes
        largest = int(np.ceil(1.3 * largest))


def _sizes(rows: int, largest: int) -> list[int]:
    side, size, left = [], 1.0, rows // 2
    while left > 0:
        step = min(int(size), largest, left)
        side.append(step)
        left -= step
        size = min(size * GROWTH, float(largest))
    middle = [1] if rows % 2 else []
    return [*side, *middle, *side[::-1]]


def fractions(sizes: list[int]) -> Array:
    """Edges from 0 to 1 of bins of these sizes."""
    return np.concatenate([[0.0], np.cumsum(sizes)]) / float(sum(sizes))


def bin_means(columns: Array, first: int, last: int, edges: Array) -> tuple[Array, Array]:
    """Means (k, c) of rows first..last-1 of `columns` (n, c) in bins by their place, and how many rows each holds.

    A bin without rows takes the row at its middle and counts none.
    """
    n = last - first
    marks = np.round(edges * n).astype(int)
    counts = np.diff(marks)
    sums = np.concatenate([np.zeros((1, columns.shape[1])), np.cumsum(columns[first:last], axis=0)])
    means = (sums[marks[1:]] - sums[marks[:-1]]) / np.maximum(counts, 1)[:, None]
    empty = counts == 0
    if empty.any():
        middle = np.clip((0.5 * (edges[1:] + edges[:-1]) * n).astype(int), 0, n - 1)
        means[empty] = columns[first + middle[empty]]
    return means, counts.astype(float)


def depth_step(depth: Array) -> float:
    """The smallest change that a record of the depth (n,) shows, m: its rounding, or three deviations of its scatter.

    Scatter is what third differences have: those of a motion that is sampled well are far smaller.
    """
    known = np.diff(np.unique(depth))
    rounding = known[known > SAME_DEPTH].min(initial=np.inf)
    return float(max(rounding if np.isfinite(rounding) else 0.0, 3.0 * scatter_of(depth)))


def acceleration(time: Array, depth: Array) -> Array:
    """(n,) m/s2 by local quadratics, evenly spaced as the median is; 0 where a gap leaves fewer."""
    from scipy.signal import savgol_filter

    step = float(np.median(np.diff(time)))
    out = np.zeros(depth.size)
    for rows in np.split(np.arange(depth.size), np.flatnonzero(np.diff(time) > criteria.LONG_GAP * step) + 1):
        if rows.size >= FITTED:
            out[rows] = savgol_filter(depth[rows], FITTED, 2, deriv=2, delta=step, mode="interp")
    return out


def marker_frames(trial: Trial, camera: Camera) -> tuple[Array, Array] | None:
    """Times (f,) of a trial's frames and positions (f, m, 2) of the grid's markers in them.

    Raises
    ------
    InputError
        A marker is numbered beyond the grid.
    """
    table = trial.markers
    if table is None:
        return None
    count = camera.marker_rows * camera.marker_columns
    numbers = np.unique(table.marker)
    base = int(numbers.min()) if numbers.size == count else int(0 not in numbers)
    index = table.marker - base
    if index.min() < 0 or index.max() >= count:
        layout = f"{camera.marker_rows} x {camera.marker_columns}"
        raise InputError(
            f"trial {trial.name}, markers, column marker: {int(numbers[-1])} is not in the grid of {layout} markers "
            f"that [camera] tells of; allowed: {count} numbers in a row, from 0 or 1."
        )
    frames = np.unique(table.time)
    out = np.full((frames.size, count, 2), np.nan)
    for number in range(count):
        mine = (index == number) & np.isfinite(table.x) & np.isfinite(table.y)
        if mine.sum() < max(criteria.MARKER_SEEN * frames.size, 2):
            continue
        stamps = table.time[mine]
        order = np.argsort(stamps)
        for axis, values in enumerate((table.x[mine], table.y[mine])):
            out[:, number, axis] = np.interp(frames, stamps[order], values[order])
    return frames, out


def frame_means(frames: Array, signals: Array, edges: Array) -> tuple[Array, Array, Array]:
    """Signals (f, c) of frames in bins of time: means (k, c), number of frames (k,) and their mean time (k,).

    `edges` (k + 1,) s; a bin without frames has NaN, and its middle as its time.
    """
    marks = np.searchsorted(frames, edges)
    counts = np.diff(marks).astype(float)
    table = np.column_stack([frames, signals])
    sums = np.concatenate([np.zeros((1, table.shape[1])), np.cumsum(table, axis=0)])
    means = (sums[marks[1:]] - sums[marks[:-1]]) / np.maximum(counts, 1.0)[:, None]
    empty = counts == 0.0
    means[empty] = np.nan
    means[empty, 0] = 0.5 * (edges[1:] + edges[:-1])[empty]
    return means[:, 1:], counts, means[:, 0]


def resting_grid(camera: Camera, positions: Array) -> Array:
    """(m, 2) nominal places, y turned where the data count rows the other way."""
    nominal = grid(camera)
    first = np.nanmean(positions[:, :3], axis=(0, 1))
    turned = nominal * np.array([1.0, -1.0])
    return turned if np.nansum(np.abs(first - turned)) < np.nansum(np.abs(first - nominal)) else nominal


def bin_plan(group: Sequence[RawTrial], rows: int) -> BinPlan:
    """The bins of a condition, about `rows` in all, the same for all its trials."""
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


def binned(raw: RawTrial, plan: BinPlan, layout: Layout | None, seen: NDArray[np.bool_] | None) -> Binned:
    """A trial's means in the bins of a plan: force, and the combinations of the markers (m,) that were seen."""
    table = np.column_stack([raw.time, raw.depth, raw.acceleration, raw.force])
    parts = [bin_means(table, raw.pieces[k].first, raw.pieces[k].last, edges) for k, edges in plan]
    rows, samples = _rising(np.concatenate([p[0] for p in parts])), np.concatenate([p[1] for p in parts])
    if layout is None:
        return Binned(rows, samples[:, None], rows[:, 0])
    missing = np.full((samples.size, len(layout.names)), np.nan)
    if raw.markers is None or raw.frames is None:
        nothing = np.zeros_like(missing)
        return Binned(np.hstack([rows, missing]), np.column_stack([samples, nothing]), rows[:, 0])
    signals, frames, moment = frame_means(
        raw.frames, layout.signals(raw.markers[:, seen] - layout.origin), _edges(raw, plan)
    )
    return Binned(np.hstack([rows, signals]), np.column_stack([samples, *[frames] * len(layout.names)]), moment)


def record(raw: RawTrial, plan: BinPlan, begin: float) -> DepthRecord:
    """The record of the depth that the bins of a plan are means of, on a clock that begins so late, s.

    It is the whole one unless that is very long (it goes with each trial to every process), or scatters.
    """
    whole = raw.trial.table
    kept = whole if whole.time.size <= MOST_RECORD and not raw.steadied else raw
    before, deep = raw.earlier.T
    halfway = 0.5 * (before[1:] + before[:-1])
    time, depth = np.concatenate([before, kept.time]), np.concatenate([deep, kept.depth])
    borders = np.concatenate([2.0 * before[:1] - halfway[:1], halfway, _edges(raw, plan)])
    return DepthRecord(time - begin, depth, borders - begin, before.size)


def earlier_rows(time: Array, depth: Array) -> Array:
    """(k, 2) times and mean depths of a record (n,) in few bins: its turning points, and like parts between them."""
    pieces = segments(time, depth)
    inner = max(LEAST_EARLIER, EARLIER_ROWS // max(len(pieces), 1)) - 2
    edges = [np.linspace(piece.first + 1, max(piece.last - 1, piece.first + 1), inner + 1) for piece in pieces]
    ends = [np.array([piece.first, piece.last]) for piece in pieces]
    marks = np.unique(np.round(np.concatenate([*edges, *ends, [0, time.size]])).astype(int))
    sums = np.add.reduceat(np.column_stack([time, depth]), marks[:-1])
    return np.asarray(sums / np.diff(marks)[:, None])


def _edges(raw: RawTrial, plan: BinPlan) -> Array:
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
