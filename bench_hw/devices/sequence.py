"""What a stream's counters say: lost, late, repeated and restarted records.

With delta = (now - previous) mod 2^32: 0 is a duplicate, 1 is good, below 2^31 is a gap of delta - 1,
anything else is a record from before. Of those, one that fills a gap was late (reordered, no longer lost),
one already seen is a duplicate, and one further back than `WINDOW` means that the counter began anew.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bench_hw.devices.protocols import StreamHealth

MODULUS = 2**32
HALF = MODULUS // 2
WINDOW = 256
"""How late (in records) one may be and still be called late; further back is a restart."""


class SequenceTracker:
    """Follows `rdt_sequence` and `ft_sequence` of one stream."""

    def __init__(self) -> None:
        self._last: int | None = None
        self._base = 0
        self._last_ft = 0
        self._missing: dict[int, None] = {}
        self._counts = dict.fromkeys(StreamHealth.__dataclass_fields__, 0)

    @property
    def health(self) -> StreamHealth:
        """The counts so far."""
        return StreamHealth(**self._counts)

    def accept(self, rdt: NDArray[np.uint32], ft: NDArray[np.uint32]) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
        """Take the counters of records in order of arrival.

        Parameters
        ----------
        rdt, ft : ndarray (n,) of uint32
            The counters of the n records.

        Returns
        -------
        tuple of ndarray (n,) of bool and ndarray (n,) of int64
            Which records are new (the others are duplicates), and their unwrapped rdt_sequence.
        """
        if self._plain(rdt, ft):
            return self._accept_plain(rdt, ft)
        keep = np.ones(len(rdt), bool)
        unwrapped = np.empty(len(rdt), np.int64)
        for row, (sequence, sample) in enumerate(zip(rdt.tolist(), ft.tolist(), strict=True)):
            keep[row], unwrapped[row] = self._take(sequence, sample)
        return keep, unwrapped

    def _plain(self, rdt: NDArray[np.uint32], ft: NDArray[np.uint32]) -> bool:
        if self._last is None or not len(rdt) or self._last + len(rdt) >= MODULUS:
            return False
        expected = np.arange(self._last + 1, self._last + 1 + len(rdt))
        steps = np.remainder(np.diff(ft.astype(np.int64), prepend=self._last_ft), MODULUS)
        return bool(np.all((steps > 0) & (steps < HALF))) and bool(np.array_equal(rdt, expected))

    def _accept_plain(
        self, rdt: NDArray[np.uint32], ft: NDArray[np.uint32]
    ) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
        self._last, self._last_ft = int(rdt[-1]), int(ft[-1])
        self._counts["received"] += len(rdt)
        return np.ones(len(rdt), bool), self._base + rdt.astype(np.int64)

    def _take(self, sequence: int, sample: int) -> tuple[bool, int]:
        if self._last is None:
            return self._accept_one(sequence, sample)
        delta = (sequence - self._last) % MODULUS
        if delta == 0:
            return self._duplicate(self._base + sequence)
        if delta < HALF:
            return self._forward(sequence, sample, gap=delta - 1)
        return self._backward(sequence, sample, MODULUS - delta)

    def _accept_one(self, sequence: int, sample: int) -> tuple[bool, int]:
        self._counts["received"] += 1
        self._last, self._last_ft = sequence, sample
        return True, self._base + sequence

    def _duplicate(self, unwrapped: int) -> tuple[bool, int]:
        self._counts["duplicates"] += 1
        return False, unwrapped

    def _forward(self, sequence: int, sample: int, gap: int) -> tuple[bool, int]:
        if self._last is not None and sequence < self._last:
            self._base += MODULUS
        step = (sample - self._last_ft) % MODULUS
        self._counts["stalls"] += step == 0
        self._counts["restarts"] += step >= HALF
        self._note_gap(self._base + sequence, gap)
        return self._accept_one(sequence, sample)

    def _note_gap(self, at: int, gap: int) -> None:
        self._counts["lost"] += gap
        self._missing.update(dict.fromkeys(range(max(at - gap, at - WINDOW), at)))
        while len(self._missing) > 4 * WINDOW:
            del self._missing[next(iter(self._missing))]

    def _backward(self, sequence: int, sample: int, distance: int) -> tuple[bool, int]:
        unwrapped = self._base + (self._last or 0) - distance
        if distance > WINDOW or self._began_anew(sequence, sample):
            return self._restart(sequence, sample)
        if unwrapped not in self._missing:
            return self._duplicate(unwrapped)
        del self._missing[unwrapped]
        self._counts["lost"] -= 1
        self._counts["reordered"] += 1
        self._counts["received"] += 1
        return True, unwrapped

    def _began_anew(self, sequence: int, sample: int) -> bool:
        """Tell a counter that begins at 1 again soon after it began: its sample is newer than the last."""
        return sequence <= 1 and 0 < (sample - self._last_ft) % MODULUS < HALF

    def _restart(self, sequence: int, sample: int) -> tuple[bool, int]:
        self._counts["restarts"] += 1
        self._base += (self._last or 0) + 1 - sequence
        self._missing.clear()
        return self._accept_one(sequence, sample)
