"""The writer a capture uses: records in from any thread, an MCAP file out that survives a kill.

In the background mode the caller only appends to a queue; a thread encodes, compresses and writes. Without
it everything happens in the caller's thread, in the order of the calls.
"""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Self

from bench_hw.errors import TrialFileError, system_words
from bench_hw.trial_file.encoding import CHANNELS, Record, encode, nanoseconds
from bench_hw.trial_file.mcap_output import ChunkedWriter, NewFile, Syncer, sync_folder
from bench_hw.trial_file.metadata import TRIAL, header_entries
from bench_hw.trial_file.records import EventRecord, ForceRecord, FrameRecord, PositionRecord, TrialHeader, TrialWriter

SUFFIX = ".mcap"
PART = ".part"
_FLUSH_PERIOD = 0.2
_LAST_TIME = 1.8e10
DRAIN_PERIOD = 0.05
"""Time between two looks at the queue, s."""
LARGEST_BACKLOG = 256 * 1024 * 1024
"""Bytes that may wait before the disk is called too slow."""
_RECORD_BYTES = 400


def open_trial(path: Path | str, header: TrialHeader, background: bool = True) -> TrialWriter:
    """Begin a trial file.

    Parameters
    ----------
    path : path-like
        `DIR/NAME.mcap`; written as `NAME.mcap.part` until it is closed. The folder is made where it is
        missing.
    header : TrialHeader
        What is known before the first sample.
    background : bool
        True: a thread encodes and writes, and a kill loses at most what came in the last quarter of a
        second. False: everything in the caller's thread; a kill loses at most 0.2 s of recorded time.

    Returns
    -------
    TrialWriter
        To be closed; a context manager.

    Raises
    ------
    TrialFileError
        Another ending than `.mcap`, the trial or its `.part` exists, the folder cannot be written.
    """
    path = Path(path)
    part = part_of(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        file = NewFile(part)
        chunks = _begun(file, header)
    except OSError as error:
        problem = f"the file cannot be created ({error.strerror}); give a folder that can be written"
        raise TrialFileError(part, problem) from error
    return McapTrialWriter(path, file, chunks, background)


def part_of(path: Path) -> Path:
    """Give the name under which a new trial file is written until it is whole.

    Raises
    ------
    TrialFileError
        Another ending than `.mcap`, or the trial or its `.part` exists.
    """
    if path.suffix != SUFFIX:
        raise TrialFileError(path, f"a trial file is named NAME{SUFFIX}")
    part = path.with_name(path.name + PART)
    for existing in (path, part):
        if existing.exists():
            why = "" if existing == path else f"; no {path.name} is written beside this recording"
            raise TrialFileError(existing, f"the file exists and is not overwritten{why}; give another name")
    return part


def _begun(file: NewFile, header: TrialHeader) -> ChunkedWriter:
    """Write the head of the file; where even that fails, no file is left."""
    try:
        return ChunkedWriter(file, CHANNELS, {TRIAL: header_entries(header)})
    except OSError:
        file.close()
        file.path.unlink()
        raise


class McapTrialWriter:
    """A `TrialWriter` over MCAP; made by `open_trial`.

    Parameters
    ----------
    path : pathlib.Path
        The final name.
    file : NewFile
        The file under its temporary name.
    chunks : ChunkedWriter
        What puts messages into it.
    background : bool
        Whether a thread does the work.
    """

    def __init__(self, path: Path, file: NewFile, chunks: ChunkedWriter, background: bool) -> None:
        self._final = path
        self._file = file
        self._chunks = chunks
        self._error: Exception | None = None
        self._open = True
        self._sequence: Counter[int] = Counter()
        self._flushed = time.monotonic()
        self._lock = threading.Lock()
        self._syncer = Syncer(file)
        self._backlog = Backlog(self._write) if background else None

    @property
    def path(self) -> Path:
        """The file: `NAME.mcap.part` until it is closed well, then `NAME.mcap`."""
        return self._file.path if self._open or self._error else self._final

    def write_force(self, record: ForceRecord) -> None:
        """Take one force sample."""
        self._put(record)

    def write_position(self, record: PositionRecord) -> None:
        """Take one position."""
        self._put(record)

    def write_frame(self, record: FrameRecord) -> None:
        """Take one picture."""
        self._put(record)

    def write_event(self, record: EventRecord) -> None:
        """Take one event."""
        self._put(record)

    def close(self) -> Path:
        """Write the rest, sync, rename and return the final path; a second call does nothing more.

        Raises
        ------
        TrialFileError
            The disk refused, now or earlier; what was written is kept under `NAME.mcap.part`.
        """
        if self._open:
            self._open = False
            try:
                self._finish()
            finally:
                self._syncer.stop()
                self._file.close()
            self._rename()
        if self._error is not None:
            raise self._refusal(self._error)
        return self._final

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close the file; a failure to do so does not hide the error that led here."""
        try:
            self.close()
        except TrialFileError as failure:
            if error is None:
                raise
            error.add_note(str(failure))

    def _put(self, record: Record) -> None:
        if not self._open:
            raise TrialFileError(self.path, "the trial file is closed; nothing more can be written")
        if not 0.0 <= record.time <= _LAST_TIME:
            problem = f"a record has the time {record.time} s; allowed: 0 to {_LAST_TIME:g} s of the clock"
            raise TrialFileError(self.path, problem)
        with self._refusing():
            if self._backlog is not None:
                self._backlog.put(record)
                return
            with self._lock:
                self._write([record])

    def _write(self, batch: Sequence[Record]) -> None:
        for record in batch:
            channel, data = encode(record)
            self._chunks.add(channel, nanoseconds(record.time), data, self._sequence[channel])
            self._sequence[channel] += 1
        now = time.monotonic()
        if now - self._flushed >= _FLUSH_PERIOD:
            self._chunks.flush()
            self._flushed = now

    def _finish(self) -> None:
        if self._backlog is not None:
            self._backlog.stop()
        with self._refusing():
            self._chunks.finish()
            self._file.sync()

    def _rename(self) -> None:
        with self._refusing():
            if self._final.exists():
                raise FileExistsError(f"{self._final} has appeared meanwhile and is not overwritten")
            self._file.path.rename(self._final)
            sync_folder(self._final.parent)

    @contextmanager
    def _refusing(self) -> Iterator[None]:
        """Turn what goes wrong, here or earlier in the threads, into a refusal that lasts."""
        in_background = None if self._backlog is None else self._backlog.error
        self._error = self._error or in_background or self._syncer.error
        if self._error is not None:
            raise self._refusal(self._error)
        try:
            yield
        except Exception as error:
            self._error = error
            raise self._refusal(error) from error

    def _refusal(self, error: Exception) -> TrialFileError:
        said = system_words(error) if isinstance(error, OSError) else error
        problem = (
            f"the trial cannot be written ({said}); what was written until then is kept in this file, "
            "make room or give another folder, and use `recover` on it"
        )
        return TrialFileError(self._file.path, problem)


class Backlog:
    """Hands records to a consumer in batches, in order, from a thread of its own.

    Parameters
    ----------
    consume : callable
        Takes a batch (empty at times); called from one thread at a time. What it raises ends the thread, is
        kept in `error`, and nothing is taken any more.
    """

    def __init__(self, consume: Callable[[Sequence[Record]], None]) -> None:
        self.error: Exception | None = None
        self._consume = consume
        self._waiting: list[Record] = []
        self._bytes = 0
        self._lock = threading.Lock()
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, name="trial writer", daemon=True)
        self._thread.start()

    def put(self, record: Record) -> None:
        """Append a record; raises `OSError` when more waits than is reasonable."""
        size = len(record.data) if isinstance(record, FrameRecord) else _RECORD_BYTES
        with self._lock:
            if self._bytes > LARGEST_BACKLOG:
                raise OSError(f"the disk is too slow, {self._bytes} bytes wait to be written")
            self._waiting.append(record)
            self._bytes += size

    def stop(self) -> None:
        """Hand over what is left, end the thread and wait for it."""
        self._stopped.set()
        self._thread.join()

    def _run(self) -> None:
        try:
            while not self._stopped.wait(DRAIN_PERIOD):
                self._consume(self._take())
            self._consume(self._take())
        except Exception as error:
            self.error = error

    def _take(self) -> list[Record]:
        with self._lock:
            batch, self._waiting, self._bytes = self._waiting, [], 0
        return batch
