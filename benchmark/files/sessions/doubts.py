"""Remarks on the numbers of single trials: glitches, a sensor's end, turned signs, times that may be milliseconds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from bench_hw.tables import TrialTable, calm

STANDS: Final = 0.1
"""Share of the travel over which a force that does not change by one digit is no tissue's."""
TURNED: Final = 0.2
"""Of the way down that a press with its signs turned goes up at most."""
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


EITHER_WAY: Final = (
    '--set import.force="force_N:N" --set import.depth="depth_mm:mm" finds out from each file which way is pressing'
)
"""What to write for trial tables whose signs are turned, in all files or in some."""


def _turned(trials: Sequence[tuple[str, TrialTable]]) -> str:
    """What to say of trials upside down, by the first of them."""
    name, table = trials[0]
    force, depth = float(table.force.min()), float(table.depth.min())
    others = [each for each, _ in trials[1:]]
    listed = ", ".join(others[:3]) + (f" and {len(others) - 3} more" if len(others) > 3 else "")
    too = f" (so do {listed})" if others else ""
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
    more = f" and {len(found) - 3} more" if len(found) > 3 else ""
    return [f"times may be milliseconds where seconds are read: {', '.join(found[:3])}{more}"]


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
