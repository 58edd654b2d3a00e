"""A queue with a thread behind it, so that a measuring loop never waits for a disk."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence

from bench_hw.trial_file.encoding import Record
from bench_hw.trial_file.records import FrameRecord

DRAIN_PERIOD = 0.05
"""Time between two looks at the queue, s."""
LARGEST_BACKLOG = 256 * 1024 * 1024
"""Bytes that may wait before the disk is called too slow."""
_RECORD_BYTES = 400


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
