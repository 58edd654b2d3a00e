"""A running `capture` on the press page: what has reached the trial's file, ten times a second, for pages that look.

The watcher reads the growing file and nothing else (`bench_hw.trial_file.following`), as a process of low priority: the
recording neither knows of it nor waits for it. Of the pictures the newest goes out, its markers found here; a page that
is slow misses some. No page can send anything.
"""

from __future__ import annotations

import asyncio
import base64
import os
import time
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tornado.websocket import WebSocketClosedError

from bench_hw.errors import BenchError
from bench_hw.trial_file.following import TrialFollower, TrialNews
from bench_hw.trial_file.records import ForceRecord, FrameRecord, TrialHeader
from bench_hw.vision.frames.source import decode_grey
from bench_hw.vision.markers import detect_grid
from benchmark.press.press_server import Line, Served

LOOK_PERIOD = 0.1
"""Time between two looks at the file, s."""
MOST_SAMPLES = 20
"""Force samples sent for one look: a trace on a screen shows no more."""
SILENT = 2.0
"""s without anything new, after which a page is told: a recording writes five times a second."""
_PICTURES = 31


@dataclass
class LiveCapture:
    """What a watcher knows of the trial that is recorded.

    Parameters
    ----------
    place
        A session's folder or a trial; see `TrialFollower`.

    Raises
    ------
    TrialFileError
        There is nothing that can be watched.
    """

    place: Path
    follower: TrialFollower = field(init=False)
    force_lost: int = 0
    dropped: int = 0
    doing: str = ""
    faults: list[str] = field(default_factory=list)
    last_force: ForceRecord | None = None
    last_frame: FrameRecord | None = None
    frame_times: deque[float] = field(default_factory=lambda: deque(maxlen=_PICTURES))

    def __post_init__(self) -> None:
        self.follower = TrialFollower(self.place)
        self._trial, self._synthetic, self._seconds, self._heard = "", False, 0.0, time.monotonic()

    def look(self) -> dict[str, Any]:
        """What is new since the last look, as JSON values; between trials {"waiting": where} and how the last ended."""
        try:
            news = self.follower.look()
        except BenchError as error:
            return {"error": str(error)}
        if news is None:
            return {"waiting": str(self.place), **({"last": self._last()} if self._trial else {})}
        if news.name != self._trial:
            self._trial, self.force_lost, self.dropped, self.doing = news.name, 0, 0, ""
            self.last_force = self.last_frame = None
            self._seconds, self._heard = 0.0, time.monotonic()
            self.faults.clear()
            self.frame_times.clear()
        self._count(news)
        silent = time.monotonic() - self._heard
        return {
            "trial": news.name,
            **_about(news.header),
            "force": _thinned(news),
            "depth": [[record.time, record.depth] for record in news.depth],
            "force_lost": self.force_lost,
            "camera": self._camera(news),
            "doing": self.doing,
            "faults": list(self.faults),
            "silent_s": silent if silent > SILENT and not news.ended else 0.0,
            "ended": news.ended,
        }

    def _last(self) -> dict[str, Any]:
        """The trial that has ended, with its length in s and its faults."""
        return {
            "trial": self._trial,
            "synthetic": self._synthetic,
            "seconds": self._seconds,
            "faults": list(self.faults),
        }

    def _count(self, news: TrialNews) -> None:
        if news.force or news.depth or news.frames or news.events:
            self._heard = time.monotonic()
        self._synthetic = news.header is not None and news.header.synthetic
        if news.force:
            self._seconds = news.force[-1].time
        self.faults += [f"{event.kind}: {event.message}" for event in news.events if event.level == "fault"]
        for record in news.force:
            if self.last_force is not None:
                self.force_lost += max(0, record.rdt_sequence - self.last_force.rdt_sequence - 1)
            self.last_force = record
        for frame in news.frames:
            if self.last_frame is not None:
                self.dropped += max(0, frame.frame - self.last_frame.frame - 1)
            self.last_frame = frame
            self.frame_times.append(frame.time)
        self.doing = next((event.message for event in reversed(news.events) if event.kind == "segment"), self.doing)

    def _camera(self, news: TrialNews) -> dict[str, Any] | None:
        if not news.frames:
            return None
        newest, times = news.frames[-1], self.frame_times
        gone = times[-1] - times[0]
        return {
            "time_s": newest.time,
            "number": newest.frame,
            "rate": (len(times) - 1) / gone if gone > 0.0 else 0.0,
            "dropped": self.dropped,
            "format": newest.format,
            "picture": base64.b64encode(newest.data).decode("ascii"),
            **_markers(newest),
        }


def _about(header: TrialHeader | None) -> dict[str, Any]:
    if header is None:
        return {}
    return {"protocol": header.protocol, "started": header.started, "synthetic": header.synthetic}


def _thinned(news: TrialNews) -> list[list[float]]:
    """Time (s) and press force (N) of at most `MOST_SAMPLES` samples and the largest, in their order."""
    press = news.press()
    if not press:
        return []
    every = -(-len(press) // MOST_SAMPLES)
    rows = sorted({*range(0, len(press), every), max(range(len(press)), key=press.__getitem__), len(press) - 1})
    return [[news.force[row].time, press[row]] for row in rows]


def _markers(frame: FrameRecord) -> dict[str, Any]:
    """Centres and radius of the markers in a picture, pixels; why there are none otherwise."""
    grey = decode_grey(frame.data, frame.format)
    if grey is None:
        return {"markers": [], "why": "the picture cannot be decoded"}
    try:
        found = detect_grid(grey)
    except BenchError as error:
        return {"markers": [], "why": str(error)}
    return {"markers": found.centres.round(2).tolist(), "radius": round(found.radius, 2)}


class LiveLine(Line):
    """The line on which pages hear of the capture; whatever a page sends ends it."""

    def on_message(self, message: str | bytes) -> None:  # noqa: ARG002
        """Nobody asks for anything here."""
        self.close(1008, "this line only tells")


async def tell(served: Served, live: LiveCapture, priority: int = 10) -> None:
    """Tell every page that looks, until this is cancelled; a page still busy with the last news misses some.

    `priority` is how much lower than others this process stands from now on, where the system knows of such a thing.
    """
    with suppress(AttributeError, OSError):
        os.nice(priority)
    loop, busy = asyncio.get_running_loop(), set[Line]()

    async def send(line: Line, news: dict[str, Any]) -> None:
        try:
            await line.write_message(news)
        except WebSocketClosedError:
            return
        finally:
            busy.discard(line)

    with ThreadPoolExecutor(max_workers=1, thread_name_prefix="watch") as worker:
        while True:
            listening = [page for page in served.pages if isinstance(page, LiveLine)]
            if listening:
                news = await loop.run_in_executor(worker, live.look)
                for line in listening:
                    if line not in busy:
                        busy.add(line)
                        loop.create_task(send(line, news))
            await asyncio.sleep(LOOK_PERIOD)
