"""An MCAP file being written: zstd chunks of 64 KiB, closed every 0.2 s of recorded time; synced five times a second.

Bytes go to the operating system as they are written, so that a killed process loses only the chunk in the making; a
thread syncs them to the disk, so that a slow disk does not hold up the recording. The metadata is repeated every five
seconds, so that no single damage takes it; with CRCs over chunks, data section and summary no flipped byte goes
unseen.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from bench_hw.trial_file.encoding import NANOSECONDS, ChannelInfo

SYNC_PERIOD = 0.2
"""Time between syncs to the disk, s."""
CHUNK_SIZE = 64 * 1024
CHUNK_SPAN = NANOSECONDS // 5
"""Longest recorded time in one chunk, ns."""
METADATA_SPAN = 5 * NANOSECONDS
"""Recorded time between repetitions of the metadata, ns."""
PROFILE = "tissuebench"


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


class ChunkedWriter:
    """Writes messages of known channels into a new MCAP file.

    Parameters
    ----------
    file : NewFile
        Where to.
    channels : Mapping[int, ChannelInfo]
        By the numbers `add` will be called with.
    metadata : Mapping[str, Mapping[str, str]]
        Entries by record name, sealed.

    Raises
    ------
    OSError
        The disk refuses; so in every method.
    """

    def __init__(
        self,
        file: NewFile,
        channels: Mapping[int, ChannelInfo],
        metadata: Mapping[str, Mapping[str, str]],
    ) -> None:
        self._writer = _started_writer(file)
        self._metadata = {name: dict(entries) for name, entries in metadata.items()}
        self._numbers = {number: self._register(info) for number, info in sorted(channels.items())}
        self._first: int | None = None
        self._described: int | None = None
        self._describe()

    def _register(self, info: ChannelInfo) -> int:
        schema = self._writer.register_schema(info.schema_name, info.schema_encoding, info.schema_data)
        metadata = dict(info.metadata)
        number: int = self._writer.register_channel(info.topic, info.message_encoding, schema, metadata)
        return number

    def _describe(self) -> None:
        for name, entries in self._metadata.items():
            self._writer.add_metadata(name, entries)

    def add(self, channel: int, time: int, data: bytes, sequence: int, publish_time: int | None = None) -> None:
        """Add one message.

        Parameters
        ----------
        channel : int
            A number of the channels given.
        time : int
            Log time, ns.
        data : bytes
            The message.
        sequence : int
            Its number in its channel, from 0, modulo 2^32.
        publish_time : int, optional
            ns; the log time if not given.
        """
        if self._first is not None and time - self._first >= CHUNK_SPAN:
            self.flush()
            self._repeat_metadata(time)
        self._first = time if self._first is None else self._first
        published = time if publish_time is None else publish_time
        self._writer.add_message(self._numbers[channel], time, data, published, sequence % 2**32)

    def _repeat_metadata(self, time: int) -> None:
        if self._described is None:
            self._described = time
        if time - self._described >= METADATA_SPAN:
            self._describe()
            self._described = time

    def flush(self) -> None:
        """Close the chunk in the making and write it."""
        self._writer.flush()
        self._first = None

    def finish(self) -> None:
        """Write the rest, the metadata once more, and the end of the file."""
        self.flush()
        self._describe()
        self._writer.finish()


def _started_writer(file: Any) -> Any:
    """Begin an MCAP file; untyped as the library is. It is loaded here, so that the command line starts fast."""
    from mcap.writer import CompressionType, Writer

    writer = Writer(file, chunk_size=CHUNK_SIZE, compression=CompressionType.ZSTD, enable_data_crcs=True)
    writer.start(profile=PROFILE)
    return writer
