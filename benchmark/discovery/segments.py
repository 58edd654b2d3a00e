"""A trial's motion in segments: between reversals, with the rests in them apart."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from benchmark.discovery.result import Array

REVERSAL = 0.1
"""Share of the travel by which the depth must come back to count as a reversal."""
LEVEL = 0.03
"""Share of the travel within which a depth stands still."""
LEAST_REST = 3.0
"""A rest lasts at least this many times as long as the motion beside it needs to cross the level's width."""


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


def segments(time: Array, depth: Array) -> list[Segment]:
    """Segments of a motion: time (n,) s, depth (n,) m; empty where nothing moves."""
    travel = float(np.ptp(depth))
    if travel <= 0.0:
        return []
    turns = reversals(depth, REVERSAL * travel)
    edges = [0, *turns, depth.size - 1]
    pieces: list[tuple[int, int, str]] = []
    for first, last in pairwise(edges):
        if last > first:
            pieces += _with_rests(time, depth, first, last, LEVEL * travel)
    return _numbered(_joined(pieces))


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
    if time[start] - time[first] <= LEAST_REST * crossing:
        start = first
    if time[last] - time[end] <= LEAST_REST * crossing:
        end = last
    if start > first:
        out.append((first, start, "rest"))
    out.append((start, end, kind))
    if end < last:
        out.append((end, last, "rest"))
    return out


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
    cycle, out = 0, []
    for number, (first, last, kind) in enumerate(pieces):
        cycle += kind == "press"
        end = last + 1 if number == len(pieces) - 1 else last
        if end > first:
            out.append(Segment(first, end, kind, cycle))
    return out
