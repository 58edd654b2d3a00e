"""Files in which unfinished work is kept: arrays under a fingerprint, written whole or not at all."""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from fem.errors import CheckpointError

FORMAT, OWNER = "format", "fingerprint"
DIGEST = 64
"""Letters of the hash that a file begins with, of all that follows."""


def write_kept(path: Path, form: str, fingerprint: str, arrays: Mapping[str, Any]) -> None:
    """Replace a file by arrays; raises CheckpointError if it cannot be written."""
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    content = io.BytesIO()
    named: dict[str, Any] = {FORMAT: form, OWNER: fingerprint, **arrays}
    np.savez(content, **named)
    try:
        with part.open("wb") as file:
            file.write(hashlib.sha256(content.getbuffer()).hexdigest().encode())
            file.write(content.getbuffer())
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise CheckpointError(f"checkpoint {path}: cannot be written ({error})") from error


def read_kept(path: Path, form: str, fingerprint: str) -> dict[str, np.ndarray] | None:
    """Arrays of a file; None if there is no such file.

    Raises
    ------
    CheckpointError
        If it is damaged, or belongs to something else.
    """
    if not path.exists():
        return None
    if not path.is_file():  # a pipe would be waited for, and a device has no end
        raise CheckpointError(f"checkpoint {path}: is no regular file", "remove it")
    try:
        content = memoryview(path.read_bytes())
    except OSError as error:
        raise CheckpointError(f"checkpoint {path}: cannot be read ({error})", "remove it") from error
    if hashlib.sha256(content[DIGEST:]).hexdigest().encode() != content[:DIGEST]:
        raise CheckpointError(f"checkpoint {path}: is damaged or no checkpoint", "remove it")
    with np.load(io.BytesIO(content[DIGEST:]), allow_pickle=False) as data:
        arrays = {name: data[name] for name in data.files}
    if str(arrays.pop(FORMAT)) != form or str(arrays.pop(OWNER)) != fingerprint:
        raise CheckpointError(
            f"checkpoint {path}: is of another problem, mesh or load history, or of another version of the solver",
            "give the file another name, or remove it to start anew",
        )
    return arrays


def fingerprint(words: object, arrays: Iterable[np.ndarray]) -> str:
    """Hash of words, of arrays, and of the solver's own code."""
    digest = hashlib.sha256(repr(words).encode())
    for array in arrays:
        digest.update(repr(array.shape).encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    digest.update(_code().encode())
    return digest.hexdigest()


@cache
def _code() -> str:
    """Hash of the solver's code."""
    digest = hashlib.sha256()
    folder = Path(__file__).parent
    for file in sorted(folder.rglob("*.py")):
        digest.update(file.relative_to(folder).as_posix().encode())
        digest.update(file.read_bytes())
    return digest.hexdigest()
