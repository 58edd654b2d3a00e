"""The messages of a trial file that has been looked through, one after the other."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from bench_hw.errors import TrialFileError
from bench_hw.trial_file.parsing import RawMessage, UnreadableError, read_chunk
from bench_hw.trial_file.scan import Scan, opened


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
