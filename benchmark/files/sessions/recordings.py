"""What the files of a session's trials hold: the bench's own tables and recordings, and files of other instruments.

A file of another instrument may hold several trials, and its header may tell of tool and specimen. How it is read is
`bench_hw.instrument_files`; what a session makes of it is here.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from bench_hw.errors import BenchError
from bench_hw.instrument_files import (
    ENDINGS,
    NoNumbersError,
    Reading,
    Told,
    ending_of,
    is_plain_trial,
    is_told_of,
    preview,
    read_instrument_file,
)
from bench_hw.instrument_files.mcap_topics import is_foreign
from bench_hw.tables import TrialTable
from bench_hw.trial_file import ending_of_trial
from benchmark.errors import InputError
from benchmark.files.sessions.description import ConditionKeys, SessionFile, TrialEntry
from benchmark.files.sessions.doubts import pressed_negative
from benchmark.files.sessions.session_folder import SESSION_FILE
from benchmark.files.sessions.trials import read_table
from benchmark.files.units import LENGTH, format_quantity, parse_quantity, split_uncertainty

NOTES = (".txt", ".dat", ".asc", ".tab", ".tsv")
"""Endings of text that need not be a trial: without rows of numbers it is left aside where nobody listed it."""


NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
"""A number that stands by itself in a text."""
BOTH_TURNED = "force and depth only fall as the tool presses: both are turned"
"""Said of the bench's own tables."""
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
    columns : Mapping[str, str]
        Where each quantity stood in another instrument's file, "NAME [UNIT]"; empty for the bench's own.
    """

    entry: TrialEntry
    name: str
    table: TrialTable
    header: Reading = field(default_factory=Reading)
    notes: tuple[str, ...] = ()
    kind: str = "press"
    columns: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Recordings:
    """All trials of a session as their files hold them, and what people must know of them.

    Attributes
    ----------
    trials : tuple of Recording
        In the order of the files.
    shown : tuple of str
        What was read, for people to see.
    warnings : tuple of str
        What was found out in reading, and `aside`.
    aside : tuple of str
        Files that were left aside, or that a fault ended.
    """

    trials: tuple[Recording, ...]
    shown: tuple[str, ...]
    warnings: tuple[str, ...]
    aside: tuple[str, ...] = ()


def is_instruments(path: Path) -> bool:
    """Whether a file is to be read as another instrument wrote it, not as the bench's own."""
    if path.suffix.lower() == ".mcap":
        return is_foreign(path)
    return ending_of(path) in ENDINGS and not (path.suffix.lower() == ".csv" and is_plain_trial(path))


def read_recordings(file: SessionFile, paths: Sequence[Path], *, listed: bool) -> Recordings:
    """Read the trials of all files; raises InputError.

    Parameters
    ----------
    file : SessionFile
        The session's description.
    paths : sequence of Path
        Of its entries.
    listed : bool
        Whether somebody listed the files; what is no table, or a recording that a fault ended, is left aside where
        nobody did.
    """
    trials: list[Recording] = []
    shown: list[str] = []
    aside: list[str] = []
    for entry, path in zip(file.trials, paths, strict=True):
        told = _told(file, entry, path)
        if told is None:
            ending, used = _ending(path, listed=listed)
            aside += ending
            trials += [_own(entry, path)] if used else []
            continue
        try:
            read = read_instrument_file(path, told)
        except NoNumbersError as error:
            if listed or path.suffix.lower() not in NOTES:
                apart = (
                    "" if listed else " Where it is no trial, keep it elsewhere, or list the trials in session.toml."
                )
                raise InputError(f"{error}.{apart}") from None
            aside.append(f"{path.name} holds no rows of numbers and is left aside")
            continue
        except BenchError as error:
            raise InputError(f"{error}.") from None
        several = len(read.records) > 1
        trials += [
            Recording(entry, each.name if several else "", each.table, read.header, each.notes, each.kind, each.columns)
            for each in read.records
        ]
        shown += preview(read)
    if not trials:
        said = "".join(f" {each}." for each in aside)
        raise InputError(f"{paths[0].parent}: no file holds a trial; allowed: tables with time, depth and force.{said}")
    return Recordings(tuple(trials), tuple(shown), (*_warnings(trials), *aside), tuple(aside))


def _own(entry: TrialEntry, path: Path) -> Recording:
    """The bench's own table, with press positive where its numbers surely say that it is negative."""
    table = read_table(path)
    if not pressed_negative(table):
        return Recording(entry, "", table)
    return Recording(entry, "", replace(table, depth=-table.depth, force=-table.force), notes=(BOTH_TURNED,))


