"""A film that started at another time than its trial, put on the trial's clock by the press.

Markers move as the tool goes in.
Their mean way from where they rested, m(t), is fitted by a cubic of the depth d (zero in air) at the film's instants
shifted by tau, m = a + b d(t + tau) + c d(t + tau)^2 + e d(t + tau)^3; the tau of least squares is the film's clock.
Its standard deviation is that of the curvature of the sum of squares, widened by how long residuals stay alike. A
second minimum that is nearly as deep (a press like the one before) is not decided here: it is asked for. Pictures that
repeat the one before are left out: they are older than their time says. Where the motion up to an instant and from
there on surely have another tau, or tau surely grows, the film's clock is broken (pictures are missing, or its rate is
another): it is refused. A tool with play parts them by up to three frames, too: up to there the deviation takes half of
the difference along.
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
AT_ONCE = 20_000
"""Shifts times frames that are tried at once."""
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
PARTED = tuple(np.linspace(0.1, 0.9, 41).tolist())
"""Shares of the tool's way at which the film's clock may have jumped."""
STEPS_OF_TWO = 25
"""Of Gauss and Newton."""
REPEATED = 0.1
"""Of the usual way of the markers over two pictures: less from one to the next is noise of the same picture."""
SURE = 10.0
"""Standard deviations of the difference of two shifts beyond which they differ."""
LEAST_FRAMES = 3.0
"""Frames by which they must differ besides."""
DOUBTED = 8.0
"""Standard deviations of that difference beyond which the shift's own deviation takes half of it along: sound films of
few pictures in motion have up to 7."""


@dataclass(frozen=True)
class ClockShift:
    """What is added to the film's times (s), its standard deviation (s), and the share of variance it explains.

    `parted` is by how much beginning and end of the film differ in it (s), zero where that is not sure.
    """

    shift: float
    deviation: float
    explained: float
    parted: float = 0.0


def marker_way(markers: MarkerTable) -> tuple[Array, Array]:
    """Frames (f,) s and the mean way (f,) m of all markers from their median place in the first tenth of the frames.

    Each marker's way is along the line on which it goes, so that noise adds to it as much as it takes off; its distance
    would begin with a corner where the motion is as small as the noise. Frames that repeat the one before are left out.
    """
    frames = np.unique(markers.time)
    numbers = [markers.marker == number for number in np.unique(markers.marker)]
    places = np.array(
        [[np.interp(frames, markers.time[mine], values[mine]) for values in (markers.x, markers.y)] for mine in numbers]
    )
    rest = max(3, len(frames) // 10)
    moved = places - np.median(places[:, :, :rest], axis=2, keepdims=True)
    line = moved.sum(axis=2, keepdims=True)
    line /= np.maximum(np.linalg.norm(line, axis=1, keepdims=True), 1e-300)
    way = (moved * line).sum(axis=1).mean(axis=0)
    fresh = np.ones(len(frames), dtype=bool)
    if len(frames) > 2:
        once, twice = (np.sqrt(((places[..., k:] - places[..., :-k]) ** 2).mean(axis=(0, 1))) for k in (1, 2))
        fresh[1:] = once >= REPEATED * np.quantile(twice, 0.75)
    return frames[fresh], way[fresh]


def film_shift(name: str, table: TrialTable, markers: MarkerTable) -> ClockShift:
    """By how much the film's clock is behind the trial's.

    Raises
    ------
    InputError
        The markers do not follow the press, two shifts are as likely, or parts of the motion have other ones.
    """
    frames, way = marker_way(markers)
    found = _one_shift(name, table, frames, way)
    parted = _parted(name, table, frames, way, found.shift)
    return replace(found, deviation=float(np.hypot(found.deviation, 0.5 * parted)), parted=parted)


def _one_shift(name: str, table: TrialTable, frames: Array, way: Array, powers: int = 3) -> ClockShift:
    """The shift of all frames, by powers of the depth; raises InputError where there is none, or two are as likely."""
    step = max(float(np.median(np.diff(frames))), float(np.median(np.diff(table.time)))) / STEPS
    overlap = 0.5 * min(float(np.ptp(frames)), float(np.ptp(table.time)))
    shifts = np.arange(table.time[0] - frames[-1] + overlap, table.time[-1] - frames[0] - overlap, step)
    if len(shifts) < 5:
        raise InputError(f"trial {name}: film and force are too short to be aligned; allowed: a whole press in both.")
    squares = _squares(table, frames, way, shifts, powers)
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
    alike = _stretch_alike(_residual(table, frames + shifts[best], way, powers))
    return _refined(shifts, squares, best, len(frames), alike, explained)


def _parted(name: str, table: TrialTable, frames: Array, way: Array, shift: float) -> float:
    """By how much the shift jumps at some instant, or grows evenly, s; raises InputError where it surely does."""
    depth = _depth(table, frames + shift)
    moved = np.cumsum(np.abs(np.diff(depth, prepend=depth[0])))
    lateness = [(moved >= share * moved[-1]).astype(np.float64) for share in PARTED]
    lateness.append((frames - frames[0]) / (frames[-1] - frames[0]))
    found = [_two_shifts(table, frames, way, shift, late) for late in lateness]
    first, second, deviation = max(found, key=lambda each: abs(each[1] - each[0]) / max(each[2], 1e-12))
    apart, most = abs(second - first), LEAST_FRAMES * float(np.median(np.diff(frames)))
    if apart > SURE * deviation and apart > most:
        raise InputError(
            f"trial {name}: the film's clock does not run as the force's: the film's beginning is shifted by "
            f"{first:.3f} s, its end by {second:.3f} s (standard deviation of the difference {deviation:.3f} s). "
            "Pictures are missing between, or the film's rate is another than it says; allowed: a film with all its "
            "pictures at its true rate, or tracks with their true times."
        )
    return min(apart, most) if apart > DOUBTED * deviation else 0.0


def _two_shifts(table: TrialTable, frames: Array, way: Array, shift: float, late: Array) -> tuple[float, float, float]:
    """Shifts where `late` (f,) is 0 and 1, with all between, and the standard deviation of their difference, s.

    One cubic of the depth is for all. By Gauss and Newton from a common shift, two frames a step at most; the
    deviation is by what two shifts explain more than one.
    """
    shifts, most, squares = np.array([shift, shift]), 2.0 * float(np.median(np.diff(frames))), []
    for _ in range(STEPS_OF_TWO):
        at = frames + shifts[0] + (shifts[1] - shifts[0]) * late
        depth, before, after = (_depth(table, at + aside) for aside in (0.0, -0.5 * most, 0.5 * most))
        columns = _columns(depth)
        curve = np.linalg.lstsq(columns, way, rcond=None)[0]
        speed = (_columns(after) - _columns(before)) @ curve / most
        left = way - columns @ curve
        squares.append((float(left @ left), *shifts))
        whole = np.column_stack([columns, speed * (1.0 - late), speed * late])
        shifts = shifts + np.clip(np.linalg.lstsq(whole, left, rcond=None)[0][-2:], -most, most)
    least, first, second = min(squares)
    gain = (squares[0][0] - least) / max(least, 1e-300) * max(len(way) - 6, 1) / _stretch_alike(left)
    return first, second, abs(second - first) / max(float(np.sqrt(gain)), 1e-9)


def _refined(shifts: Array, squares: Array, best: int, count: int, alike: float, explained: float) -> ClockShift:
    """The parabola's minimum through the three lowest, and its deviation: 2 s^2 over the curvature, times `alike`."""
    left, middle, right = squares[best - 1 : best + 2]
    step = float(shifts[1] - shifts[0])
    bend = max(float(left - 2.0 * middle + right), 1e-300)
    offset = float(np.clip(0.5 * (left - right) / bend, -1.0, 1.0)) * step
    variance = 2.0 * (float(middle) / max(count - 4, 1)) / (bend / step**2) * alike
    return ClockShift(float(shifts[best]) + offset, float(np.sqrt(variance)), explained)


