"""Numbers for frames: which are missing, and which repeat the one before.

A camera that numbers its frames is believed. For one that does not, a gap of more than 1.5 periods between
two stamps is dropped frames, as many as fit. A frame that equals the one before byte for byte is frozen: a
live sensor has noise.
"""

from __future__ import annotations

from bench_hw.devices.protocols import CameraHealth, Frame

LARGEST_GAP = 1.5
"""Periods between two stamps above which frames were dropped."""


class FrameCounter:
    """Numbers the frames of one stream.

    Parameters
    ----------
    period : float
        Nominal time between two frames, s.
    """

    def __init__(self, period: float) -> None:
        self._period = period
        self._last: Frame | None = None
        self._offset: int | None = None
        self._received = self._dropped = self._frozen = 0

    @property
    def health(self) -> CameraHealth:
        """The counts so far."""
        return CameraHealth(self._received, self._dropped, self._frozen)

    def frame(self, time: float, data: bytes, format: str, sequence: int | None = None) -> Frame:
        """Give one frame its number; `sequence` is the camera's own number, if it has one."""
        number = self._number(time, sequence)
        last = self._last
        if last is not None:
            self._dropped += number - last.number - 1
            self._frozen += data == last.data
        self._received += 1
        self._last = Frame(time, number, data, format)
        return self._last

    def _number(self, time: float, sequence: int | None) -> int:
        if self._last is None:
            self._offset = sequence
            return 0
        if sequence is not None and self._offset is not None:
            return max(sequence - self._offset, self._last.number + 1)
        gap = time - self._last.time
        periods = round(gap / self._period) if gap > LARGEST_GAP * self._period else 1
        return self._last.number + periods
