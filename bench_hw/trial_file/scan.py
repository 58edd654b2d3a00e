"""A whole trial file looked through once: what is whole in it, what is damaged, what is missing; and its messages.

Only what is proved counts: messages from chunks whose CRC fits, metadata that carry their own checksum, a summary
whose CRC fits. Messages outside chunks have no checksum and are not taken. The first chunk defines the channels; where
it is damaged, the summary or the trial's metadata still know.
"""

from __future__ import annotations

import json
import mmap
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bench_hw.errors import TrialFileError
from bench_hw.storage.regular_file import RECORDING, open_regular
from bench_hw.trial_file.encoding import CHANNELS, ChannelInfo
from bench_hw.trial_file.mcap_records import (
    RawMessage,
    RecordExtent,
    Summary,
    UnreadableError,
    read_chunk,
    read_summary,
)
from bench_hw.trial_file.metadata import RECOVERY, TRIAL, read_header
from bench_hw.trial_file.records import TrialHeader
from bench_hw.trial_file.walk import Damage, Walk, walk_through


@dataclass(frozen=True, eq=False)
class Scan:
    """What a trial file holds.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    chunks : tuple of RecordExtent
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
    chunks: tuple[RecordExtent, ...]
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
        with open_regular(path, RECORDING) as file:
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


def known_channels(walk: Walk, summary: Summary | None) -> dict[int, ChannelInfo]:
    """Give the channels by their numbers.

    Parameters
    ----------
    walk : Walk
        What was met in the data.
    summary : Summary or None
        The summary, where it is whole.
    """
    from mcap.records import Channel, Schema

    records = () if summary is None else summary.records
    schemas = {record.id: record for record in records if isinstance(record, Schema)} | walk.schemas
    channels = {record.id: record for record in records if isinstance(record, Channel)} | walk.channels
    known = _from_metadata(walk.metadata.get(TRIAL, {}))
    return known | {number: _info(channel, schemas) for number, channel in channels.items()}


def _from_metadata(entries: Mapping[str, str]) -> dict[int, ChannelInfo]:
    ours = {info.topic: info for info in CHANNELS.values()}
    topics = json.loads(entries.get("channels", "{}"))
    return {int(number): ours[topic] for number, topic in topics.items() if topic in ours}


def _info(channel: Any, schemas: Mapping[int, Any]) -> ChannelInfo:
    schema = schemas.get(channel.schema_id)
    return ChannelInfo(
        topic=channel.topic,
        schema_name="" if schema is None else schema.name,
        schema_data=b"" if schema is None else schema.data,
        schema_encoding="" if schema is None else schema.encoding,
        message_encoding=channel.message_encoding,
        metadata=tuple(channel.metadata.items()),
    )


def read_messages(scan: Scan, topics: Collection[str] | None = None) -> Iterator[RawMessage]:
    """Give the messages of some topics (all if None) from the chunks that are whole, in the file's order.

    Raises
    ------
    TrialFileError
        The file cannot be read, or has changed since it was looked through.
    """
    wanted = {n for n, info in scan.channels.items() if topics is None or info.topic in topics}
    with opened(scan.path) as buffer:
        for frame in scan.chunks:
            try:
                contents = read_chunk(buffer, frame)
            except UnreadableError as error:
                raise TrialFileError(scan.path, "the file has changed while it was read") from error
            yield from (message for message in contents.messages if message.channel in wanted)


def trial_header(scan: Scan) -> TrialHeader | None:
    """Give what the file says about itself; None where no copy of it is whole.

    Raises
    ------
    TrialFileError
        It was written by another schema.
    """
    if scan.header is None:
        return None
    try:
        return read_header(scan.header)
    except (ValueError, KeyError, OverflowError) as error:
        raise TrialFileError(scan.path, f"the trial's metadata cannot be read ({error})") from error
