"""A film that started at another time than its trial, put on the trial's clock by the press.

Markers move as the tool goes in.
Their mean way from where they rested, m(t), is fitted by a quadratic of the depth d (zero in air) at the film's
instants shifted by tau, m = a + b d(t + tau) + c d(t + tau)^2; the tau of least squares is the film's clock. Its
standard deviation is that of the curvature of the sum of squares, widened by how long residuals stay alike. A second
minimum that is nearly as deep (a press like the one before) is not decided here: it is asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bench_hw.tables import MarkerTable, TrialTable
from benchmark.errors import InputError

Array = NDArray[np.float64]
STEPS = 4
"""Shifts tried for each step of the slower clock."""
RIVAL = 1.5
"""Of the least sum of squares: another shift, apart by a tenth of the press, below so much could be the right one."""
LATE, SURELY = 0.1, 6.0
"""Seconds, and standard deviations of the shift, beyond which markers that share the trial's clock are off it."""
CLOSELY = 0.998
"""Of the markers' variance that the shift then explains: a tool with backlash follows late, too, but less closely."""
ENOUGH = 500
"""Pictures that tell so, of a film that has more."""
LEAST_EXPLAINED = 0.9
"""Of the markers' variance that the best shift must explain."""


@dataclass(frozen=True)
class ClockShift:
    """What is added to the film's times (s), its standard deviation (s), and the share of variance it explains."""

    shift: float
    deviation: float
    explained: float


def marker_way(markers: MarkerTable) -> tuple[Array, Array]:
    """Frames (f,) s and the mean way (f,) m of all markers from their median place in the first tenth of the frames."""
    frames = np.unique(markers.time)
    ways = []
    for number in np.unique(markers.marker):
        mine = markers.marker == number
        x, y = (np.interp(frames, markers.time[mine], values[mine]) for values in (markers.x, markers.y))
        rest = max(3, len(frames) // 10)
        ways.append(np.hypot(x - np.median(x[:rest]), y - np.median(y[:rest])))
    return frames, np.mean(ways, axis=0)


def film_shift(name: str, table: TrialTable, markers: MarkerTable) -> ClockShift:
    """By how much the film's clock is behind the trial's.

    Raises
    ------
    InputError
        The markers do not follow the press, or two shifts are as likely.
    """
    frames, way = marker_way(markers)
    step = max(float(np.median(np.diff(frames))), float(np.median(np.diff(table.time)))) / STEPS
    overlap = 0.5 * min(float(np.ptp(frames)), float(np.ptp(table.time)))
    shifts = np.arange(table.time[0] - frames[-1] + overlap, table.time[-1] - frames[0] - overlap, step)
    if len(shifts) < 5:
        raise InputError(f"trial {name}: film and force are too short to be aligned; allowed: a whole press in both.")
    squares = np.array([_squares(table, frames + shift, way) for shift in shifts])
    best = int(np.clip(np.argmin(squares), 1, len(shifts) - 2))
    total = float(((way - way.mean()) ** 2).sum())
    explained = 1.0 - float(squares[best]) / max(total, 1e-300)
    if explained < LEAST_EXPLAINED:
        raise InputError(
            f"trial {name}: the markers do not follow the press at any shift of the film ({100 * explained:.0f} % of "
            f'their way explained); allowed: a film of this press, or one clock (camera.clock = "shared").'
        )
    apart = np.abs(shifts - shifts[best]) > 0.1 * float(np.ptp(frames))
    valley = apart & (squares <= np.roll(squares, 1)) & (squares <= np.roll(squares, -1))
    rival = shifts[valley & (squares < RIVAL * squares[best])]
    if len(rival):
        raise InputError(
            f"trial {name}: the film fits the force shifted by {shifts[best]:.3f} s and by {rival[0]:.3f} s; allowed: "
            f'a film that shows the whole record, or marker times on the trial\'s clock (camera.clock = "shared").'
        )
    return _refined(shifts, squares, best, len(frames), _alike(table, frames + shifts[best], way), explained)


def _refined(shifts: Array, squares: Array, best: int, count: int, alike: float, explained: float) -> ClockShift:
    """The parabola's minimum through the three lowest, and its deviation: 2 s^2 over the curvature, times `alike`."""
    left, middle, right = squares[best - 1 : best + 2]
    step = float(shifts[1] - shifts[0])
    bend = max(float(left - 2.0 * middle + right), 1e-300)
    offset = float(np.clip(0.5 * (left - right) / bend, -1.0, 1.0)) * step
    variance = 2.0 * (float(middle) / max(count - 4, 1)) / (bend / step**2) * alike
    return ClockShift(float(shifts[best]) + offset, float(np.sqrt(variance)), explained)


def _residual(table: TrialTable, times: Array, way: Array) -> Array:
    depth = 1e3 * np.clip(np.interp(times, table.time, table.depth), 0.0, None)  # in air nothing moves
    columns = np.column_stack([np.ones_like(depth), depth, depth**2])
    return np.asarray(way - columns @ np.linalg.lstsq(columns, way, rcond=None)[0])


def _squares(table: TrialTable, times: Array, way: Array) -> float:
    return float((_residual(table, times, way) ** 2).sum())


def _alike(table: TrialTable, times: Array, way: Array) -> float:
    """How many frames residuals stay alike: (1 + r) / (1 - r) of their first autocorrelation, one at least."""
    left = _residual(table, times, way)
    r = float(left[1:] @ left[:-1]) / max(float(left @ left), 1e-300)
    return max(1.0, (1.0 + r) / max(1.0 - r, 1e-3))


def on_trials_clock(name: str, table: TrialTable, markers: MarkerTable) -> tuple[MarkerTable, str]:
    """Markers with their times on the trial's clock, and the sentence that says by how much they were shifted."""
    found = film_shift(name, table, markers)
    said = (
        f"trial {name}: the film's clock is shifted by {found.shift:.4f} s (standard deviation {found.deviation:.4f} "
        f"s), found from the press: it explains {100 * found.explained:.1f} % of the markers' way"
    )
    return replace(markers, time=markers.time + found.shift), said


def doubtful_clocks(names: Sequence[str], tables: Sequence[TrialTable], films: Sequence[MarkerTable]) -> list[str]:
    """A warning of films that are said to be on their trials' clock, and follow the press at another time."""
    off: dict[str, float] = {}
    for name, table, film in zip(names, tables, films, strict=True):
        frames = np.unique(film.time)
        kept = np.isin(film.time, frames[:: len(frames) // ENOUGH + 1])
        columns = {key: getattr(film, key)[kept] for key in ("time", "marker", "x", "y")}
        try:
            found = film_shift(name, table, replace(film, **columns))
        except InputError:
            continue  # they do not move, or tell no time
        if abs(found.shift) > max(LATE, SURELY * found.deviation) and found.explained > CLOSELY:
            off[name] = found.shift
    if not off:
        return []
    first = [f"{name} ({shift:+.3f} s)" for name, shift in list(off.items())[:3]]
    more = f" and {len(off) - 3} more" if len(off) > 3 else ""
    return [
        f"the markers follow the press at other times than their own: {', '.join(first)}{more}; allowed: times on the "
        'trial\'s clock, or camera.clock = "press", which adds these shifts'
    ]
