"""A proposal for a session's file, from what its trial files hold: `benchmark session new FOLDER`.

Conditions come from how the tool moved (how fast, how deep, how long held), tool and specimen from headers, the
thickness from the gap at the first touch where the base is known, the marker grid from the tables of markers. What
only a person can say is marked SAY.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from bench_hw.instrument_files.press_record import phases
from bench_hw.tables import MarkerTable, TrialTable
from benchmark.errors import InputError
from benchmark.files.loading import Overrides
from benchmark.files.overrides import put_in
from benchmark.files.schema import validated
from benchmark.files.sessions.description import SessionFile
from benchmark.files.sessions.doubts import doubtful_forces, doubtful_kinds, doubtful_times, force_hold, with_drive
from benchmark.files.sessions.recordings import BOTH_TURNED, Recording, read_recordings, with_headers
from benchmark.files.sessions.session_folder import (
    SESSION_FILE,
    inside,
    session_table,
    unclosed_recordings,
    unused_films,
)
from benchmark.files.sessions.specimens import assumed_specimen, heights_under, told_heights
from benchmark.files.sessions.trials import read_markers
from benchmark.files.sources import KeyPath, Source, is_file

ALIKE = 0.1
"""Of their mean, within which speeds, depths and holds are of one protocol; labs set them to round numbers."""
JUMP_ROWS = 5
"""Rows that a prescribed force takes to rise at least, as far as its rate is compared: a weight put on by hand begins
and ends anywhere between two of them. First choice."""
OFF_GRID = 0.2
"""Of the spacing, within which markers at rest stand where a grid has them: printed by hand, and seen at a slant."""
NOTHING: Overrides = {}
IMPORT = "import."
SPECIMEN_FILE, CAMERA_FILE = "specimen.toml", "camera.toml"


@dataclass(frozen=True)
class Motion:
    """How a trial moved: speed of the first way in (m/s), greatest depth (m), longest hold (s), presses.

    Where the force was prescribed (`by_force`) speed and depth are the force's: N/s, and N over its least.
    """

    speed: float
    depth: float
    hold: float
    presses: int
    by_force: bool = False

    @property
    def name(self) -> str:
        """Of the condition, in words that a path may hold."""
        held = f"_held_{_plain(self.hold)}s" if self.hold > 0.2 else ""
        many = f"_{self.presses}_presses" if self.presses > 1 else ""
        scale, unit = (1.0, "N") if self.by_force else (1e3, "mm")
        return f"{_plain(scale * self.speed)}{unit}_s_to_{_plain(scale * self.depth)}{unit}{held}{many}"

    def alike(self, other: Motion) -> bool:
        """Whether two trials are of one protocol."""
        pairs = ((self.speed, other.speed), (self.depth, other.depth), (self.hold, other.hold))
        near = all(abs(a - b) <= ALIKE * max(abs(a), abs(b)) + (0.1 if a is self.hold else 0.0) for a, b in pairs)
        return near and self.presses == other.presses


def _plain(value: float) -> str:
    """Two digits of a number, without an exponent where it is large: 397 is 400."""
    return f"{float(f'{value:.2g}'):g}"


def motion_of(table: TrialTable, *, by_force: bool = False) -> Motion:
    """How a trial moved, or what force it was given; its speed is that of the middle of the first way in."""
    if by_force:
        table = replace(table, depth=table.force - table.force.min())
        first, last = force_hold(table.force)
        presses, hold = phases(table)[0], float(table.time[last - 1] - table.time[first]) if last else 0.0
    else:
        presses, hold = phases(table)
    deepest = float(table.depth.max())
    first = int(np.argmax(table.depth >= 0.8 * deepest))
    start = int(np.flatnonzero(table.depth[: first + 1] <= 0.2 * deepest)[-1]) if first else 0
    duration = float(table.time[first] - table.time[start])
    if by_force:
        duration = max(duration, JUMP_ROWS * float(np.median(np.diff(table.time))))
    speed = float(table.depth[first] - table.depth[start]) / duration if duration > 0.0 else 0.0
    return Motion(speed, deepest, hold, presses, by_force)


@dataclass(frozen=True)
class Proposal:
    """The two files to write, by their names, what a person must say, and what was left aside in the folder."""

    texts: dict[str, str]
    to_say: tuple[str, ...]
    warnings: tuple[str, ...] = ()


def propose(folder: Path, told: Overrides = NOTHING) -> Proposal:
    """Look at the trials of a folder and propose its session.toml and the specimen it names.

    Parameters
    ----------
    folder
        Of the trials.
    told
        What is told of their columns, by keys as `import.force`; it goes into the session.toml, too.

    Raises
    ------
    InputError
        There is a session.toml already, or a specimen.toml other than the proposed one, which a kill may have left; a
        trial cannot be read; or something else than `import` is told.
    """
    _refuse_existing(folder / SESSION_FILE)
    table, source = session_table(folder)
    importing = _importing(told)
    keys: dict[str, KeyPath] = {f"{IMPORT}{key}": ("import", key) for key in importing}
    table, source = put_in(table, source, keys, told)
    file = validated(SessionFile, table, source)
    paths = [inside(source.folder, entry.file, entry.file) for entry in file.trials]
    read = read_recordings(file, paths, listed=False)
    resolved, _ = with_headers(file, read.trials)
    resolved, driven = with_drive(resolved, [trial.table for trial in read.trials])
    tools_told = {name: keys.tool for name, keys in resolved.conditions.items()} or {"": resolved.tool}
    specimen, why = assumed_specimen([trial.table for trial in read.trials], *told_heights(file, read.trials))
    named = _conditions(read.trials, resolved)
    tools = {tuple(sorted(tool.items())) for tool in tools_told.values() if tool}
    plates = bool(resolved.conditions) and all(keys.support for keys in resolved.conditions.values())
    camera, asked = _camera_lines(source, [entry.markers for entry in file.trials if entry.markers])
    to_say = (*(("tool.contact",) if plates else _to_say(tools, why)), *asked)
    head = [
        "# Proposed from the files of this folder. What only a person can say is marked SAY.",
        "schema = 1",
        f"name = {_text(file.name)}",
        f"specimen = {_text(SPECIMEN_FILE)}",
        *(["", "[import]", *(f"{key} = {_text(value)}" for key, value in importing.items())] if importing else []),
        "",
        "[tool]",
        *([] if plates else _tool_lines(tools)),
        'contact = "rigid_bonded"  # SAY: rigid_bonded where the surface sticks, rigid_frictionless where it slides',
        *_rig_lines(resolved),
        *camera,
        *(_of_conditions("tool", tools_told) if len(tools) > 1 else []),
    ]
    heights, said = heights_under(resolved, read.trials, specimen, assumed=True)
    trials = [line for entry in zip(read.trials, named, heights, strict=True) for line in _entry(*entry)]
    body = f"# SAY: layers, thickness and modulus; until then: {why}\n{specimen.to_toml()}"
    if not _holds(folder / SPECIMEN_FILE, body):
        _refuse_existing(folder / SPECIMEN_FILE)
    texts = {SPECIMEN_FILE: body, SESSION_FILE: "\n".join([*head, *trials]) + "\n"}
    turned = (each for each in read.warnings if BOTH_TURNED in each)
    doubts = (*driven, *turned, *_doubts(read.trials, named, resolved), *said)
    return Proposal(texts, to_say, (*doubts, *read.aside, *unclosed_recordings(source), *unused_films(source, paths)))


def _doubts(trials: Sequence[Recording], conditions: Sequence[str], file: SessionFile) -> list[str]:
    """What is odd about the numbers of files, as a command says that uses them, and about the trials of a condition."""
    names, tables = [each.entry.file for each in trials], [each.table for each in trials]
    kinds = doubtful_kinds(names, tables, conditions)
    forces = [] if file.drive.channel == "force" else doubtful_forces(names, tables)
    return [*forces, *doubtful_times(names, tables), *kinds]


def _importing(told: Overrides) -> dict[str, str]:
    """The keys of [import] that are told."""
    other = [key for key in told if not key.startswith(IMPORT)]
    if other:
        raise InputError(
            f"--set {other[0]}: session new takes {IMPORT}KEY alone, by which files are read; anything else is written "
            f"into the {SESSION_FILE} that it proposes"
        )
    return {key.removeprefix(IMPORT): value for key, value in told.items()}


def write_proposal(folder: Path, proposal: Proposal) -> list[Path]:
    """Write the files of a proposal, both or none, the one last by which the folder becomes a session.

    Raises
    ------
    InputError
        One cannot be written.
    """
    from reports.atomic import write_text

    new = {folder / name: text for name, text in proposal.texts.items() if not _holds(folder / name, text)}
    written: list[Path] = []
    try:
        for path, text in new.items():
            written.append(path)
            write_text(path, text)
    except BaseException as error:
        for path in written:
            path.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise InputError(f"{written[-1]} cannot be written: {error.strerror or error}") from error
        raise
    return [folder / name for name in proposal.texts]


def _holds(path: Path, text: str) -> bool:
    """Whether a file is there with this text and no other."""
    return is_file(path) and path.stat().st_size == len(text.encode()) and path.read_text("utf-8") == text


def _refuse_existing(path: Path) -> None:
    if path.exists() or path.is_symlink():
        raise InputError(f"{path} is there already and is left as it is; take it away for a new proposal.")


def _conditions(trials: Sequence[Recording], file: SessionFile) -> list[str]:
    """The condition of each trial: its sub-folder's where there are several, else by how it moved."""
    if len({entry.condition for entry in file.trials}) > 1:
        return [trial.entry.condition for trial in trials]
    groups: list[Motion] = []
    names = []
    for trial in trials:
        motion = motion_of(trial.table, by_force=file.drive.channel == "force")
        same = next((each for each in groups if each.alike(motion)), None)
        if same is None:
            groups.append(motion)
        names.append((same or motion).name)
    return names