def _depth(table: TrialTable, times: Array) -> Array:
    """Depth in mm; in air, where nothing moves, 0."""
    return np.asarray(1e3 * np.clip(np.interp(times, table.time, table.depth), 0.0, None))


def _columns(depth: Array, powers: int = 3) -> Array:
    """Powers (f, powers + 1) of a depth (f,), the zeroth first."""
    return np.vander(depth, powers + 1, increasing=True)


def _residual(table: TrialTable, times: Array, way: Array, powers: int) -> Array:
    columns = _columns(_depth(table, times), powers)
    return np.asarray(way - columns @ np.linalg.lstsq(columns, way, rcond=None)[0])


def _squares(table: TrialTable, frames: Array, way: Array, shifts: Array, powers: int) -> Array:
    """Sums of squares (s,) at shifts (s,), by normal equations of the depth over its greatest, many at a time."""
    most, out = max(1e3 * float(table.depth.max()), 1e-9), []
    for some in np.array_split(shifts, len(shifts) * len(frames) // AT_ONCE + 1):
        depth = _depth(table, frames + some[:, None]) / most
        rows = np.stack([depth**power for power in range(powers + 1)], axis=1)
        curves = np.linalg.pinv(rows @ rows.swapaxes(1, 2), hermitian=True) @ (rows @ way)[..., None]
        out.append(((way - (curves.swapaxes(1, 2) @ rows)[:, 0]) ** 2).sum(axis=1))
    return np.concatenate(out)


def _stretch_alike(left: Array) -> float:
    """How many frames residuals stay alike: (1 + r) / (1 - r) of their first autocorrelation, one at least."""
    r = float(left[1:] @ left[:-1]) / max(float(left @ left), 1e-300)
    return max(1.0, (1.0 + r) / max(1.0 - r, 1e-3))


def on_trials_clock(name: str, table: TrialTable, markers: MarkerTable) -> tuple[MarkerTable, str]:
    """Markers with their times on the trial's clock, and the sentence that says by how much they were shifted."""
    found = film_shift(name, table, markers)
    said = (
        f"trial {name}: the film's clock is shifted by {found.shift:.4f} s (standard deviation {found.deviation:.4f} "
        f"s), found from the press: it explains {100 * found.explained:.1f} % of the markers' way"
    )
    if found.parted:
        said += (
            f"; its beginning and end differ by {found.parted:.3f} s, as where a few pictures are missing, the rate is "
            "another or the tool has play: the deviation has half of that"
        )
    return replace(markers, time=markers.time + found.shift), said


def doubtful_clocks(names: Sequence[str], tables: Sequence[TrialTable], films: Sequence[MarkerTable]) -> list[str]:
    """A warning of films that are said to be on their trials' clock, and follow the press at another time.

    By a quadratic: a cubic follows a tool with backlash closely, too.
    """
    off: dict[str, float] = {}
    for name, table, film in zip(names, tables, films, strict=True):
        frames = np.unique(film.time)
        kept = np.isin(film.time, frames[:: len(frames) // ENOUGH + 1])
        columns = {key: getattr(film, key)[kept] for key in ("time", "marker", "x", "y")}
        try:
            found = _one_shift(name, table, *marker_way(replace(film, **columns)), powers=2)
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
