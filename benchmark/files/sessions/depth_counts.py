"""Depth that comes in counts: read between the instants at which the count changes.

A reading is a whole count for as long as the tool is within it, up to half a count off. The instants at which it
changes are known to a row, and there the depth is known, too: on the boundary of two counts. Between these instants the
tool moves evenly, or stands where it entered the count, as a drive does that stops by its own reading. A native trial
has its counts in the actuator's readings: its rows are the force's, and lie between them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from bench_hw.tables import TrialTable

Array = NDArray[np.float64]

LEAST_CHANGES = 10
"""Changes of the reading that a trial needs to tell."""
LEAST_SHARE = 1e-3
"""Of the travel, below which a count is fine enough as it is."""
LEAST_REPEATS = 0.5
"""Share of the rows on the way whose reading is that of the row before."""
WHOLE = 0.05
"""Of a count, by which distances of readings may differ from whole counts: what writing in decimals leaves."""
DECIMALS = 9
"""Of a depth in m: what lies beyond is round-off."""
STANDS = 3.0
"""Times as long as beside it that a count lasts where the tool stands."""


def count_of(depth: Array) -> float | None:
    """The count in m of depths (n,) m; None where they do not come in counts, or in such that do not matter.

    In counts are distances that are whole, changes of mostly one at a time, and more rows that repeat than that change,
    while the tool moves, too: a tool that goes by one and the same way a row and then stands has no counts.
    """
    changes = np.flatnonzero(np.diff(depth))
    if len(changes) < LEAST_CHANGES or len(changes) > (1.0 - LEAST_REPEATS) * (changes[-1] - changes[0] + 1):
        return None
    if np.median(np.diff(changes)) < 2.0:
        return None
    steps = np.diff(np.unique(np.round(depth, DECIMALS)))
    counts = np.round(steps / steps.min())
    count = float(steps.sum() / counts.sum())
    whole = np.abs(steps - counts * count) <= WHOLE * count
    single = float(np.median(np.abs(np.diff(depth)[changes]))) < 1.5 * count
    return count if whole.all() and single and count >= LEAST_SHARE * float(np.ptp(depth)) else None


def between_counts(time: Array, depth: Array, count: float, at_times: Array | None = None) -> Array:
    """Depth, m, at `at_times` (s, by default the readings'), of readings (n,) m in whole counts (m) at times (n,) s."""
    at = np.flatnonzero(np.diff(depth))
    when, where = 0.5 * (time[at] + time[at + 1]), 0.5 * (depth[at] + depth[at + 1])
    onward = np.sign(depth[at + 1] - depth[at])
    lasted = np.diff(when)
    known = [(time[0], depth[0]), (when[0] - 0.5 * lasted[0], depth[0])]
    for k, duration in enumerate(lasted):
        known.append((when[k], where[k]))
        before, after = lasted[max(k - 1, 0)], lasted[min(k + 1, len(lasted) - 1)]
        if onward[k] != onward[k + 1]:
            beyond = 0.5 * duration / before * count  # as far as the tool gets if it turns half way
            known.append((when[k] + 0.5 * duration, where[k] + onward[k] * (beyond if beyond <= count else 0.0)))
        elif duration > STANDS * max(before, after):
            known.append((when[k + 1] - after, where[k]))
    known.append((when[-1], where[-1]))
    instants, places = np.array(sorted(known)).T
    return np.asarray(np.interp(time if at_times is None else at_times, instants, places))


def even_depths(tables: Sequence[TrialTable]) -> tuple[list[TrialTable], list[str]]:
    """Trials with their depth read between counts where it comes in counts, and a remark that says so."""
    readings = [(table.time, table.depth) if table.readings is None else table.readings for table in tables]
    counts = [count_of(depth) for _, depth in readings]
    read = [
        replace(table, depth=between_counts(*own, count, table.time), readings=None) if count else table
        for table, own, count in zip(tables, readings, counts, strict=True)
    ]
    known = [count for count in counts if count is not None]
    if not known:
        return read, []
    size = f"{1e3 * float(np.median(known)):.3g} mm"
    return read, [
        f"the depth of {len(known)} of {len(tables)} trials comes in counts of {size}: it is read between the instants "
        "at which the count changes"
    ]
