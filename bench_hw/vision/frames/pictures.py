"""A folder or a pattern of picture files as if they were a video."""

from __future__ import annotations

import glob
import re
from collections.abc import Iterator
from pathlib import Path

from bench_hw.errors import InputError
from bench_hw.vision.frames.decoding import decode_grey
from bench_hw.vision.frames.model import Frame

KINDS = {
    ".png": "png",
    ".jpg": "jpeg",
    ".jpeg": "jpeg",
    ".tif": "tiff",
    ".tiff": "tiff",
    ".bmp": "bmp",
    ".pgm": "pgm",
    ".webp": "webp",
}
USUAL_RATE = 30.0
"""Pictures per second where nobody said, Hz: the paper's webcam."""
_NUMBERED = re.compile(r"%0?\d*d")


class PictureFrames:
    """Pictures in the natural order of their names.

    Parameters
    ----------
    place : str
        A folder, one picture, a pattern with `*` or `?`, or a numbered one (`frame_%04d.png`).
    rate : float, optional
        Pictures per second, Hz; 30 without it, which is then noted.

    Raises
    ------
    InputError
        There is no picture.
    """

    def __init__(self, place: str, rate: float | None = None) -> None:
        self._place = place
        self._rate = rate or USUAL_RATE
        self._assumed = rate is None
        self._files = sorted(_files(place), key=_natural)
        if not self._files:
            raise InputError(f"{place}: no pictures; allowed endings: {', '.join(KINDS)}")

    @property
    def name(self) -> str:
        """The folder or pattern."""
        return self._place

    @property
    def synthetic(self) -> bool:
        """Nobody knows of bare pictures."""
        return False

    @property
    def expected(self) -> int | None:
        """How many there are."""
        return len(self._files)

    @property
    def rate(self) -> float | None:
        """Pictures per second, Hz."""
        return self._rate

    def frames(self) -> Iterator[Frame]:
        """Give the pictures, number / rate as time."""
        for number, file in enumerate(self._files):
            yield Frame(number, number / self._rate, decode_grey(file.read_bytes(), KINDS[file.suffix.lower()]))

    def notes(self) -> tuple[str, ...]:
        """Say what was assumed."""
        return (f"{self._rate:g} pictures a second are assumed; `--fps` says otherwise",) if self._assumed else ()


def is_pictures(place: str) -> bool:
    """Say whether a place is a folder, a pattern or a single picture."""
    path = Path(place)
    return path.is_dir() or _is_pattern(place) or path.suffix.lower() in KINDS


def _is_pattern(place: str) -> bool:
    return not Path(place).exists() and (any(sign in place for sign in "*?[") or bool(_NUMBERED.search(place)))


def _files(place: str) -> list[Path]:
    path = Path(place)
    if path.is_dir():
        found = list(path.iterdir())
    elif _is_pattern(place):
        found = [Path(name) for name in glob.glob(_NUMBERED.sub("[0-9]*", place))]  # noqa: PTH207 - any folder
    else:
        found = [path]
    return [file for file in found if file.is_file() and file.suffix.lower() in KINDS]


def _natural(path: Path) -> list[tuple[int, int, str]]:
    """Order by the numbers in a name as numbers: 2 before 10."""
    parts = re.split(r"(\d+)", path.name)
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in parts]