def _ending(path: Path, *, listed: bool) -> tuple[list[str], bool]:
    """What is said of a recording of the bench that did not come to its end or was mended, and whether it is used."""
    if path.suffix.lower() != ".mcap":
        return [], True
    try:
        ending = ending_of_trial(path)
    except BenchError as error:
        raise InputError(f"{error}.") from None
    if ending.fault:
        used = "is used as it is" if listed else f"is left aside; where it is wanted, list it in a {SESSION_FILE}"
        return [f"{path.name} was ended by a fault ({ending.fault}) and {used}"], listed
    if ending.recovered:
        return [f"{path.name} was recovered from a recording that had lost something ({ending.recovered})"], True
    return [], True


def _told(file: SessionFile, entry: TrialEntry, path: Path) -> Told | None:
    """How to read a file as another instrument's; None for the bench's own, of which nobody said anything.

    The bench's own table counts depth as it is meant, so its touch is looked for only where that was asked for.
    """
    table = file.import_.with_own(entry.import_)
    told = table.told(entry.sheet)
    if is_instruments(path):
        return told
    if path.suffix.lower() == ".mcap" or not is_told_of(path, told):
        return None
    return told if "touch" in table.model_fields_set else replace(told, touch="none")


def _warnings(trials: Sequence[Recording]) -> list[str]:
    """What was found out in reading, once for all trials of which it is true but for its numbers, with their files."""
    said: dict[str, list[tuple[str, str]]] = {}
    for trial in trials:
        for note in trial.notes:
            said.setdefault(_numberless(note), []).append((note, trial.entry.file))
    pairs = (zip(*each, strict=True) for each in said.values())
    return [_of_files(_ranged(list(notes)), list(files), len(trials)) for notes, files in pairs]


def _ranged(notes: Sequence[str]) -> str:
    """The note of several trials, with the least and the largest of its one number that differs; else the first."""
    numbers = [NUMBER.findall(note) for note in notes]
    differing = [k for k, each in enumerate(zip(*numbers, strict=False)) if len(set(each)) > 1]
    if len(differing) != 1 or len({NUMBER.sub("#", note) for note in notes}) > 1:
        return notes[0]
    (k,) = differing
    values = sorted((each[k] for each in numbers), key=float)
    places = list(NUMBER.finditer(notes[0]))
    return f"{notes[0][: places[k].start()]}{values[0]} to {values[-1]}{notes[0][places[k].end() :]}"


def _of_files(note: str, files: Sequence[str], trials: int) -> str:
    """A note with the number of trials it is true of, and their files where it is not true of all."""
    if trials == 1:
        return note
    some = list(dict.fromkeys(files))
    listed = ", ".join(some[:3]) + (f" and {len(some) - 3} more" if len(some) > 3 else "")
    where = f" ({listed})" if len(files) < trials else ""
    return f"in {len(files)} of {trials} trials {note}{where}"


def _numberless(note: str) -> str:
    return "".join(letter for letter in note if not letter.isdigit())


def with_headers(file: SessionFile, trials: Sequence[Recording]) -> tuple[SessionFile, list[str]]:
    """The session with tool and support as headers of its files tell them, where nobody else does, and what they told.

    Raises
    ------
    InputError
        The headers of one condition contradict each other.
    """
    file, plates = _between_plates(file, trials)
    stated = {name: _stated(file, name) for name in dict.fromkeys(trial.entry.condition for trial in trials)}
    plates += _other_tools(stated, trials)
    told = {name: _tool(name, trials) for name, radius in stated.items() if radius is None}
    told = {name: keys for name, keys in told.items() if keys}
    if not told:
        return file, plates
    conditions = dict(file.conditions)
    for name, keys in told.items():
        own = conditions.get(name, ConditionKeys())
        conditions[name] = own.model_copy(update={"tool": {**keys, **own.tool}})
    common = next(iter(told.values()))
    alike = all(keys == common for keys in told.values()) and len(told) == len({t.entry.condition for t in trials})
    update: dict[str, Any] = {"conditions": conditions}
    if alike:
        update = {"tool": {**common, **file.tool}}
    said = sorted({source for trial in trials for source in trial.header.sources})
    return file.model_copy(update=update), [
        *plates,
        f"tool and specimen as the files' headers tell: {'; '.join(said)}",
    ]


def _stated(file: SessionFile, condition: str) -> Any:
    """The tool's radius as a person states it for a condition; None where nobody does."""
    own = file.conditions.get(condition, ConditionKeys()).tool
    return own.get("radius", file.tool.get("radius"))


def _other_tools(stated: Mapping[str, Any], trials: Sequence[Recording]) -> list[str]:
    """A warning of files whose headers tell of another tool than is stated."""
    found: dict[str, str] = {}
    for trial in trials:
        radius, text = trial.header.tool_radius, stated[trial.entry.condition]
        said = None if radius is None or not isinstance(text, str) else _metres(text)
        if radius is not None and said is not None and abs(radius - said) > 1e-3 * said:
            found.setdefault(trial.entry.file, f"{format_quantity(radius, LENGTH)}, stated {text}")
    if not found:
        return []
    listed = "; ".join(f"{file}: {tools}" for file, tools in list(found.items())[:5])
    more = f"; and {len(found) - 5} more" if len(found) > 5 else ""
    return [f"headers tell of another tool's radius than is stated, which is used: {listed}{more}"]


