"""`--set KEY=VALUE`: where a dotted key points, and the table with the value put in."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from benchmark.errors import InputError
from benchmark.files.schema import nearest
from benchmark.files.sources import KeyPath, Source


def parsed_value(text: str) -> Any:
    """The value of an override: a TOML number, boolean, list or table where it reads as one, the text otherwise."""
    try:
        table = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):  # no TOML, or a number of too many digits
        return text
    value = table["value"]
    usable = isinstance(value, int | float | str | list | dict) and len(table) == 1
    return value if usable else text


def layer_path(key: str, layer_names: Iterable[str]) -> KeyPath | None:
    """The key path in a tissue of `LAYER.key`, the layer taken by its name; None where no layer is meant."""
    names = list(layer_names)
    for index in sorted(range(len(names)), key=lambda index: -len(names[index])):
        if key.startswith(f"{names[index]}."):
            return ("layers", index, *key[len(names[index]) + 1 :].split("."))
    return None


def replaced(table: Mapping[str, Any], path: KeyPath, value: Any, key: str) -> dict[str, Any]:
    """A copy of a table with one value put in; tables on the way are made where they are missing.

    Raises
    ------
    InputError
        When something on the way is no table.
    """
    result: dict[str, Any] = copy.deepcopy(dict(table))
    node: Any = result
    for part in path[:-1]:
        if isinstance(node, list) and isinstance(part, str):
            break
        node = node.setdefault(part, {}) if isinstance(node, dict) else node[part]
        if not isinstance(node, dict | list):
            raise InputError(f"--set {key}: {part!r} is a single value ({node!r}), so it has no keys to set.")
    if not isinstance(node, dict):
        raise InputError(f"--set {key}: this leads through a list; give the whole list.")
    node[path[-1]] = value
    return result


def unknown_key(key: str, known: Iterable[str]) -> InputError:
    """The error for a key that points nowhere, with the nearest ones."""
    return InputError(f"--set {key}: this key is not known; {nearest(key, known)}")


def put_in(
    table: Mapping[str, Any], source: Source, paths: Mapping[str, KeyPath], overrides: Mapping[str, str]
) -> tuple[dict[str, Any], Source]:
    """A table with overrides put in, and a source that knows which of its values they are.

    Parameters
    ----------
    table : mapping
        As TOML gives it.
    source : Source
        Where it came from.
    paths : mapping of str to key path
        Where each `--set` key points in the table.
    overrides : mapping of str to str
        The value of each key as typed.

    Raises
    ------
    InputError
        When a key leads through a value that is no table.
    """
    changed = dict(table)
    for key, path in paths.items():
        changed = replaced(changed, path, parsed_value(overrides[key]), key)
    return changed, replace(source, overrides={(*source.prefix, *path): key for key, path in paths.items()})
