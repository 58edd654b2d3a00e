"""Trial sessions from their folders: read whole, checked, and what is not known assumed and said."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from benchmark.errors import InputError
from benchmark.files.load import Load
from benchmark.files.loading import (
    TISSUE_KEYS,
    Overrides,
    layer_names,
    read_file,
    referred,
    refuse_other_place,
    tissue_from_table,
    tissue_keys,
)
from benchmark.files.overrides import layer_path, put_in, unknown_key
from benchmark.files.schema import FileModel, known_keys, validated
from benchmark.files.sessions.column_labels import check_labels
from benchmark.files.sessions.depth_counts import even_depths
from benchmark.files.sessions.description import Camera, SessionFile, assumed_edges, assumptions, base_setup, setups
from benchmark.files.sessions.doubts import check_markers, doubtful_forces, doubtful_markers, doubtful_times, with_drive
from benchmark.files.sessions.film_clock import doubtful_clocks, on_trials_clock
from benchmark.files.sessions.recordings import (
    Recording,
    check_tool_is_told,
    read_recordings,
    recorded_names,
    with_headers,
)
from benchmark.files.sessions.session_folder import fingerprint, inside, said_of_folder, session_table
from benchmark.files.sessions.specimens import SPECIMEN_THICKNESS, assumed_specimen, heights_under, told_heights
from benchmark.files.sessions.trials import (
    Session,
    Trial,
    is_synthetic,
    read_markers,
    trial_names,
    trial_paths,
)
from benchmark.files.shipped import find, shipped_tissues
from benchmark.files.sources import KeyPath, Source, is_file
from benchmark.files.tissue import Tissue
from benchmark.files.tool import Support, Tool, implausible

_NO_OVERRIDES: Overrides = {}

OF_SCENARIOS = ("physics", "comparison", "fem", "wave")
"""Sections that a session does not have, but the scenarios made of it do."""


def load_session(path: str | Path, overrides: Overrides = _NO_OVERRIDES, specimen: str | Path | None = None) -> Session:
    """Read a trial session.

    Parameters
    ----------
    path : str or Path
        A folder with a session.toml; a folder of trial files, which are one condition named after the folder, its
        sub-folders being conditions too; or one trial file.
    overrides : mapping of str to str, optional
        What `--set KEY=VALUE` replaces: keys of session.toml (`tool.radius`, `conditions.NAME.tool.radius`,
        `specimen`...), and the specimen's layers by their names (`dermis.youngs_modulus`). Keys of the sections in
        `OF_SCENARIOS` (`fem.mesh`) are checked and kept in `settings`.
    specimen : str or Path, optional
        A shipped tissue or a path relative to the current folder (`--specimen`).

    Returns
    -------
    Session
        All values in SI units; `warnings` says what was assumed.

    Raises
    ------
    InputError
        When any file of the session cannot be used: one bad trial refuses the whole session.
    """
    table, source = session_table(Path(path))
    settings = {key: value for key, value in overrides.items() if key.partition(".")[0] in OF_SCENARIOS}
    inner = {key: value for key, value in overrides.items() if key not in settings and key != "specimen"}
    paths = {key: route for key in inner if (route := _session_path(key, table))}
    changed, source = put_in(table, source, paths, inner)
    file = validated(SessionFile, changed, source)
    paths_of, marker_paths, film_paths = trial_paths(file.trials, source)
    _check_films(file, source, film_paths)
    read = read_recordings(file, paths_of, listed=bool(source.text) or is_file(Path(source.name)))
    file, told = with_headers(file, read.trials)
    file, driven = with_drive(file, [each.table for each in read.trials])
    check_tool_is_told(file, read.trials)
    trials, warnings = _trials(file, source, read.trials, paths_of, marker_paths)
    chosen = overrides.get("specimen", specimen)
    of_tissue = {key: value for key, value in inner.items() if key not in paths}
    tissue, assumed, tissue_file = _specimen(file, source, chosen, read.trials, of_tissue)
    heights, other = heights_under(file, read.trials, tissue, of_tissue, assumed=assumed is not None)
    trials = _completed(trials, read.trials, dict(zip(map(id, file.trials), film_paths, strict=True)), heights)
    base = base_setup(file, source)
    listed = [*paths_of, *(path for path in (*marker_paths, *film_paths) if path is not None)]
    beside = [*other, *said_of_folder(source, listed, tissue_file, inner)]
    session = Session(
        name=file.name,
        folder=source.folder,
        specimen=tissue,
        specimen_assumed=assumed is not None,
        tool=base.tool,
        support=base.support,
        drive=file.drive.channel,
        camera=file.camera,
        synthetic=file.synthetic or any(is_synthetic(trial.path) for trial in trials),
        trials=tuple(trials),
        warnings=(*told, *driven, *read.warnings, *warnings, *([assumed] if assumed else []), *beside),
        shown=read.shown,
        settings=settings,
        fingerprint=fingerprint(source.folder, [*_files(trials), *_other_files(file, source, tissue_file)]),
        fit=file.fit,
        assumed_edges=assumed_edges(file, setups(file, dict.fromkeys(each.condition for each in trials), source)),
    )
    return replace(session, warnings=(*session.warnings, *_checked_presses(session)))


def _check_films(file: SessionFile, source: Source, films: Sequence[Path | None]) -> None:
    """Refuse a film whose camera nobody gave."""
    if any(films) and (file.camera is None or file.camera.file is None):
        raise InputError(
            f"{source.place(('trials',), 'trials')}: a film is tracked with its camera; give [camera] with "
            'marker_rows, marker_columns, marker_spacing and file = "camera.toml", as bench_hw calibrate writes it.'
        )


def _completed(
    trials: Sequence[Trial],
    read: Sequence[Recording],
    films: Mapping[int, Path | None],
    heights: Sequence[float | None],
) -> list[Trial]:
    """The trials with their films and the heights of what they pressed."""
    return [
        replace(trial, film=films.get(id(each.entry)), height=height)
        for trial, each, height in zip(trials, read, heights, strict=True)
    ]


def _checked_presses(session: Session) -> list[str]:
    """What to ask of their sizes; tools, supports and settings that no scenario can have are refused."""
    said: list[str] = []
    for setup in session.setups:
        session.scenario(*setup, Load(peak=1.0))
        said += implausible(*setup)
    return list(dict.fromkeys(said))


def _session_path(key: str, table: dict[str, Any]) -> KeyPath | None:
    """Where a `--set` key points in session.toml; None where it is for the specimen."""
    head, _, rest = key.partition(".")
    if head in SECTIONS:
        refuse_other_place(key, [head], _section_keys())
    if head not in known_keys(SessionFile) or (head == "specimen" and rest):
        return None
    if head == "conditions":
        for name in sorted(_conditions(table), key=len, reverse=True):
            if rest.startswith(f"{name}."):
                return ("conditions", name, *rest[len(name) + 1 :].split("."))
    return tuple(key.split("."))


def _conditions(table: dict[str, Any]) -> list[str]:
    """The conditions of a session's table that nobody has checked yet."""
    trials = table.get("trials")
    entries = [entry for entry in trials if isinstance(entry, dict)] if isinstance(trials, list) else []
    return list(dict.fromkeys(str(entry.get("condition")) for entry in entries))


