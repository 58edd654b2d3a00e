"""What the files of a session's trials hold: the bench's own tables and recordings, and files of other instruments.

A file of another instrument may hold several trials, and its header may tell of tool and specimen. How it is read is
`bench_hw.instrument_files`; what a session makes of it is here.

A film that started at another time than the force is put on its clock by the press. Markers move as the tool goes in.
Their mean way from where they rested, m(t), is fitted by a quadratic of the depth d (zero in air) at the film's
instants shifted by tau, m = a + b d(t + tau) + c d(t + tau)^2; the tau of least squares is the film's clock. Its
standard deviation is that of the curvature of the sum of squares, widened by how long residuals stay alike. A second
minimum that is nearly as deep (a press like the one before) is not decided here: it is asked for.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import BenchError
from bench_hw.instrument_files import ENDINGS, NoNumbersError, Reading, is_plain_trial, preview, read_instrument_file
from bench_hw.tables import MarkerTable, TrialTable
from benchmark.errors import InputError
from benchmark.files.sessions.description import ConditionKeys, SessionFile, TrialEntry
from benchmark.files.sessions.trials import read_table
from benchmark.files.units import LENGTH, format_quantity

Array = NDArray[np.float64]
NOTES = (".txt", ".dat", ".asc", ".tab", ".tsv")
"""Endings of text that need not be a trial: without rows of numbers it is left aside where nobody listed it."""


SHALLOWEST = 25e-6
"""A session pressed less deep (m) has no tool of the assumed 5 mm radius, 200 times as wide: it is asked for."""


@dataclass(frozen=True, eq=False)
class Recording:
    """One trial of a file.

    Attributes
    ----------
    entry : TrialEntry
        What the session says of it.
    name : str
        In its file; "" where that holds but one.
    table : TrialTable
        SI, press positive.
    header : Reading
        What its file tells of tool and specimen.
    notes : tuple of str
        What was found out or changed in reading.
    kind : str
        press | compression | tension.
    """

    entry: TrialEntry
    name: str
    table: TrialTable
    header: Reading = field(default_factory=Reading)
    notes: tuple[str, ...] = ()
    kind: str = "press"


@dataclass(frozen=True, eq=False)
class Recordings:
    """All trials of a session as their files hold them, what was read for people to see, and what was left aside."""

    trials: tuple[Recording, ...]
    shown: tuple[str, ...]
    warnings: tuple[str, ...]


def is_instruments(path: Path) -> bool:
    """Whether a file is to be read as another instrument wrote it, not as the bench's own."""
    return path.suffix.lower() in ENDINGS and not (path.suffix.lower() == ".csv" and is_plain_trial(path))


def read_recordings(file: SessionFile, paths: Sequence[Path], *, listed: bool) -> Recordings:
    """Read the trials of all files; raises InputError.

    Parameters
    ----------
    file : SessionFile
        The session's description.
    paths : sequence of Path
        Of its entries.
    listed : bool
        Whether somebody listed the files; what is no table is left aside where nobody did.
    """
    trials: list[Recording] = []
    shown: list[str] = []
    aside: list[str] = []
    for entry, path in zip(file.trials, paths, strict=True):
        if not is_instruments(path):
            trials.append(Recording(entry, "", read_table(path)))
            continue
        try:
            read = read_instrument_file(path, file.import_.told(entry.sheet))
        except NoNumbersError as error:
            if listed or path.suffix.lower() not in NOTES:
                raise InputError(f"{error}.") from None
            aside.append(f"{path.name} holds no rows of numbers and is left aside")
            continue
        except BenchError as error:
            raise InputError(f"{error}.") from None
        several = len(read.records) > 1
        trials += [
            Recording(entry, each.name if several else "", each.table, read.header, each.notes, each.kind)
            for each in read.records
        ]
        shown += preview(read)
    if not trials:
        raise InputError(f"{paths[0].parent}: no file holds a trial; allowed: tables with time, depth and force.")
    return Recordings(tuple(trials), tuple(shown), (*_warnings(trials), *aside))


