"""Files written whole or not at all; whole folders are in `reports.result_folder`.

What is written goes to a temporary name beside its target and is renamed at the end, so that a reader never
sees half a file and a failure leaves what was there before. What a file contains is not decided here.
"""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

StrPath = str | os.PathLike[str]


def write_bytes(path: StrPath, data: bytes) -> Path:
    """Write `data` to `path`, whole or not at all.

    Parameters
    ----------
    path
        File to write; missing parent folders are made, an existing file is replaced.
    data
        Its content.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    OSError
        Where the file system refuses; the target is then as it was.
    """
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = _sibling(target)
    try:
        with temporary.open("xb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    sync_folder(target.parent)
    return target


def write_text(path: StrPath, text: str) -> Path:
    """Write `text` as UTF-8 with its line ends as they are; see `write_bytes`.

    What is no text, as parts of the names of files may be, is written by its number, with a backslash.
    """
    return write_bytes(path, text.encode("utf-8", "backslashreplace"))


def write_json(path: StrPath, value: Any) -> Path:
    """Write `value` as indented JSON; see `write_bytes`.

    NumPy scalars and arrays become numbers and lists; NaN and infinities, which JSON lacks, become null.

    Raises
    ------
    TypeError
        For a value JSON has no form for, naming the place inside `value`.
    """
    return write_text(path, json.dumps(plain(value), indent=2, ensure_ascii=False, allow_nan=False) + "\n")


def plain(value: Any, where: str = "value") -> Any:
    """Return `value` in the types JSON knows: dict, list, str, int, float, bool and None.

    Parameters
    ----------
    value
        Mappings with text keys, sequences, NumPy arrays and scalars, paths, text, numbers and None, nested.
    where
        Name of `value` in the message of an error.

    Raises
    ------
    TypeError
        For anything else, naming the place.
    """
    if value is None or isinstance(value, str | bool | int):
        return value
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {_text_key(key, where): plain(item, f"{where}.{key}") for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item, f"{where}[{index}]") for index, item in enumerate(value)]
    if hasattr(value, "tolist"):
        return plain(value.tolist(), where)
    if isinstance(value, os.PathLike):
        return str(value)
    raise TypeError(f"{where} is a {type(value).__name__}, which has no JSON form")


def _sibling(target: Path) -> Path:
    """Return a free hidden name in the folder of `target`, and clear away what dead processes left of writing it."""
    remove_dead(target, "part")
    return target.with_name(f".{target.name}.{os.getpid():08x}.part")


def remove_dead(target: Path, ending: str) -> None:
    """Remove what processes that are gone left of writing `target`: `.NAME.NUMBER.ENDING`, their numbers in hex."""
    if os.name != "posix":
        return
    part = re.compile(re.escape(f".{target.name}.") + rf"([0-9a-f]{{8}})\.{ending}")
    for path in target.parent.iterdir():
        match = part.fullmatch(path.name)
        if match and path.is_file() and not path.is_symlink() and not _lives(int(match[1], 16)):
            path.unlink(missing_ok=True)


def _lives(process: int) -> bool:
    """Whether a process of this number is there, this one apart, which has nothing else to write."""
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return process != os.getpid()


def sync_folder(folder: Path) -> None:
    """Make a rename durable where the system lets a folder be synchronised; the file is in place without it."""
    if os.name != "posix":
        return
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _text_key(key: Any, where: str) -> str:
    """Return `key` where it is text; JSON objects have no other keys."""
    if not isinstance(key, str):
        raise TypeError(f"{where} has the key {key!r}, a {type(key).__name__}; JSON keys are text")
    return key