def _trials(
    file: SessionFile,
    source: Source,
    read: Sequence[Recording],
    files: Sequence[Path],
    marker_paths: Sequence[Path | None],
) -> tuple[list[Trial], list[str]]:
    """All trials with what they were made with, and what was assumed about them."""
    setup = setups(file, dict.fromkeys(each.entry.condition for each in read), source)
    by_entry = {id(entry): markers for entry, markers in zip(file.trials, marker_paths, strict=True)}
    paths = [Path(each.table.source) for each in read]
    warnings = assumptions(file, setup) + _doubled(read)
    if file.camera is None and any(marker_paths):
        warnings.append("marker files are listed but [camera] does not give their layout: they are left out")
        by_entry = {}
    named = dict(zip(map(id, file.trials), trial_names(files, source.folder), strict=True))
    names = recorded_names(read, [named[id(each.entry)] for each in read])
    warnings += _copied(read, names)
    check_labels(read, file.import_, setup)
    if file.drive.channel == "depth":
        warnings += doubtful_forces(names, [each.table for each in read])
    warnings += doubtful_times(names, [each.table for each in read])
    tables, counts = even_depths([each.table for each in read])
    trials = []
    for name, each, path, table in zip(names, read, paths, tables, strict=True):
        condition = setup[each.entry.condition]
        markers = by_entry.get(id(each.entry))
        found = None if markers is None else read_markers(markers)
        if found is not None and file.camera is not None:
            check_markers(table, found, file.camera)
            if file.camera.clock == "press":
                found, said = on_trials_clock(name, table, found)
                warnings.append(said)
        trials.append(Trial(name, each.entry.condition, path, condition.tool, condition.support, table, found, markers))
    return trials, [*warnings, *counts, *_doubts(trials, file.camera)]


