"""Where a value came from: a TOML file read with its line numbers, and what the command line replaced in it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic_core.core_schema import ValidationInfo

from bench_hw.storage.regular_file import read_regular
from benchmark.errors import InputError

KeyPath = tuple[str | int, ...]

_HEADER = re.compile(r"\s*(\[\[?)\s*([^\[\]]+?)\s*\]\]?\s*(?:#.*)?$")
_ASSIGNMENT = re.compile(
    r"""\s*((?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')(?:\s*\.\s*(?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*'))*)\s*="""
)
_PART = re.compile(r"""[A-Za-z0-9_-]+|"[^"]*"|'[^']*'""")
_TOKEN = re.compile(r"""\"{3}(?s:\\.|.)*?\"{3}|'{3}(?s:.*?)'{3}|"(?:\\.|[^"\\\n])*"|'[^'\n]*'|\#[^\n]*|[\[\]{}]|\n""")


def line_of(text: str, path: KeyPath) -> int | None:
    """The line of a key, or of the nearest table around it.

    Parameters
    ----------
    text : str
        A valid TOML document.
    path : tuple of str and int
        Keys and list indices from the root, such as ("layers", 1, "thickness").

    Returns
    -------
    int or None
        Counted from 1; None where not even a parent of the key has a line of its own.
    """
    best, line = 0, None
    for number, defined in _definitions(text):
        shared = min(len(defined), len(path))
        depth = shared if path[:shared] == defined[:shared] else 0
        if depth > best:
            best, line = depth, number
    return line


def _definitions(text: str) -> Iterator[tuple[int, KeyPath]]:
    """Line and full key path of every table header and every key that begins a line."""
    table: KeyPath = ()
    counts: dict[KeyPath, int] = {}
    for number, line in _open_lines(text):
        header, assignment = _HEADER.match(line), _ASSIGNMENT.match(line)
        if header:
            table = _table_path(_parts(header.group(2)), counts, many=header.group(1) == "[[")
            yield number, table
        elif assignment:
            yield number, table + _parts(assignment.group(1))


def _open_lines(text: str) -> Iterator[tuple[int, str]]:
    """The lines that begin outside any string, array or inline table, numbered from 1."""
    depth, number, start, first = 0, 1, 0, 1
    for token in _TOKEN.finditer(text + "\n"):
        found = token.group()
        if found == "\n":
            if start >= 0:
                yield first, text[start : token.start()]
            number += 1
            start, first = (token.end(), number) if depth == 0 else (-1, number)
        elif found in "[{":
            depth += 1
        elif found in "]}":
            depth -= 1
        else:
            number += found.count("\n")


def _parts(dotted: str) -> tuple[str, ...]:
    return tuple(part.strip("\"'") for part in _PART.findall(dotted))


def _table_path(parts: tuple[str, ...], counts: dict[KeyPath, int], *, many: bool) -> KeyPath:
    """The path of a header, with the index of each array of tables it goes through."""
    path: KeyPath = ()
    for position, part in enumerate(parts):
        path = (*path, part)
        if many and position == len(parts) - 1:
            counts[path] = counts.get(path, -1) + 1
        if path in counts:
            path = (*path, counts[path])
    return path


@dataclass(frozen=True)
class Source:
    """Where a table of values came from.

    Attributes
    ----------
    name : str
        What messages call it: the path as it was given.
    text : str
        The file's text; empty for a table that is no file.
    folder : Path
        What relative paths in it are relative to.
    overrides : mapping of key path to str
        Values that the command line replaced, by their path from the root of the file, with the key as typed.
    prefix : tuple of str
        Where in the file the table stands, when it is not the whole file.
    """

    name: str
    text: str = ""
    folder: Path = field(default_factory=Path)
    overrides: Mapping[KeyPath, str] = field(default_factory=dict)
    prefix: KeyPath = ()

    def place(self, path: KeyPath, shown: str) -> str:
        """Where a key stands, for a message: "--set KEY", or file, line and key.

        Parameters
        ----------
        path : tuple of str and int
            Keys and list indices from the root of the table.
        shown : str
            The same for a person.
        """
        whole = (*self.prefix, *path)
        for length in range(len(whole), 0, -1):
            if whole[:length] in self.overrides:
                inner = ".".join(str(part) for part in whole[length:])
                return f"--set {self.overrides[whole[:length]]}{f' ({inner})' if inner else ''}"
        line = line_of(self.text, whole)
        key = self.key(shown)
        within = [f"--set {typed}" for path, typed in self.overrides.items() if whole and path[: len(whole)] == whole]
        key += f" (with {', '.join(within)})" if within else ""
        return ", ".join(part for part in (self.name, f"line {line}" if line else "", key) if part)

    def key(self, shown: str) -> str:
        """A key of the table as a key of the whole file."""
        return ".".join([*(str(part) for part in self.prefix), *([shown] if shown else [])])

    def context(self) -> dict[str, Any]:
        """The validation context: values come from a person, files are looked for in this folder."""
        return {"from_file": True, "folder": self.folder}


def folder_of(info: ValidationInfo) -> Path:
    """The folder that relative paths belong to: the file's, or the current one for a model made in code."""
    return Path((info.context or {}).get("folder", "."))


def is_file(path: Path) -> bool:
    """Whether there is a regular file of that name; a name that no file can have is none."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def merge_conflict(text: str) -> str | None:
    """What says that a merge was left unsettled in a text, with the line; None where nothing does."""
    marks = (number for number, line in enumerate(text.splitlines(), start=1) if re.match(r"(<{7}|>{7})( |$)", line))
    first = next(marks, None)
    return None if first is None else f"line {first} has a conflict marker of git, so a merge was not settled"


def read_toml(path: Path, what: str) -> tuple[dict[str, Any], Source]:
    """Read a TOML file.

    Parameters
    ----------
    path : Path
        The file.
    what : str
        What it should be, for messages: "tissue", "scenario".

    Returns
    -------
    (dict, Source)
        Its table and where it came from.

    Raises
    ------
    InputError
        When there is no such file, or it is no TOML.
    """
    try:
        text = read_regular(path).decode("utf-8-sig")
        table = tomllib.loads(text)
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such {what} file.") from None
    except OSError as error:
        raise InputError(f"{path}: this {what} file cannot be read ({error.strerror or error}).") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: this {what} file is not UTF-8 text (byte {error.start}).") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: this {what} file is no valid TOML: {merge_conflict(text) or error}.") from None
    except (RecursionError, ValueError) as error:
        raise InputError(f"{path}: this {what} file cannot be read ({error}).") from None
    return table, Source(str(path), text, path.parent)
