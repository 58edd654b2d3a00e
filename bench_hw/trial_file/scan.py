"""A whole trial file looked through once: what is whole in it, what is damaged, what is missing.

Only what is proved counts: messages from chunks whose CRC fits, metadata that carry their own checksum, a
summary whose CRC fits. Messages outside chunks have no checksum and are not taken.
"""

from __future__ import annotations

import mmap
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from bench_hw.errors import TrialFileError
from bench_hw.trial_file.definitions import known_channels
from bench_hw.trial_file.framing import Frame
from bench_hw.trial_file.metadata import RECOVERY, TRIAL
from bench_hw.trial_file.parsing import read_summary
from bench_hw.trial_file.schemas import ChannelInfo
from bench_hw.trial_file.walk import Damage, Walk, walk_through


@dataclass(frozen=True, eq=False)
class Scan:
    """What a trial file holds.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    chunks : tuple of Frame
        The chunks that are whole, in the file's order.
    channels : Mapping[int, ChannelInfo]
        By their numbers in this file.
    rows : Mapping[int, int]
        Messages found, by channel number.
    expected : Mapping[int, int] or None
        Messages the writer counted, from the summary; None where that is missing.
    header : Mapping[str, str] or None
        The trial's metadata entries, None where no copy is whole.
    recovery : Mapping[str, str] or None
        What an earlier recovery said was lost.
    damages : tuple of Damage
        Everything that is not as it should be, in the file's order.
    data_end : int or None
        The byte where the recording ends; None where that is missing.
    """

    path: Path
    chunks: tuple[Frame, ...]
    channels: Mapping[int, ChannelInfo]
    rows: Mapping[int, int]
    expected: Mapping[int, int] | None
    header: Mapping[str, str] | None
    recovery: Mapping[str, str] | None
    damages: tuple[Damage, ...]
    data_end: int | None

    @property
    def whole(self) -> bool:
        """Whether every message that was recorded is here."""
        readable = {number: count for number, count in self.rows.items() if number in self.channels}
        if self.expected is not None:
            return readable == dict(self.expected)
        return self.data_end is not None and readable == dict(self.rows) and not self._damages_in_data()

    @property
    def complete(self) -> bool:
        """Whether nothing is damaged or missing, in this file or in the one it was recovered from."""
        return self.whole and not self.damages and self.expected is not None and self.recovery is None

    @property
    def lost_bytes(self) -> int:
        """Bytes of the recording that could not be used; 0 if no message is lost."""
        return 0 if self.whole else sum(damage.end - damage.start for damage in self._damages_in_data())

    def losses(self) -> list[str]:
        """Say in a sentence each how many records of which channel are known to be lost."""
        sentences = []
        for number, count in (self.expected or {}).items():
            missing = count - self.rows.get(number, 0)
            name = self.channels[number].name if number in self.channels else f"channel {number}"
            sentences += [f"{missing} of {count} records of {name} are lost"] if missing else []
        for number in sorted(self.rows.keys() - self.channels.keys()):
            count = self.rows[number]
            sentences.append(f"{count} records of channel {number} cannot be read, its definition is lost")
        return sentences

    def _damages_in_data(self) -> list[Damage]:
        return [d for d in self.damages if self.data_end is None or d.start < self.data_end]


@contextmanager
def opened(path: Path) -> Iterator[mmap.mmap]:
    """Map a file into memory for reading.

    Raises
    ------
    TrialFileError
        No such file, no file at all, empty, not readable.
    """
    try:
        with path.open("rb") as file:
            if path.stat().st_size == 0:
                raise TrialFileError(path, "the file is empty; allowed: a trial recorded by this bench")
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as buffer:
                yield buffer
    except OSError as error:
        problem = f"the file cannot be read ({error.strerror}); allowed: a trial recorded by this bench"
        raise TrialFileError(path, problem) from error


def scan_trial(path: Path) -> Scan:
    """Look through a file.

    Raises
    ------
    TrialFileError
        The file cannot be read, or nothing in it is a trial.
    """
    with opened(path) as buffer:
        summary = read_summary(buffer)
        walk = walk_through(buffer, len(buffer) if summary is None else summary.start)
        size = len(buffer)
    if not walk.chunks and TRIAL not in walk.metadata:
        raise TrialFileError(path, "nothing in this file is a trial; allowed: a trial recorded by this bench")
    damages = walk.damages if summary is not None else [*walk.damages, _missing_end(walk, size)]
    return Scan(
        path=path,
        chunks=tuple(walk.chunks),
        channels=known_channels(walk, summary),
        rows=dict(walk.rows),
        expected=None if summary is None else summary.rows,
        header=walk.metadata.get(TRIAL),
        recovery=walk.metadata.get(RECOVERY),
        damages=tuple(damages),
        data_end=walk.data_end if summary is None else summary.start,
    )


def _missing_end(walk: Walk, size: int) -> Damage:
    if walk.data_end is None:
        reason = "the recording stops without its end, what came after is missing"
        return Damage(size, size, reason)
    return Damage(walk.data_end, size, "the summary at the end of the file is damaged or cut")