def _tool_lines(tools: set[tuple[tuple[str, str], ...]]) -> list[str]:
    if len(tools) == 1:
        return _from_headers({key: value for key, value in next(iter(tools)) if key != "contact"})
    return [] if tools else ['radius = "5 mm"  # SAY: no file tells it']


def _of_conditions(part: str, told: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """A table for each condition of whose tool or support files tell, where they tell of several."""
    tables = [[f"[conditions.{_text(name)}.{part}]", *_from_headers(keys)] for name, keys in told.items() if keys]
    return [line for table in tables for line in ("", *table)]


def _from_headers(told: Mapping[str, Any]) -> list[str]:
    return [f"{key} = {_text(str(value))}  # from the files' headers" for key, value in told.items()]


def _rig_lines(file: SessionFile) -> list[str]:
    """What holds the specimens, and what drives the tool where that is the force."""
    by_force = file.drive.channel == "force"
    driven = ["", "[drive]", 'channel = "force"  # SAY: depth where that was prescribed'] if by_force else []
    return [*_support_lines(file), *driven]


def _support_lines(file: SessionFile) -> list[str]:
    """What holds the specimens: as the files tell it, where they are cylinders between plates."""
    told = {name: keys.support for name, keys in file.conditions.items()}
    common = next(iter(told.values()), {})
    if common and all(keys == common for keys in told.values()):
        return ["", "[support]", *_from_headers(common)]
    said = 'kind = "bonded"  # SAY: bonded to a base, hole with hole_radius, half_space, or plates with specimen_radius'
    asked = [] if told and all(told.values()) else ["", "[support]", said]
    return [*asked, *_of_conditions("support", told)]


@dataclass(frozen=True)
class MarkerGrid:
    """What a table of markers tells of their grid: rows, columns, and the spacing at rest in m."""

    rows: int
    columns: int
    spacing: float


def marker_grid(table: MarkerTable) -> MarkerGrid | None:
    """The grid on which markers stand at rest, numbered row by row from 0; None where they stand on none."""
    numbers, first = np.unique(table.marker, return_index=True)
    if not np.array_equal(numbers, np.arange(numbers.size)):
        return None
    rest = np.column_stack([table.x[first], table.y[first]])
    for rows in (rows for rows in range(2, numbers.size // 2 + 1) if numbers.size % rows == 0):
        places = rest.reshape(rows, -1, 2)
        along, across = np.diff(places, axis=1).reshape(-1, 2), np.diff(places, axis=0).reshape(-1, 2)
        spacing = float(np.median(np.concatenate([along[:, 0], across[:, 1]])))
        off = [np.abs(along - [spacing, 0.0]).max(), np.abs(across - [0.0, spacing]).max()]
        if spacing > 0.0 and max(off) <= OFF_GRID * spacing:
            return MarkerGrid(rows, numbers.size // rows, spacing)
    return None


def _camera_lines(source: Source, names: Sequence[str]) -> tuple[list[str], tuple[str, ...]]:
    """The table [camera] where files of markers are named, and what of it a person must say.

    Rows, columns and spacing are proposed where all tables stand on one grid, else left to be filled in.
    """
    if not names:
        return [], ()
    grids = [marker_grid(read_markers(inside(source.folder, name, name))) for name in names]
    told = [each for each in grids if each is not None]
    file = f'file = "{CAMERA_FILE}"  # as it lies in this folder'
    own = [file] if is_file(source.folder / CAMERA_FILE) else []
    if len(told) == len(grids) and len({(each.rows, each.columns) for each in told}) == 1:
        spacings = [1e3 * each.spacing for each in told]
        if max(spacings) <= (1.0 + ALIKE) * min(spacings):
            spacing = float(np.median(spacings))
            tables = "1 table measures" if len(names) == 1 else f"{len(names)} tables measure"
            lines = [f"marker_rows = {told[0].rows}", f"marker_columns = {told[0].columns}"]
            said = f'marker_spacing = "{spacing:.3g} mm"  # SAY: as printed; {tables} {spacing:.4g} mm at rest'
            return ["", "[camera]", *lines, said, *own], ("camera.marker_spacing",)
    keys = ("marker_rows =", "marker_columns =", 'marker_spacing = "... mm"', *own)
    why = (
        "# SAY: the tables of markers tell no grid (numbered row by row from 0, x along the rows); fill in and "
        "uncomment, or the markers are left out"
    )
    return ["", why, "# [camera]", *(f"# {key}" for key in keys)], ("camera",)


def _to_say(tools: set[tuple[tuple[str, str], ...]], why: str) -> tuple[str, ...]:
    known = "median" in why
    asked = [] if tools else ["tool.radius"]
    return (*asked, "tool.contact", "support.kind", *([] if known else ["the specimen's thickness"]))


def _entry(trial: Recording, condition: str, height: float | None) -> list[str]:
    sheet = [f"sheet = {_text(trial.name)}"] if trial.name else []
    markers = [f"markers = {_text(trial.entry.markers)}"] if trial.entry.markers else []
    high = [] if height is None else [f'height = "{1e3 * height:.4g} mm"  # of its specimen, as the files tell']
    head = ["", "[[trials]]", f"file = {_text(trial.entry.file)}", f"condition = {_text(condition)}"]
    return [*head, *sheet, *markers, *high]


def _text(value: str) -> str:
    """A TOML string."""
    import tomli_w

    return tomli_w.dumps({"x": value}).partition("= ")[2].strip()
