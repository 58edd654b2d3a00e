"""One picture with its time, and what gives them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]


@dataclass(frozen=True, eq=False, slots=True)
class Frame:
    """A picture of a source.

    Parameters
    ----------
    number : int
        Place in the source, from 0.
    time : float
        s: the camera's own stamp on the trial's clock, or number / rate for a bare video.
    grey : ndarray of uint8, shape (height, width), or None
        None where the picture is there but cannot be decoded.
    """

    number: int
    time: float
    grey: Picture | None


class FrameSource(Protocol):
    """Gives pictures in their order, from the first one each time it is asked."""

    @property
    def name(self) -> str:
        """What is read, for messages."""
        ...

    @property
    def synthetic(self) -> bool:
        """Whether the source says of itself that it is synthetic."""
        ...

    @property
    def expected(self) -> int | None:
        """How many pictures there should be, None if nobody knows."""
        ...

    @property
    def rate(self) -> float | None:
        """Pictures per second where the source has a fixed rate, Hz."""
        ...

    def frames(self) -> Iterator[Frame]:
        """Give the pictures; their times increase strictly."""
        ...

    def notes(self) -> tuple[str, ...]:
        """Say what was wrong with the source, a sentence each; complete once all pictures are given."""
        ...
