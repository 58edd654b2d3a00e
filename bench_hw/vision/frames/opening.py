"""The pictures of a trial, a video, a folder or a pattern of files: each a `FrameSource`, found by `open_frames`.

Videos are read through OpenCV's own FFmpeg; a trial's pictures have the camera's own instants on the trial's clock.
"""

from __future__ import annotations

import glob
import math
import re
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from bench_hw.errors import InputError, TrialFileError
from bench_hw.storage.regular_file import DOCUMENT, read_regular
from bench_hw.trial_file.encoding import CAMERA, NANOSECONDS, decode_frame, nanoseconds
from bench_hw.trial_file.scan import read_messages, scan_trial, trial_header
from bench_hw.vision.frames.source import Frame, FrameSource, decode_grey, to_grey

KINDS = {
    ".png": "png",
    ".jpg": "jpeg",
    ".jpeg": "jpeg",
    ".tif": "tiff",
    ".tiff": "tiff",
    ".bmp": "bmp",
    ".pgm": "pgm",
    ".webp": "webp",
}
USUAL_RATE = 30.0
"""Pictures per second where none is given, Hz: the paper's webcam."""
_NUMBERED = re.compile(r"%0?\d*d")
_RATES = (0.01, 100_000.0)
_SAME_RATE = 1e-3
"""Relative difference of two rates that are one, as 29.97 and 30000/1001."""
_GREY = cv2.VideoWriter.fourcc(*"Y800")
"""FFmpeg's pixels of one byte of grey: they need no way through colour and back."""
_BY_MOTION = (
    *("FMP4", "MP4V", "XVID", "DIVX", "DX50", "H263", "H264", "X264", "AVC1", "HEVC", "H265", "HVC1", "HEV1"),
    *("VP80", "VP90", "AV01", "MPG1", "MPG2", "MPEG", "WMV1", "WMV2", "WMV3", "WVC1", "FLV1", "THEO"),
)
"""FFmpeg's four letters of codecs that keep of a picture how it differs from the one before."""
_TRIALS = (".mcap", ".mcap.part")


def open_frames(place: str, rate: float | None = None) -> FrameSource:
    """Open a trial, a video, a folder or a pattern of pictures.

    Parameters
    ----------
    place : str
        `NAME.mcap` (also one that is cut, or `.mcap.part`), a video file, a folder of pictures, or a pattern
        such as `frames/*.png` or `frames/%06d.png`.
    rate : float, optional
        Pictures per second, Hz; for videos and pictures only.

    Raises
    ------
    InputError
        There is nothing that can be read, or a rate is given for a trial.
    """
    if place.endswith(_TRIALS):
        if rate is not None:
            raise InputError(f"{place}: `--fps` is for videos and pictures; a trial has the camera's own times")
        return TrialFrames(Path(place))
    return PictureFrames(place, rate) if is_pictures(place) else VideoFrames(Path(place), rate)


class PictureFrames:
    """Pictures in the natural order of their names.

    Parameters
    ----------
    place : str
        A folder, one picture, a pattern with `*` or `?`, or a numbered one (`frame_%04d.png`).
    rate : float, optional
        Pictures per second, Hz; 30 without it, which is then noted.

    Raises
    ------
    InputError
        There is no picture.
    """

    def __init__(self, place: str, rate: float | None = None) -> None:
        self._assumed = rate is None
        self._files = picture_files(place)
        self.name, self.synthetic, self.expected = place, False, len(self._files)
        self.rate = rate or USUAL_RATE

    def frames(self) -> Iterator[Frame]:
        """Give the pictures, number / rate as time."""
        for number, file in enumerate(self._files):
            yield Frame(
                number, number / self.rate, decode_grey(read_regular(file, DOCUMENT), KINDS[file.suffix.lower()])
            )

    def notes(self) -> tuple[str, ...]:
        """Say what was assumed."""
        return (f"{self.rate:g} pictures a second are assumed; `--fps` says otherwise",) if self._assumed else ()


def is_pictures(place: str) -> bool:
    """Say whether a place is a folder, a pattern or a single picture."""
    path = Path(place)
    return path.is_dir() or _is_pattern(place) or path.suffix.lower() in KINDS


def _is_pattern(place: str) -> bool:
    return not Path(place).exists() and (any(sign in place for sign in "*?[") or bool(_NUMBERED.search(place)))


def picture_files(place: str) -> list[Path]:
    """The pictures of a folder or pattern, or the one picture, in the natural order of their names.

    Raises
    ------
    InputError
        There is no picture.
    """
    files = sorted(_files(place), key=_natural)
    if not files:
        raise InputError(f"{place}: no pictures; allowed endings: {', '.join(KINDS)}")
    return files


