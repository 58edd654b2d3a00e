"""What lies in a session's folder, and that nothing outside it is reached."""

from __future__ import annotations

import hashlib
import re
import shlex
from collections.abc import Container, Iterable, Sequence
from pathlib import Path
from typing import Any, Final

from bench_hw.instrument_files import ENDINGS, ending_of
from bench_hw.storage.folder_lock import in_use
from benchmark.errors import InputError
from benchmark.files.loading import read_file
from benchmark.files.schema import SCHEMA
from benchmark.files.shipped import session_folder, shipped_sessions
from benchmark.files.sources import Source, is_file

SESSION_FILE = "session.toml"
TRIAL_SUFFIXES = ENDINGS
"""Of the bench's own recordings, and of the files of other instruments."""
_ENDINGS = ", ".join(TRIAL_SUFFIXES)
RECORDING = ".mcap.part"
"""Of a recording that was not closed: it was cut off, or is still being made."""
NO_TRIALS = (".", "~$")
"""How names of hidden files begin, and of the locks that an office program lays beside what it has open."""
MARKERS = "_markers.csv"
"""In a folder without a session file, NAME_markers.csv holds the marker tracks of the trial NAME."""


def session_table(path: Path) -> tuple[dict[str, Any], Source]:
    """The table of a session: of its session.toml, or one made from the trial files in the folder.

    Parameters
    ----------
    path : Path
        A folder, a session.toml, one trial file, or the name of a session that ships.

    Returns
    -------
    (dict, Source)
        The table; the source's folder is the session's.

    Raises
    ------
    InputError
        When there is nothing to read.
    """
    path = session_folder(path)
    if is_file(path):
        if path.name == SESSION_FILE:
            return read_file(path, "session")
        if ending_of(path) not in TRIAL_SUFFIXES:
            raise InputError(
                f"{path}: this is no trial; allowed: a session's folder, its session.toml, {_ENDINGS}. Files of other "
                "kinds are read when their program exports them as csv or txt, with time, depth and force in columns."
            )
        if _of_trial(path):
            raise InputError(f"{path}: by its name this holds marker tracks; allowed: the trial, or its folder.")
        entry = {"file": path.name, "condition": path.stem}
        return _made(path.stem, [entry]), Source(str(path), "", path.parent)
    try:
        if not path.is_dir():
            missing = f"there is no such session folder or file{_shipped(path)}"
            other = "this is a pipe or a device; allowed: a session's folder or file"
            raise InputError(f"{path}: {other if path.exists() else missing}.")
        if (path / SESSION_FILE).exists():
            return read_file(path / SESSION_FILE, "session")
        if verb := result_of(path):
            allowed = "the folder of trials that it was made from, or another"
            raise InputError(f"{path}: this is a result of `{verb}`, not a session; allowed: {allowed}.")
        name = path.resolve().name or "session"
        return _made(name, _entries(path, name)), Source(str(path), "", path)
    except OSError as error:
        raise InputError(f"{path}: this session folder cannot be read ({error.strerror or error}).") from None


def _shipped(path: Path) -> str:
    """Which sessions ship, where a bare name was given."""
    return f", and the shipped ones are {', '.join(shipped_sessions())}" if len(path.parts) == 1 else ""


def inside(folder: Path, name: str, place: str) -> Path:
    """A file of a session by its name, which may not lead out of the folder, by links neither.

    Parameters
    ----------
    folder : Path
        The session's folder.
    name : str
        As the session names it, relative to the folder.
    place : str
        Where the name stands, for messages.

    Returns
    -------
    Path
        `folder / name`, an existing regular file.

    Raises
    ------
    InputError
        When the file lies outside the folder or is not there.
    """
    path = folder / name
    try:
        within = not Path(name).is_absolute() and path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError):  # a link that leads to itself
        within = False
    if not within:
        raise InputError(
            f"{place}: {name!r} is outside the session's folder {folder}; allowed: relative paths inside it."
        )
    if not is_file(path):
        raise InputError(f"{place}: there is no file {name!r} in the session's folder {folder}.")
    return path