def _warnings(trials: Sequence[Recording]) -> list[str]:
    """What was found out in reading, once for all trials of which it is true but for its numbers."""
    told = Counter(_numberless(note) for trial in trials for note in trial.notes)
    first = {_numberless(note): note for trial in reversed(trials) for note in reversed(trial.notes)}
    return [
        f"in {count} of {len(trials)} trials {first[text]}" if len(trials) > 1 else first[text]
        for text, count in told.items()
    ]


def _numberless(note: str) -> str:
    return "".join(letter for letter in note if not letter.isdigit())


def with_headers(file: SessionFile, trials: Sequence[Recording]) -> tuple[SessionFile, list[str]]:
    """The session with tool and support as headers of its files tell them, where nobody else does, and what they told.

    Raises
    ------
    InputError
        The headers of one condition contradict each other.
    """
    told = {name: _tool(name, trials) for name in dict.fromkeys(trial.entry.condition for trial in trials)}
    told = {name: keys for name, keys in told.items() if keys and "radius" not in file.tool}
    if not told:
        return file, []
    conditions = dict(file.conditions)
    for name, keys in told.items():
        own = conditions.get(name, ConditionKeys())
        if "radius" not in own.tool:
            conditions[name] = own.model_copy(update={"tool": {**keys, **own.tool}})
    common = next(iter(told.values()))
    alike = all(keys == common for keys in told.values()) and len(told) == len({t.entry.condition for t in trials})
    update: dict[str, Any] = {"conditions": conditions}
    if alike:
        update = {"tool": {**common, **file.tool}}
    said = sorted({source for trial in trials for source in trial.header.sources})
    return file.model_copy(update=update), [f"tool and specimen as the files' headers tell: {'; '.join(said)}"]


def check_tool_is_told(file: SessionFile, trials: Sequence[Recording]) -> None:
    """Refuse presses for which the usual tool is out of the question, where nobody says which it was.

    Raises
    ------
    InputError
        A condition is pressed less deep than `SHALLOWEST` and its tool's radius is not told.
    """
    for name in dict.fromkeys(trial.entry.condition for trial in trials):
        own = [trial for trial in trials if trial.entry.condition == name]
        deepest = max(float(trial.table.depth.max()) for trial in own)
        keys = file.conditions.get(name, ConditionKeys())
        if deepest < SHALLOWEST and "radius" not in file.tool and "radius" not in keys.tool:
            raise InputError(
                f"condition {name}: pressed {1e6 * deepest:.3g} um deep, and neither file nor "
                f"session tells the tool's radius; 5 mm are assumed from {1e6 * SHALLOWEST:g} um on. "
                "State it: "
                '--set tool.radius="..." (for a ball also --set tool.edge_radius="..." of the same value and '
                "--set tool.contact=rigid_frictionless), or the keys in session.toml."
            )


def _tool(condition: str, trials: Sequence[Recording]) -> dict[str, str]:
    headers = {
        (trial.header.tool_radius, trial.header.spherical) for trial in trials if trial.entry.condition == condition
    }
    known = {each for each in headers if each[0] is not None}
    if not known:
        return {}
    if len(known) > 1:
        radii = ", ".join(sorted(format_quantity(radius, LENGTH) for radius, _ in known if radius is not None))
        raise InputError(
            f"condition {condition}: the files' headers tell of different tools ({radii}); allowed: one a condition: "
            f'put the files into sub-folders, or state tool.radius (--set tool.radius="5 mm").'
        )
    radius, ball = known.pop()
    assert radius is not None
    text = format_quantity(radius, LENGTH)
    return {"radius": text, "edge_radius": text, "contact": "rigid_frictionless"} if ball else {"radius": text}


def told_heights(trials: Sequence[Recording]) -> list[float]:
    """Heights of specimens (m) that headers tell of."""
    return [trial.header.height for trial in trials if trial.header.height is not None]


def recorded_names(trials: Sequence[Recording], names: Sequence[str]) -> list[str]:
    """A name for each trial: its file's, and its own in it where that holds several; numbered where two are alike."""
    full = [f"{name} {trial.name}".strip() for name, trial in zip(names, trials, strict=True)]
    times = Counter(full)
    return [name if times[name] == 1 else f"{name} #{number}" for number, name in enumerate(full, start=1)]


STEPS = 4
"""Shifts tried for each step of the slower clock."""
RIVAL = 1.5
"""Of the least sum of squares: another shift, apart by a tenth of the press, below so much could be the right one."""
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
