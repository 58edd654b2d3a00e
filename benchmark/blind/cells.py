"""Where a hidden effect truly shows: channels and phases in which the base cannot explain it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden import Hidden
from benchmark.blind.motion import phases
from benchmark.blind.scene import Scene, Whitened, frame_phases
from benchmark.blind.simulate import Grid
from benchmark.blind.strength import Base, leftover

SHOWS = 5.0
MAY_SHOW = 2.5

Cell = tuple[str, str]


@dataclass(frozen=True)
class TrueCells:
    """Cells (channel, phase) of a hidden effect.

    Attributes
    ----------
    strongest : (channel, phase) or None
        Where it shows most.
    shows : tuple of (channel, phase)
        More than `SHOWS` standard deviations of the trial mean: who misses one has missed it.
    may_show : tuple of (channel, phase)
        More than `MAY_SHOW`, or in the single markers of a channel whose mean has nothing: finding one is no error.
    """

    strongest: Cell | None
    shows: tuple[Cell, ...]
    may_show: tuple[Cell, ...]


def true_cells(scene: Scene, base: Base, effects: Sequence[Hidden]) -> TrueCells:
    """Cells of the effects together."""
    power: dict[Cell, float] = defaultdict(float)
    single: dict[Cell, float] = defaultdict(float)
    for plan, rest in zip(scene.plans, leftover(scene, base, effects), strict=True):
        moved = scene.motion(plan)
        for phase, rows in phases(moved.time, moved.depth).items():
            power["force_z", phase] += float(np.sum(rest.force[rows] ** 2))
        if scene.grid is not None:
            for phase, rows in frame_phases(moved).items():
                for channel, values in _marker_channels(scene.grid, rest).items():
                    power[channel, phase] += float(np.sum(values[rows] ** 2))
                for channel, seen in (("marker_x", rest.x), ("marker_y", rest.y)):
                    single[channel, phase] += 0.0 if seen is None else float(np.sum(seen[rows] ** 2))
    size = {cell: np.sqrt(value) for cell, value in power.items()}
    shows = tuple(sorted(cell for cell, value in size.items() if value >= SHOWS))
    loose = {cell for cell, value in size.items() if value >= MAY_SHOW}
    loose |= {cell for cell, value in single.items() if np.sqrt(value) >= MAY_SHOW}
    strongest = max(shows, key=lambda cell: size[cell], default=None)
    return TrueCells(strongest, shows, tuple(sorted(loose)))


def _marker_channels(grid: Grid, rest: Whitened) -> dict[str, Array]:
    """Values (f, ...) of each channel: radial and tangential of each marker, x and y of all markers together."""
    if rest.x is None or rest.y is None:
        return {}
    x0, y0 = grid.positions()
    radius = np.hypot(x0, y0)
    together = np.sqrt(x0.size)
    return {
        "marker_radial": (rest.x * x0 + rest.y * y0) / radius,
        "marker_tangential": (rest.y * x0 - rest.x * y0) / radius,
        "marker_x": rest.x.mean(axis=1) * together,
        "marker_y": rest.y.mean(axis=1) * together,
    }