def fingerprint(folder: Path, files: Iterable[Path]) -> str:
    """SHA-256 over the names and contents of a session's files, in hex; their order does not matter."""
    total = hashlib.sha256()
    for file in sorted(set(files)):
        total.update(f"{file.relative_to(folder).as_posix()} {digest(file)}\n".encode())
    return total.hexdigest()


def digest(file: Path) -> str:
    """SHA-256 of what a file holds, in hex."""
    with file.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def _made(name: str, trials: list[dict[str, str]]) -> dict[str, Any]:
    """The table of a session that has none; names of folders that are no printable text are made so."""
    named = [{**entry, "condition": _printable(entry["condition"])} for entry in trials]
    return {"schema": SCHEMA, "name": _printable(name), "trials": named}


def _printable(name: str) -> str:
    return "".join(letter if letter.isprintable() else "_" for letter in name)[:200].strip() or "session"


def _entries(folder: Path, name: str) -> list[dict[str, str]]:
    """The trials of a folder without a session file: its own, and those of each sub-folder as a condition."""
    found = [{**files, "condition": name} for files in _trial_files(folder)]
    for sub in sorted((each for each in folder.iterdir() if each.is_dir()), key=_natural):
        if not sub.name.startswith("."):
            named = ({key: f"{sub.name}/{file}" for key, file in files.items()} for files in _trial_files(sub))
            found += [{**files, "condition": sub.name} for files in named]
    if not found:
        cut = "".join(f" {said}" for said in _said_of_unclosed(folder, "")[:1])
        raise InputError(f"{folder}: there is neither a {SESSION_FILE} nor a trial ({_ENDINGS}) in this folder.{cut}")
    return found


def unclosed_recordings(source: Source) -> list[str]:
    """What is said of recordings beside a session's trials that were not closed; nothing where one trial was named."""
    given = Path(source.name)
    if given.name != SESSION_FILE and is_file(given):
        return []
    return _said_of_unclosed(source.folder, " and is left aside")


FILMS = (".avi", ".mkv", ".mp4", ".mov", ".webm", ".m4v", ".mpg", ".wmv")


def unused_films(source: Source, used: Sequence[Path]) -> list[str]:
    """What is said of films beside a session's trials, where none of them has a film, pictures or markers."""
    given, endings = Path(source.name), {path.suffix.lower() for path in used}
    if given.name != SESSION_FILE and is_file(given):
        return []
    if any(_of_trial(path) for path in used) or not endings.isdisjoint((*FILMS, ".mcap")):
        return []
    places = dict.fromkeys([source.folder, *(path.parent for path in used)])
    beside = [file for place in places for file in sorted(place.iterdir(), key=_natural)]
    found = [
        file.relative_to(source.folder).as_posix() for file in beside if file.suffix.lower() in FILMS and is_file(file)
    ]
    if not found:
        return []
    more = f" and {len(found) - 5} more" if len(found) > 5 else ""
    return [
        f"films that no trial names are left aside: {', '.join(found[:5])}{more}; markers in a film need "
        f'film = "{found[0]}" in the [[trials]] it belongs to, and a [camera] with the grid and the camera\'s file'
    ]


RESULTS: Final = {
    "fit.json": "fit",
    "discovery.json": "discover",
    "sweep.json": "sweep",
    "dossier.json": "dossier",
    "report.json": "report",
    "results.json": "run",
}
"""The verbs by the document that each writes into its result's folder."""


def result_of(folder: Path) -> str:
    """The verb whose result a folder is, with the manifest that all have; empty for any other."""
    from reports.manifest import read_manifest  # pages and their pictures, which reading a session does not need

    if read_manifest(folder) is None:
        return ""
    return next((verb for name, verb in RESULTS.items() if is_file(folder / name)), "")


def said_of_folder(source: Source, listed: Sequence[Path], specimen: Path | None, told: Container[str]) -> list[str]:
    """What stands beside a session's trials, or is left open in its files, and would pass without a word.

    Parameters
    ----------
    source : Source
        Of the session.
    listed : sequence of Path
        All files that it names: trials first of all, their markers and films.
    specimen : Path or None
        The specimen's file inside the folder, where that is used.
    told : container of str
        Keys that `--set` tells.
    """
    beside = (*unclosed_recordings(source), *_unlisted(source, listed), *unused_films(source, listed))
    return [*_unsaid(source, specimen, told), *beside]


