"""What ships with the product: tissues and scenarios, found by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from benchmark.errors import InputError
from benchmark.files.problems import nearest
from benchmark.files.sources import is_file

_SHIPPED = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class Entry:
    """One shipped file.

    Attributes
    ----------
    name : str
        What a scenario or the command line calls it.
    path : Path
        The file.
    """

    name: str
    path: Path


def shipped_tissues() -> Mapping[str, Entry]:
    """The shipped tissues by name, in alphabetical order."""
    return _entries("tissues")


def shipped_scenarios() -> Mapping[str, Entry]:
    """The shipped scenarios by name, in alphabetical order."""
    return _entries("scenarios")


def find(name_or_path: str | Path, what: str, base: Path | None = None) -> Path:
    """The file that a name or a path means.

    Parameters
    ----------
    name_or_path : str or Path
        A shipped name, or a path: anything that ends in .toml or has a separator in it.
    what : str
        "tissue" or "scenario".
    base : Path, optional
        The folder that a relative path belongs to; the current one by default.

    Returns
    -------
    Path
        A path that was asked for as one need not exist.

    Raises
    ------
    InputError
        When nothing of that name ships; it lists the nearest names.
    """
    text = str(name_or_path)
    path = (base or Path()) / text
    if isinstance(name_or_path, Path) or text.endswith(".toml") or "/" in text or "\\" in text:
        return path
    entries = _entries(f"{what}s")
    if text in entries:
        return entries[text].path
    if text and is_file(path):
        return path
    raise InputError(
        f"no {what} {text!r} ships with tissuebench and there is no file of that name; {nearest(text, entries)} "
        f"A path to a file of your own ends in .toml."
    )


def _entries(kind: str) -> dict[str, Entry]:
    files = sorted((_SHIPPED / kind).glob("*.toml"))
    return {file.stem: Entry(file.stem, file) for file in files}