def _metres(text: str) -> float | None:
    """A length as text in m; None where it is none, which is refused where the tool is made of it."""
    try:
        return parse_quantity(split_uncertainty(text)[0], LENGTH)
    except ValueError:
        return None


CYLINDER: Final[Mapping[str, tuple[str, str]]] = {
    "compression": ("plates", "pressed between plates"),
    "tension": ("grips", "pulled by grips, force and depth positive as it is pulled"),
}
"""The support of what files call compression or tension, and its words."""


MOST_UNLIKE = 1.02
UNLIKE = " (stiffness goes with its square: put the files of each width into a sub-folder, a condition of its own)"
"""Said of radii in one condition whose ratio is more than that."""


def _between_plates(file: SessionFile, trials: Sequence[Recording]) -> tuple[SessionFile, list[str]]:
    """The session with the cylinders that its files tell of, in conditions of which nobody says what they were."""
    conditions, said = dict(file.conditions), []
    for name in dict.fromkeys(trial.entry.condition for trial in trials):
        own, keys = [each for each in trials if each.entry.condition == name], conditions.get(name, ConditionKeys())
        kinds = {each.kind for each in own}
        stated = "kind" in {**file.support, **keys.support} or "radius" in {**file.tool, **keys.tool}
        if stated or len(kinds) > 1 or not kinds <= set(CYLINDER):
            continue
        told = file.import_.told().area
        radii = [math.sqrt((told or each.header.area or 0.0) / math.pi) for each in own]
        radius, (kind, words) = float(np.median(radii)), CYLINDER[kinds.pop()]
        text = format_quantity(radius, LENGTH)
        conditions[name] = keys.model_copy(update={"support": {"kind": kind, "specimen_radius": text, **keys.support}})
        spread = (
            f", from {1e3 * min(radii):.4g} to {1e3 * max(radii):.4g} mm" if max(radii) > 1.001 * min(radii) else ""
        )
        spread += UNLIKE if max(radii) > MOST_UNLIKE * min(radii) else ""
        said.append(
            f"condition {name}: a cylinder {words}, of {1e3 * radius:.4g} mm radius by its cross-section{spread}; its "
            "faces stick unless told: --set tool.contact=rigid_frictionless where they slide"
        )
    return file.model_copy(update={"conditions": conditions}), said


TURN = (
    'Turn it where pressing is negative: --set import.depth="-depth_mm:mm", the force by --set '
    'import.force="-force_N:N".'
)
UNTOUCHED = "A recording that ended before its tool touched, or that only rests, holds no press: record it anew."
"""Of the bench's own recordings, whose depth zero is the contact and whose columns nothing turns."""


def check_tool_is_told(file: SessionFile, trials: Sequence[Recording]) -> None:
    """Refuse presses for which the usual tool is out of the question, where nobody says which it was.

    Raises
    ------
    InputError
        A condition is never pressed at all, or less deep than `SHALLOWEST` while its tool's radius is not told.
    """
    for name in dict.fromkeys(trial.entry.condition for trial in trials):
        own = [trial for trial in trials if trial.entry.condition == name]
        deepest = max(float(trial.table.depth.max()) for trial in own)
        keys = file.conditions.get(name, ConditionKeys())
        if deepest < SHALLOWEST and "radius" not in file.tool and "radius" not in keys.tool:
            if deepest <= 0.0:
                least = min(float(trial.table.depth.min()) for trial in own)
                of_bench = all(trial.entry.file.lower().endswith(".mcap") and not trial.notes for trial in own)
                raise InputError(
                    f"condition {name}: the depth is never above zero (down to {1e3 * least:.4g} mm); allowed: press "
                    f"positive. {UNTOUCHED if of_bench else TURN}"
                )
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
            "put the files of each tool into a sub-folder, or state tool.radius in a session.toml (or by --set "
            'tool.radius="..." of fit, run and discover).'
        )
    radius, ball = known.pop()
    assert radius is not None
    text = format_quantity(radius, LENGTH)
    return {"radius": text, "edge_radius": text, "contact": "rigid_frictionless"} if ball else {"radius": text}


def recorded_names(trials: Sequence[Recording], names: Sequence[str]) -> list[str]:
    """A name for each trial: its file's, and its own in it where that holds several; numbered where two are alike."""
    full = [f"{name} {trial.name}".strip() for name, trial in zip(names, trials, strict=True)]
    times = Counter(full)
    return [name if times[name] == 1 else f"{name} #{number}" for number, name in enumerate(full, start=1)]
