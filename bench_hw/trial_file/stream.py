"""The file underneath: created once, written at once, synced to the disk five times a second.

Bytes go to the operating system as they are written, so that a killed process loses none of them; a thread
of its own syncs them to the disk, so that a slow disk does not hold up the recording.
"""

from __future__ import annotations

import os
import threading
from pathlib import Path

SYNC_PERIOD = 0.2
"""Time between syncs to the disk, s."""


class NewFile:
    """An unbuffered file that did not exist before.

    Parameters
    ----------
    path : pathlib.Path
        The file to create.

    Raises
    ------
    FileExistsError
        It exists.
    OSError
        It cannot be created.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
        self._position = 0
        self._synced = 0

    def write(self, data: bytes | memoryview) -> int:
        """Write all of it; raises `OSError` when the disk refuses, with part of it written perhaps."""
        rest = memoryview(data)
        while len(rest):
            written = os.write(self._handle, rest)
            self._position += written
            rest = rest[written:]
        return len(data)

    def tell(self) -> int:
        """Give the number of bytes written."""
        return self._position

    def flush(self) -> None:
        """Do nothing: nothing is held back."""

    def sync(self) -> None:
        """Bring what was written to the disk, if anything is new."""
        position = self._position
        if position != self._synced:
            os.fsync(self._handle)
            self._synced = position

    def close(self) -> None:
        """Close the file."""
        os.close(self._handle)


class Syncer:
    """A thread that syncs a file every `SYNC_PERIOD` until it is stopped.

    Parameters
    ----------
    file : NewFile
        The file.
    """

    def __init__(self, file: NewFile) -> None:
        self.error: OSError | None = None
        self._file = file
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"sync {file.path.name}", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while not self._stopped.wait(SYNC_PERIOD):
            try:
                self._file.sync()
            except OSError as error:
                self.error = error
                return

    def stop(self) -> None:
        """End the thread and wait for it."""
        self._stopped.set()
        self._thread.join()


def sync_folder(folder: Path) -> None:
    """Bring a folder's names to the disk, where the system knows how to."""
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
