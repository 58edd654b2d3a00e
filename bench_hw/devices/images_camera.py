"""`ImagesCamera`: a folder of picture files given out at a frame rate, as if a camera took them."""

from __future__ import annotations

from pathlib import Path

from bench_hw.clock import Clock, MonotonicClock
from bench_hw.devices.grabbing import FrameCounter
from bench_hw.devices.protocols import CameraFrame, CameraHealth, Connection, DeviceInfo
from bench_hw.errors import DeviceError
from bench_hw.storage.regular_file import DOCUMENT, read_regular

_FORMATS = {".jpg": "jpeg", ".jpeg": "jpeg", ".png": "png"}


class ImagesCamera(Connection):
    """Driver of a folder of pictures.

    Parameters
    ----------
    folder : pathlib.Path
        Where the files are; .jpg, .jpeg and .png in the order of their names.
    rate : float
        Frames per second, Hz.
    clock : Clock, optional
        The bench's clock.
    """

    def __init__(self, folder: Path, *, rate: float = 30.0, clock: Clock | None = None) -> None:
        self._folder, self._rate = folder, rate
        self._clock = clock or MonotonicClock()
        self._files: list[Path] = []
        self._counter = FrameCounter(1.0 / rate)
        self._begun: float | None = None
        self._next = 0

    @property
    def info(self) -> DeviceInfo:
        """The folder, the number of pictures and the rate."""
        settings = {
            "folder": str(self._folder),
            "pictures": str(len(self._files)),
            "rate": f"{self._rate:g} Hz",
        }
        return DeviceInfo("image files", settings=settings)

    @property
    def rate(self) -> float:
        """Frames per second, Hz."""
        return self._rate

    @property
    def health(self) -> CameraHealth:
        """Counts since `start`."""
        return self._counter.health

    def connect(self) -> None:
        """List the pictures.

        Raises
        ------
        DeviceError
            No such folder, or no picture in it.
        """
        if not self._folder.is_dir():
            raise DeviceError(f"camera: {self._folder} is no folder of pictures")
        files = sorted(path for path in self._folder.iterdir() if path.suffix.lower() in _FORMATS)
        if not files:
            raise DeviceError(f"camera: no picture in {self._folder}; allowed are {', '.join(_FORMATS)}")
        self._files = files

    def start(self) -> None:
        """Begin with the first picture; numbers begin at 0."""
        self._begun, self._next = self._clock.now(), 0
        self._counter = FrameCounter(1.0 / self._rate)

    def read(self) -> list[CameraFrame]:
        """Give the pictures that are due, stamped when they were; none after the last.

        Raises
        ------
        DeviceError
            A file vanished or cannot be read.
        """
        if self._begun is None:
            return []
        due = min(len(self._files), int((self._clock.now() - self._begun) * self._rate + 1e-9) + 1)
        frames = [self._frame(k) for k in range(self._next, due)]
        self._next = max(self._next, due)
        return frames

    def stop(self) -> None:
        """Give out no more."""
        self._begun = None

    def close(self) -> None:
        """Let go of the folder; may be repeated."""
        self.stop()

    def _frame(self, k: int) -> CameraFrame:
        assert self._begun is not None
        path = self._files[k]
        try:
            data = read_regular(path, DOCUMENT)
        except OSError as error:
            raise DeviceError(f"camera: {path} cannot be read ({error.strerror})") from error
        return self._counter.frame(self._begun + k / self._rate, data, _FORMATS[path.suffix.lower()], k)
