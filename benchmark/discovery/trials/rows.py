"""Rows of a trial as they are compared: means of raw rows, small ones next to turning points, never across them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmark.discovery.discovery_result import Array
from benchmark.discovery.trials.marker_layout import grid
from benchmark.discovery.trials.segments import Segment
from benchmark.errors import InputError
from benchmark.files import Camera, Trial

GROWTH = 1.35
SEEN = 0.5
"""Share of the frames in which a marker must be seen."""


@dataclass(frozen=True, eq=False)
class RawTrial:
    """One trial as measured, its repeated rates taken out: (n,) arrays; markers (f, m, 2) at the frames (f,) s.

    A marker that a frame missed is interpolated in time; one that was hardly seen is NaN.
    """

    trial: Trial
    time: Array
    depth: Array
    force: Array
    acceleration: Array
    frames: Array | None
    markers: Array | None
    pieces: tuple[Segment, ...]


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
        size *= GROWTH
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


def acceleration(time: Array, depth: Array) -> Array:
    """(n,) m/s2 by local quadratics over five rows; even spacing is taken as the median's."""
    from scipy.signal import savgol_filter

    step = float(np.median(np.diff(time)))
    return np.asarray(savgol_filter(depth, 5, 2, deriv=2, delta=step, mode="nearest"))


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
        if mine.sum() < max(SEEN * frames.size, 2):
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
