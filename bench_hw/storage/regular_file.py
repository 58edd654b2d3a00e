"""Reading files that a person names: regular ones, and no larger than their kind can be.

A device or a pipe has no end, or no beginning until somebody writes to it; reading one would fill the memory or wait
for ever. What is in a file is not decided here. Files that we keep for ourselves begin with a hash of their name and of
what follows, so that a damaged one, or one under another's name, is none.
"""

from __future__ import annotations

import errno
import hashlib
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Final

TEXT: Final = 16_000_000
"""Bytes of the largest file that a person writes: TOML, Python."""
DOCUMENT: Final = 256_000_000
"""Bytes of the largest JSON document or picture."""
TABLE: Final = 2_000_000_000
"""Bytes of the largest table or surface."""
RECORDING: Final = 1_000_000_000_000
"""Bytes of the largest recording, which is never read as a whole."""

SEAL: Final = 64
"""Letters of the hash that a kept file begins with."""

_KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
    (stat.S_ISSOCK, "a socket"),
)


class NotRegularError(OSError):
    """What is read is no regular file, or a larger one than its kind can be."""


@contextmanager
def open_regular(path: Path, most: int) -> Iterator[BinaryIO]:
    """Open a regular file of at most `most` bytes for reading; a pipe that nobody writes to is not waited for.

    Raises
    ------
    NotRegularError
        It is a device, a pipe, a folder or a socket, or it is larger; `strerror` says which.
    OSError
        It is not there or cannot be read.
    """
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    try:
        found = os.fstat(handle)
        if not stat.S_ISREG(found.st_mode):
            kind = next((name for is_kind, name in _KINDS if is_kind(found.st_mode)), "something else")
            raise NotRegularError(errno.EINVAL, f"it is {kind}; allowed is a regular file", str(path))
        if found.st_size > most:
            raise _too_large(path, found.st_size, most)
    except BaseException:
        os.close(handle)
        raise
    with os.fdopen(handle, "rb") as stream:
        yield stream


def read_regular(path: Path, most: int = TEXT) -> bytes:
    """Read a regular file of at most `most` bytes; raises as `open_regular`."""
    with open_regular(path, most) as stream:
        data = stream.read(most + 1)
    if len(data) > most:  # it grew, or is one whose size the system does not tell
        raise _too_large(path, len(data), most)
    return data


def sealed(name: str, content: bytes) -> bytes:
    """`content` as it is kept in a file called `name`, which `read_sealed` takes."""
    return hashlib.sha256(name.encode() + b"\0" + content).hexdigest().encode() + content


def read_sealed(path: Path, most: int) -> bytes | None:
    """What was `sealed` in a file of at most `most` bytes; None where it is not there, not whole or not regular."""
    try:
        whole = read_regular(path, most)
    except OSError:
        return None
    content = whole[SEAL:]
    return content if whole == sealed(path.name, content) else None


def _too_large(path: Path, size: int, most: int) -> NotRegularError:
    return NotRegularError(errno.EFBIG, f"it has {size / 1e6:,.0f} MB; allowed are {most / 1e6:,.0f} MB", str(path))
