"""Tracked films kept by what they were made from, so that the next command need not track them again.

An entry is a ZIP file named by a hash of the film, the camera file, the layout and the program that tracks; whatever of
these changes, the film is tracked anew. It begins with a hash of all that follows: a damaged entry is none, and the one
that is then kept takes its place. The folder is the user's cache folder, or `TISSUEBENCH_CACHE`; an empty
`TISSUEBENCH_CACHE` keeps nothing. Where nothing can be kept, nothing is.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import stat
import zipfile
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

from bench_hw.storage.regular_file import RECORDING, open_regular, read_sealed, sealed
from reports import write_bytes

VARIABLE = "TISSUEBENCH_CACHE"
MOST_BYTES = 500_000_000
"""Of all entries together; the oldest go first."""
TABLE, STILL, ABOUT = "markers.csv", "still.png", "about.json"
PIECE = 1 << 20


@dataclass(frozen=True)
class KeptFilm:
    """What tracking a film gave: its table and still, frames, share of markers missed, and what to say of it."""

    table: bytes
    still: bytes | None
    frames: int
    missing_percent: float
    warnings: tuple[str, ...]


def cache_folder() -> Path | None:
    """Where films are kept; None for nowhere."""
    stated = os.environ.get(VARIABLE)
    if stated is not None:
        return Path(stated) / "films" if stated else None
    from platformdirs import user_cache_path

    return user_cache_path("tissuebench") / "films"


def film_key(film: Path, camera: Path, layout: tuple[int, int]) -> str:
    """The name of a film's entry, 64 hexadecimal digits; "" where nothing is kept, or a file cannot be read."""
    if cache_folder() is None:
        return ""
    try:
        parts = (str(layout), _program(), _digest((film,)), _digest((camera,)))
    except OSError:
        return ""
    return hashlib.sha256(" ".join(parts).encode()).hexdigest()


def kept_film(key: str) -> KeptFilm | None:
    """What is kept under a key; None where nothing is, or it is not as it was written."""
    folder = cache_folder()
    if folder is None or not key:
        return None
    path = folder / f"{key}.zip"
    content = read_sealed(path, MOST_BYTES)
    if content is None:
        return None
    unlike = (OSError, ValueError, KeyError, TypeError, zipfile.BadZipFile)  # whole, but written otherwise
    with suppress(*unlike), zipfile.ZipFile(io.BytesIO(content)) as archive:
        about = json.loads(archive.read(ABOUT))
        still = archive.read(STILL) if STILL in archive.namelist() else None
        found = KeptFilm(
            archive.read(TABLE), still, int(about["frames"]), float(about["missing_percent"]), tuple(about["warnings"])
        )
        os.utime(path)
        return found
    return None


def keep_film(key: str, film: KeptFilm) -> None:
    """Keep a film's tracks, and let the oldest entries go where all together are too many."""
    folder = cache_folder()
    if folder is None or not key:
        return
    about = {"frames": film.frames, "missing_percent": film.missing_percent, "warnings": list(film.warnings)}
    parts = {TABLE: film.table, ABOUT: json.dumps(about).encode()}
    parts |= {} if film.still is None else {STILL: film.still}
    with suppress(OSError):
        name = f"{key}.zip"
        write_bytes(folder / name, sealed(name, _zipped(parts)))
        _make_room(folder)


def _zipped(parts: Mapping[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return buffer.getvalue()


def _make_room(folder: Path) -> None:
    """Remove the entries that were not used for longest, until the others fit; what is no regular file stays."""
    found = ((path.lstat(), path) for path in folder.glob("*.zip"))
    entries = sorted((each for each in found if stat.S_ISREG(each[0].st_mode)), key=lambda each: each[0].st_mtime)
    total = sum(entry.st_size for entry, _ in entries)
    for entry, path in entries:
        if total <= MOST_BYTES:
            return
        path.unlink(missing_ok=True)
        total -= entry.st_size


@cache
def _program() -> str:
    """What tracks: OpenCV's version, and the code of the camera's part of the bench."""
    place = find_spec("bench_hw.vision")
    assert place is not None, "the package is installed with this one"
    sources = (path for root in place.submodule_search_locations or () for path in Path(root).rglob("*.py"))
    return f"{version('opencv-python-headless')} {_digest(sorted(sources))}"


def _digest(paths: Iterable[Path]) -> str:
    total = hashlib.sha256()
    for path in paths:
        with open_regular(path, RECORDING) as stream:
            while piece := stream.read(PIECE):
                total.update(piece)
    return total.hexdigest()