def _doubts(trials: Sequence[Trial], camera: Camera | None) -> list[str]:
    """What to ask of the markers' places and times."""
    filmed = [(each.name, each.table, each.markers) for each in trials if each.markers is not None]
    if camera is None or not filmed:
        return []
    names, tables, markers = zip(*filmed, strict=True)
    late = doubtful_clocks(names, tables, markers) if camera.clock == "shared" else []
    return [*doubtful_markers(names, markers, camera), *late]


def _doubled(read: Sequence[Recording]) -> list[str]:
    """A warning where one file is listed as several trials, which are then no replicates."""
    times = Counter((Path(each.table.source).resolve(), each.name or each.entry.sheet) for each in read)
    doubled = [path.name for (path, _), count in times.items() if count > 1]
    return [f"listed as more than one trial: {', '.join(doubled)}; these are no replicates"] if doubled else []


def _copied(read: Sequence[Recording], names: Sequence[str]) -> list[str]:
    """A warning where trials of different files hold the same numbers, as copies of one record do."""
    alike: dict[bytes, dict[Path, str]] = {}
    for each, name in zip(read, names, strict=True):
        numbers = hashlib.sha256(each.table.depth.tobytes() + each.table.force.tobytes()).digest()
        alike.setdefault(numbers, {}).setdefault(Path(each.table.source).resolve(), name)
    copies = [", ".join(files.values()) for files in alike.values() if len(files) > 1]
    if not copies:
        return []
    return [f"the same numbers to the last digit: {'; '.join(copies)}; copies of one trial are no replicates"]


def _specimen(
    file: SessionFile,
    source: Source,
    chosen: str | Path | None,
    trials: Sequence[Recording],
    overrides: Overrides,
) -> tuple[Tissue, str | None, Path | None]:
    """The specimen, the warning where it is assumed, and its file where that is part of the session."""
    own, assumed = None, None
    if chosen is not None:
        table, where = read_file(find(chosen, "tissue"), "tissue")
    elif file.specimen is not None:
        path = referred(source, "specimen", file.specimen)
        if file.specimen not in shipped_tissues():
            path = own = inside(source.folder, file.specimen, source.place(("specimen",), "specimen"))
        table, where = read_file(path, "tissue")
    else:
        tissue, assumed = assumed_specimen([trial.table for trial in trials], *told_heights(file, trials))
        table, where = tissue.to_table(), Source("assumed specimen")
    for key in overrides:
        _check_key(key, table)
    made = tissue_from_table(table, where, overrides)
    if assumed and SPECIMEN_THICKNESS in overrides:
        assumed = assumed_specimen((), [made.thickness], f"--set {SPECIMEN_THICKNESS}")[1]
    return made, assumed, own


def _check_key(key: str, tissue: dict[str, Any]) -> None:
    """Refuse a key that is neither of a session nor of its specimen."""
    head = key.partition(".")[0]
    if head in (*TISSUE_KEYS, "tissue") or layer_path(key, layer_names(tissue)):
        return
    raise unknown_key(key, [*_section_keys(), *tissue_keys(tissue), *known_keys(SessionFile)])


SECTIONS: Final[Mapping[str, type[FileModel]]] = {"tool": Tool, "support": Support, "camera": Camera}


def _section_keys() -> list[str]:
    return [f"{name}.{inner}" for name, model in SECTIONS.items() for inner in known_keys(model)]


def _files(trials: Sequence[Trial]) -> list[Path]:
    return [path for trial in trials for path in (trial.path, trial.markers_path, trial.film) if path is not None]


def _other_files(file: SessionFile, source: Source, specimen: Path | None) -> list[Path]:
    """The files of a session besides its trials."""
    files = [] if specimen is None else [specimen]
    if source.text:
        files.append(Path(source.name))
    if file.camera is not None and file.camera.file is not None:
        files.append(inside(source.folder, file.camera.file, source.place(("camera", "file"), "camera.file")))
    return files