def _unlisted(source: Source, listed: Sequence[Path]) -> list[str]:
    """A warning of files that look like trials, beside those that session.toml lists."""
    if not source.text:
        return []
    known, endings = {path.resolve() for path in listed}, {ending_of(path) for path in listed}
    places = dict.fromkeys([source.folder, *(path.parent for path in listed)])
    beside = [file for place in places for file in sorted(place.iterdir(), key=_natural) if file.resolve() not in known]
    found = [
        file.relative_to(source.folder).as_posix()
        for file in beside
        if ending_of(file) in endings and not file.name.startswith(NO_TRIALS) and not _of_trial(file) and is_file(file)
    ]
    if not found:
        return []
    more = f" and {len(found) - 5} more" if len(found) > 5 else ""
    return [
        f"not listed in {SESSION_FILE} and left aside: {', '.join(found[:5])}{more}; what belongs to the session needs "
        "a [[trials]] of its own there"
    ]


_PROPOSED = re.compile(r'^(?:(radius) = "5 mm"|(contact) = "rigid_bonded"|(kind) = "bonded")\s+# SAY', re.MULTILINE)
_KEYS = {"radius": "tool.radius", "contact": "tool.contact", "kind": "support.kind"}


def _unsaid(source: Source, specimen: Path | None, told: Container[str]) -> list[str]:
    """A warning of what `session new` assumed and nobody has said since."""
    found = [_KEYS[str(each.group(each.lastindex or 0))] for each in _PROPOSED.finditer(source.text)]
    unsaid = [key for key in dict.fromkeys(found) if key not in told]
    if specimen is not None and specimen.read_text("utf-8-sig").startswith("# SAY:"):
        unsaid.append(f"the specimen ({specimen.name})")
    if not unsaid:
        return []
    return [f"still assumed, as {SESSION_FILE} was proposed (marked SAY there): {', '.join(unsaid)}"]


def _said_of_unclosed(folder: Path, aside: str) -> list[str]:
    """A sentence for each recording in a folder and its conditions that was not closed."""
    places = [folder, *(each for each in folder.iterdir() if each.is_dir() and not each.name.startswith("."))]
    found = sorted(path for place in places for path in place.glob(f"*{RECORDING}"))
    return [f"{path.name} {_unclosed(path, aside)}" for path in found]


def _unclosed(path: Path, aside: str) -> str:
    if in_use(path.parent):
        return f"is still being recorded{aside}"
    return f"is a recording that was cut off{aside}; save what is whole in it: {recover_command(path)}"


def recover_command(path: Path) -> str:
    """What to type to save what is whole in a recording that was cut off."""
    return f"python -m bench_hw recover {shlex.quote(str(path))} --out NEW.mcap"


def _trial_files(folder: Path) -> list[dict[str, str]]:
    """The names of each trial's `file`, and of its `markers` where it has any."""
    files = (file for file in folder.iterdir() if ending_of(file) in TRIAL_SUFFIXES and not file.is_dir())
    shown = sorted((file for file in files if not file.name.startswith(NO_TRIALS)), key=_natural)
    markers = {_of_trial(file): file.name for file in shown if _of_trial(file)}
    trials = [file for file in shown if not _of_trial(file)]
    for stem in markers.keys() - {file.stem for file in trials}:
        raise InputError(
            f"{folder / markers[stem]}: marker tracks of a trial that is not there; allowed: beside {stem}.csv or "
            f"{stem}.mcap, or named in a {SESSION_FILE}."
        )
    tracks = ({"markers": markers[file.stem]} if file.stem in markers else {} for file in trials)
    return [{"file": file.name, **named} for file, named in zip(trials, tracks, strict=True)]


def _of_trial(file: Path) -> str:
    """The stem of the trial whose marker tracks a file holds by its name; empty for a trial."""
    return file.name[: -len(MARKERS)] if file.name.lower().endswith(MARKERS) else ""


def _natural(path: Path) -> list[tuple[int, int | str]]:
    """Sorting as people count: trial_2 before trial_10."""
    parts = re.split(r"(\d+)", path.name)
    return [(0, int(part)) if part.isdecimal() else (1, part) for part in parts]
