"""Where a run's wave model and its reference disagree: mean residual of the force by phase and depth."""

from __future__ import annotations

import math

import numpy as np

from benchmark.discovery.discovery_result import Contrast, Place
from benchmark.discovery.from_run.run_case import RunCase

CLASSES = 3


def places(case: RunCase, smallest: float) -> tuple[Place, ...]:
    """Cells whose mean residual is beyond `smallest` (N), largest first; without p, for nothing here is random."""
    residual = case.run.force - case.force()
    depth, peak = case.depth, float(case.depth.max())
    phases = _phases(case)
    found = []
    for phase in ("load", "hold", "unload_high", "unload_low"):
        for part in range(CLASSES):
            low, high = part * peak / CLASSES, (part + 1) * peak / CLASSES
            rows = (phases == phase) & (depth >= low) & (depth <= high)
            size = float(residual[rows].mean()) if rows.any() else 0.0
            if abs(size) > smallest:
                percent = 100.0 * size / float(case.run.force.max())
                found.append(Place("force_z", phase, case.run.name, 1, (low, high), size, percent, math.nan))
    return tuple(sorted(found, key=lambda place: -abs(place.size)))


def contrasts(case: RunCase) -> tuple[Contrast, ...]:
    """Whether the reference has a memory: unload minus load at equal depth."""
    force, depth, phases = case.run.force, case.depth, _phases(case)
    load, unload = phases == "load", np.char.startswith(phases, "unload")
    if load.sum() < 2 or not unload.any():
        return ()
    at_depth = np.interp(depth[unload], depth[load], force[load])
    size = float(np.mean(force[unload] - at_depth))
    return (Contrast("Unload minus load at equal depth, in the reference", "force_z", size, math.nan),)


def _phases(case: RunCase) -> np.ndarray:
    """(n,) phase of each row: of one press, up to its peak, held near it, and back."""
    force, depth = case.run.force, case.depth
    last = int(np.flatnonzero(force >= force.max() * (1.0 - 1e-9))[-1])
    first = int(force.argmax())
    rows = np.arange(force.size)
    below = np.where(depth >= 0.5 * depth.max(), "unload_high", "unload_low")
    return np.where(rows <= first, "load", np.where(rows <= last, "hold", below))
