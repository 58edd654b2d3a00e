"""The stage of each row: phase, cycle and half."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery.result import PHASES, Array
from benchmark.discovery.segments import Segment

Index = NDArray[np.int64]
IN_AIR = 0.02
"""Depths up to this share of the peak count as no press in a rest."""


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
    deep = (depth >= 0.5 * peak).astype(np.int64)
    if piece.kind == "press":
        return ["load" if d > 0.0 else "approach" for d in depth], deep
    if piece.kind == "retract":
        names = ["after_lift_off" if d <= 0.0 else "unload_high" if d >= 0.5 * peak else "unload_low" for d in depth]
        return names, np.zeros_like(deep)
    if np.median(depth) <= IN_AIR * peak:
        return ["approach" if piece.cycle == 0 else "after_lift_off"] * depth.size, np.zeros_like(deep)
    late = (np.arange(depth.size) >= 0.5 * depth.size).astype(np.int64)
    return ["hold"] * depth.size, late
