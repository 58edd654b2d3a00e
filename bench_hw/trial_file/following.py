"""A trial followed while it is recorded: what has reached the file since the last look, for people who watch.

Only the file is read, from another process if need be: the recording knows nothing of it and never waits for it. What
is not yet whole is left for the next look, what is damaged is passed over, and pictures but the newest are not decoded.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

from bench_hw.errors import TrialFileError
from bench_hw.trial_file.encoding import (
    CAMERA,
    DEPTH,
    EVENTS,
    FORCE,
    NANOSECONDS,
    decode_depth,
    decode_event,
    decode_force,
    decode_frame,
    nanoseconds,
)
from bench_hw.trial_file.mcap_records import (
    CHUNK,
    MAGIC,
    METADATA,
    RawMessage,
    UnreadableError,
    frame_at,
    next_frame,
    parse_record,
    read_chunk,
)
from bench_hw.trial_file.metadata import TRIAL, is_sealed, read_header
from bench_hw.trial_file.records import EventRecord, ForceRecord, FrameRecord, PositionRecord, TrialHeader
from bench_hw.trial_file.writer import PART, SUFFIX

LARGEST_LOOK = 32 * 1024 * 1024
"""Bytes read at one look; of a trial that is further ahead what lies between is passed over."""
_HEAD = 1024 * 1024


@dataclass(frozen=True)
class TrialNews:
    """What has come since the last look; times in s since the trial's start.

    Parameters
    ----------
    name : str
        Of the trial's file.
    header : TrialHeader or None
        None until it has been read.
    force : tuple of ForceRecord
        In the sensor's axes.
    depth : tuple of PositionRecord
        Positions.
    frames : tuple of FrameRecord
        Pictures.
    events : tuple of EventRecord
        What happened.
    ended : bool
        Whether the file has its final name: the next look gives the next trial.
    """

    name: str
    header: TrialHeader | None
    force: tuple[ForceRecord, ...] = ()
    depth: tuple[PositionRecord, ...] = ()
    frames: tuple[FrameRecord, ...] = ()
    events: tuple[EventRecord, ...] = ()
    ended: bool = False

    def press(self) -> list[float]:
        """Press force of each sample, N, positive when pressing."""
        if self.header is None:
            return []
        axis, sign = "xyz".index(self.header.press_axis[1]), -1.0 if self.header.press_axis[0] == "-" else 1.0
        return [sign * record.force[axis] for record in self.force]


class TrialFollower:
    """Follows the trial that is being recorded.

    Parameters
    ----------
    place : pathlib.Path
        A session's folder, whose newest unfinished trial is followed, one after the other, also one that a capture is
        still to make; or one trial, `NAME.mcap` or `NAME.mcap.part`.

    Raises
    ------
    TrialFileError
        There is no such folder and none to make it in, or the file is no trial's.
    """

    def __init__(self, place: Path) -> None:
        self.place = place
        named = place.name.removesuffix(PART)
        to_come = place.parent.is_dir() and (named.endswith(SUFFIX) or not (place.exists() or place.suffix))
        if not place.is_dir() and not to_come:
            allowed = "a session's folder, also one that capture is to make in a folder there is, or its NAME.mcap.part"
            raise TrialFileError(place, f"no such folder and no trial; allowed: {allowed}")
        self._file: BinaryIO | None = None
        self._path = place
        self._done: set[int] = set()
        self._header: TrialHeader | None = None
        self._topics: Mapping[int, str] = {}
        self._at = 0

    def look(self) -> TrialNews | None:
        """Give what is new; None while no trial is recorded.

        Raises
        ------
        TrialFileError
            The file cannot be read.
        """
        if self._file is None and not self._open():
            return None
        assert self._file is not None
        ended = not self._path.exists()  # asked before reading: what came until then is read below
        try:
            messages = self._messages(self._file)
        except OSError as error:
            raise TrialFileError(self._path, f"it cannot be read ({error.strerror})") from error
        news = self._news(messages, ended)
        if ended and not messages:
            self.close()
        return news

    def close(self) -> None:
        """Let go of the file; may be repeated."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _open(self) -> bool:
        found = self._unfinished()
        if found is None:
            return False
        try:
            file = found.open("rb")
        except FileNotFoundError:
            return False
        number = os.fstat(file.fileno()).st_ino
        if number in self._done:
            file.close()
            return False
        self._done.add(number)
        self._file, self._path, self._at, self._header, self._topics = file, found, len(MAGIC), None, {}
        return True

    def _unfinished(self) -> Path | None:
        if not self.place.is_dir():
            part = self.place if self.place.name.endswith(PART) else self.place.with_name(self.place.name + PART)
            return part if part.name.endswith(SUFFIX + PART) and part.is_file() else None
        parts = [path for path in self.place.glob("*" + SUFFIX + PART) if path.is_file()]
        return max(parts, key=lambda path: path.name, default=None)

    def _messages(self, file: BinaryIO) -> list[RawMessage]:
        """The messages of the chunks that are whole and were not read before."""
        size = os.fstat(file.fileno()).st_size
        messages: list[RawMessage] = []
        if self._header is None and size - self._at > LARGEST_LOOK:
            self._take(os.pread(file.fileno(), _HEAD, self._at), [])
        behind = size - self._at - LARGEST_LOOK
        if behind > 0:
            self._at += behind
            ahead = os.pread(file.fileno(), LARGEST_LOOK, self._at)
            self._at += next_frame(ahead, 0)
        self._at += self._take(os.pread(file.fileno(), LARGEST_LOOK, self._at), messages)
        return messages

    def _take(self, buffer: bytes, messages: list[RawMessage]) -> int:
        """Go through the records that are whole; give how many bytes they are."""
        at = 0
        while (frame := frame_at(buffer, at)) is not None:
            try:
                if frame.opcode == CHUNK:
                    messages += read_chunk(buffer, frame).messages
                elif frame.opcode == METADATA and self._header is None:
                    self._describe(parse_record(buffer, frame))
            except UnreadableError:
                pass  # whoever watches sees a gap; `recover` tells of it
            at = frame.end
        return at

    def _describe(self, record: object) -> None:
        entries = getattr(record, "metadata", {})
        if getattr(record, "name", "") != TRIAL or not is_sealed(entries):
            return
        try:
            self._header = read_header(entries)
            self._topics = {int(number): topic for number, topic in json.loads(entries["channels"]).items()}
        except (ValueError, KeyError, OverflowError) as error:
            raise TrialFileError(self._path, f"the trial's metadata cannot be read ({error})") from error

    def _news(self, messages: list[RawMessage], ended: bool) -> TrialNews:
        header, name = self._header, self._path.name.removesuffix(PART)
        if header is None:
            return TrialNews(name, None, ended=ended)
        epoch = nanoseconds(header.clock_epoch)
        found: dict[str, list[Any]] = {topic: [] for topic in _DECODERS}
        for message in messages:
            topic = self._topics.get(message.channel, "")
            if topic in _DECODERS:
                found[topic].append(_DECODERS[topic]((message.time - epoch) / NANOSECONDS, message.data))
        force, depth, frames, events = (tuple(found[channel.topic]) for channel in (FORCE, DEPTH, CAMERA, EVENTS))
        return TrialNews(name, header, force, depth, frames, events, ended)


_DECODERS: Mapping[str, Callable[[float, bytes], Any]] = {
    FORCE.topic: decode_force,
    DEPTH.topic: decode_depth,
    CAMERA.topic: decode_frame,
    EVENTS.topic: decode_event,
}
