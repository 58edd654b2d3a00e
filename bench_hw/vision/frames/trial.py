"""The pictures in a native trial file, at the camera's own instants on the trial's clock."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from bench_hw.errors import TrialFileError
from bench_hw.trial_file.encoding import NANOSECONDS, decode_frame, nanoseconds
from bench_hw.trial_file.messages import read_messages
from bench_hw.trial_file.metadata import read_header
from bench_hw.trial_file.scan import scan_trial
from bench_hw.trial_file.schemas import CAMERA
from bench_hw.vision.frames.decoding import decode_grey
from bench_hw.vision.frames.model import Frame


class TrialFrames:
    """Pictures of a trial; of a damaged one those that are whole.

    Parameters
    ----------
    path : pathlib.Path
        `NAME.mcap`, or one that is cut.

    Raises
    ------
    TrialFileError
        The file cannot be read, is no trial, or has no pictures.
    """

    def __init__(self, path: Path) -> None:
        self._scan = scan_trial(path)
        self._path = path
        self._problems: list[str] = [f"the trial is not complete: {damage}" for damage in self._scan.damages[:3]]
        self._problems += self._scan.losses()
        self._late = 0
        counts = [n for number, n in self._scan.rows.items() if self._topic(number) == CAMERA.topic]
        self._count = sum(counts)
        if not self._count:
            raise TrialFileError(path, "the trial has no pictures; allowed: one recorded with a camera")
        try:
            header = None if self._scan.header is None else read_header(self._scan.header)
        except (ValueError, KeyError) as error:
            raise TrialFileError(path, f"the trial's metadata cannot be read ({error})") from error
        if header is None:
            self._problems.append("no copy of the trial's metadata is whole: times are the raw clock's")
        self._epoch = 0 if header is None else nanoseconds(header.clock_epoch)
        self._synthetic = header is not None and header.synthetic

    @property
    def name(self) -> str:
        """The file."""
        return str(self._path)

    @property
    def synthetic(self) -> bool:
        """Whether a device of the trial was simulated."""
        return self._synthetic

    @property
    def expected(self) -> int | None:
        """How many pictures the file holds."""
        return self._count

    @property
    def rate(self) -> float | None:
        """None: each picture has its own time."""
        return None

    def frames(self) -> Iterator[Frame]:
        """Give the pictures; one whose time does not increase is left out and noted."""
        self._late, last = 0, -float("inf")
        for number, message in enumerate(read_messages(self._scan, (CAMERA.topic,))):
            time = (message.time - self._epoch) / NANOSECONDS
            if time <= last:
                self._late += 1
                continue
            last = time
            try:
                record = decode_frame(time, message.data)
                picture = decode_grey(record.data, record.format)
            except (ValueError, KeyError, TypeError):
                picture = None
            yield Frame(number, time, picture)

    def notes(self) -> tuple[str, ...]:
        """Say what is damaged or late."""
        late = [f"{self._late} pictures are left out: their time does not increase"] if self._late else []
        return (*self._problems, *late)

    def _topic(self, number: int) -> str:
        info = self._scan.channels.get(number)
        return "" if info is None else info.topic
