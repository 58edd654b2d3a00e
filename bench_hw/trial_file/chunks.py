"""Messages into an MCAP file: zstd chunks of 64 KiB that are closed at least every 0.2 s of recorded time.

A chunk in the making is what a killed process loses. The metadata is repeated every five seconds, so that no
single damage takes it; with CRCs over chunks, data section and summary no flipped byte goes unseen.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from bench_hw.trial_file.encoding import NANOSECONDS
from bench_hw.trial_file.schemas import ChannelInfo
from bench_hw.trial_file.stream import NewFile

CHUNK_SIZE = 64 * 1024
CHUNK_SPAN = NANOSECONDS // 5
"""Longest recorded time in one chunk, ns."""
METADATA_SPAN = 5 * NANOSECONDS
"""Recorded time between repetitions of the metadata, ns."""
PROFILE = "tissuebench"


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
