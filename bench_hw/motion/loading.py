"""Finding and reading protocols of motion: a path, or the name of a shipped one."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from bench_hw.configuration import read_toml, validated
from bench_hw.errors import InputError

if TYPE_CHECKING:
    from bench_hw.motion.protocol import Protocol


@dataclass(frozen=True, slots=True)
class LoadedProtocol:
    """A protocol, the text of its file and where that was."""

    protocol: Protocol
    text: str
    path: Path


def shipped() -> dict[str, Path]:
    """Give the shipped protocols: name to path."""
    folder = Path(str(files("bench_hw.motion") / "library"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_protocol(name_or_path: str | Path) -> LoadedProtocol:
    """Read a protocol of motion.

    Raises
    ------
    InputError
        No such file or shipped name, or the file says something that is not allowed.
    """
    from bench_hw.motion.protocol import Protocol

    path = _find(str(name_or_path))
    tables, text = read_toml(path)
    return LoadedProtocol(validated(Protocol, tables, str(path)), text, path)


def _find(name: str) -> Path:
    known = shipped()
    if name in known and not Path(name).is_file():
        return known[name]
    path = Path(name)
    if not path.is_file():
        raise InputError(f"protocol {name!r}: no such file; shipped are {', '.join(known)}")
    return path
