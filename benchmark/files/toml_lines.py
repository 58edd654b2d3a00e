"""On which line of a TOML text a key stands; `tomllib` does not say."""

from __future__ import annotations

import re
from collections.abc import Iterator

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