def _files(place: str) -> list[Path]:
    path = Path(place)
    if path.is_dir():
        found = list(path.iterdir())
    elif _is_pattern(place):
        found = [Path(name) for name in glob.glob(_NUMBERED.sub("[0-9]*", place))]  # noqa: PTH207 - any folder
    else:
        found = [path]
    return [file for file in found if file.is_file() and file.suffix.lower() in KINDS]


def _natural(path: Path) -> list[tuple[int, int, str]]:
    """Order by the numbers in a name as numbers: 2 before 10."""
    parts = re.split(r"(\d+)", path.name)
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in parts]


class VideoFrames:
    """Pictures of a video.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    rate : float, optional
        Pictures per second instead of the file's own, Hz.

    Raises
    ------
    InputError
        No such file, no video, or one that does not say how fast it is.
    """

    def __init__(self, path: Path, rate: float | None = None) -> None:
        self._path = path
        self.name, self.synthetic = str(path), False
        if not path.is_file():
            raise InputError(f"{path}: no such file; allowed: a trial, a video, or a folder of pictures")
        video = self._opened()
        self._own = float(video.get(cv2.CAP_PROP_FPS))
        self._codec = _four_letters(int(video.get(cv2.CAP_PROP_FOURCC)))
        self.rate = rate or self._own
        count = video.get(cv2.CAP_PROP_FRAME_COUNT)
        video.release()
        self.expected = int(count) if 0 < count < 1e9 else None
        self._given: int | None = None
        if not (math.isfinite(self.rate) and _RATES[0] <= self.rate <= _RATES[1]):
            raise InputError(f"{path}: the video has no usable rate ({self.rate:g} Hz); give `--fps`")

    def frames(self) -> Iterator[Frame]:
        """Give the pictures up to the last that can be read, number / rate as time.

        Raises
        ------
        InputError
            There is none.
        """
        video, number = self._opened(), 0
        try:
            while True:
                there, picture = video.read()
                if not there or picture is None:
                    break
                yield Frame(number, number / self.rate, to_grey(np.asarray(picture, dtype=np.uint8)))
                number += 1
        finally:
            video.release()
        self._given = number
        if number == 0:
            raise InputError(f"{self._path}: the video has no picture that can be read")

    def notes(self) -> tuple[str, ...]:
        """Say if the video ended early, tells of another rate than is used, or keeps differences between pictures."""
        said = []
        if self._codec.upper() in _BY_MOTION:
            said.append(
                f"the video is compressed from picture to picture ({self._codec}): small motion comes late in it, "
                "places are up to fifteen times less sure than stated, and a clock set by them may be 10 to 25 ms off; "
                "record without loss (FFV1) or each picture by itself (MJPG)"
            )
        if self._given is not None and self.expected is not None and self._given < self.expected:
            said.append(f"the video ends after {self._given} of the {self.expected} pictures it should have")
        if _RATES[0] <= self._own <= _RATES[1] and abs(self._own - self.rate) > _SAME_RATE * self.rate:
            said.append(f"the video tells of {self._own:.6g} pictures a second; {self.rate:.6g} as told are used")
        return tuple(said)

    def _opened(self) -> cv2.VideoCapture:
        if any(
            "\ud800" <= letter <= "\udfff" for letter in str(self._path)
        ):  # OpenCV would end the program by bytes that are no text
            raise InputError(f"{self._path}: no film is read whose path has bytes that are no text; rename it")
        try:
            video = cv2.VideoCapture(str(self._path), cv2.CAP_FFMPEG)
        except cv2.error as error:
            raise InputError(f"{self._path}: no video that can be read ({error.err})") from error
        if not video.isOpened():
            raise InputError(
                f"{self._path}: no video that can be read (cut, empty or of another kind); "
                "allowed: what OpenCV's FFmpeg reads, such as .avi, .mkv, .mp4"
            )
        if int(video.get(cv2.CAP_PROP_CODEC_PIXEL_FORMAT)) == _GREY:
            video.set(cv2.CAP_PROP_CONVERT_RGB, 0)
        return video


def _four_letters(code: int) -> str:
    """The codec that OpenCV tells of by a number; empty where it is raw or not known."""
    return code.to_bytes(4, "little").decode("latin-1").strip("\0 ") if code > 0 else ""


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
        self.name, self.rate = str(path), None
        self._problems: list[str] = [f"the trial is not complete: {damage}" for damage in self._scan.damages[:3]]
        self._problems += self._scan.losses()
        self._late = 0
        counts = [n for number, n in self._scan.rows.items() if self._topic(number) == CAMERA.topic]
        self.expected = sum(counts)
        if not self.expected:
            raise TrialFileError(path, "the trial has no pictures; allowed: one recorded with a camera")
        header = trial_header(self._scan)
        if header is None:
            self._problems.append("no copy of the trial's metadata is whole: times are the raw clock's")
        self._epoch = 0 if header is None else nanoseconds(header.clock_epoch)
        self.synthetic = header is not None and header.synthetic
        self.camera_file = "" if header is None else header.calibrations.get("camera", "")

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
