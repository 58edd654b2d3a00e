"""What a force sensor, an actuator and a camera are to the bench, whatever is behind them; the base of their drivers.

Connecting is explicit: a driver that was only constructed has touched nothing. `connect` either leaves a
device that answered and is the right one, or raises `DeviceError` and leaves nothing open. `read` never
waits: it gives what has come since the last call, stamped on the bench's clock.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import TracebackType
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class DeviceInfo:
    """What a connected device says of itself.

    Parameters
    ----------
    model : str
        Kind of device, for instance `ATI Net F/T`.
    serial : str
        Serial number, empty if the device has none.
    calibration : str
        SHA-256 of the calibration in use, empty if there is none.
    settings : Mapping[str, str]
        What was set and read back, value and unit in the text.
    """

    model: str
    serial: str = ""
    calibration: str = ""
    settings: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ForceBlock:
    """Force samples in the order of arrival.

    Parameters
    ----------
    time : ndarray (n,)
        Sampling instants on the bench's clock, s, strictly increasing within and across blocks.
    wrench : ndarray (n, 6)
        Fx, Fy, Fz (N) and Tx, Ty, Tz (N m) in the sensor's axes.
    rdt_sequence, ft_sequence, status : ndarray (n,) of uint32
        Counters modulo 2^32 and the status word; a DAQ counts its samples in both.
    counts : ndarray (n, 6) of int32, optional
        Raw counts of the record, if the sensor sends counts.
    """

    time: NDArray[np.float64]
    wrench: NDArray[np.float64]
    rdt_sequence: NDArray[np.uint32]
    ft_sequence: NDArray[np.uint32]
    status: NDArray[np.uint32]
    counts: NDArray[np.int32] | None = None

    def __len__(self) -> int:
        return len(self.time)

    def before(self, later: ForceBlock) -> ForceBlock:
        """Join this block and a later one of the same sensor."""
        if not len(self) or not len(later):
            return self if len(self) else later
        counts = None if self.counts is None or later.counts is None else np.concatenate([self.counts, later.counts])
        return ForceBlock(
            np.concatenate([self.time, later.time]),
            np.concatenate([self.wrench, later.wrench]),
            np.concatenate([self.rdt_sequence, later.rdt_sequence]),
            np.concatenate([self.ft_sequence, later.ft_sequence]),
            np.concatenate([self.status, later.status]),
            counts,
        )

    @classmethod
    def empty(cls) -> ForceBlock:
        """Give a block without samples."""
        none = np.zeros(0, np.uint32)
        return cls(np.zeros(0), np.zeros((0, 6)), none, none, none)


@dataclass(frozen=True, slots=True)
class StreamHealth:
    """What became of a stream of numbered samples since `start`.

    `lost` are records that never came, `reordered` came late (and are not lost), `duplicates` came twice and
    were dropped, `restarts` are counters that restarted, `stalls` are records whose sample number stood
    still, `malformed` are datagrams that are no records.
    """

    received: int = 0
    lost: int = 0
    duplicates: int = 0
    reordered: int = 0
    restarts: int = 0
    stalls: int = 0
    malformed: int = 0


class Device(Protocol):
    """What every driver is: connected explicitly, checked to be the right device, always let go."""

    @property
    def info(self) -> DeviceInfo:
        """What the connected device said of itself."""
        ...

    def connect(self) -> None:
        """Find the device, check that it is the right one, set it up and read the settings back; nothing moves."""
        ...

    def close(self) -> None:
        """Let go of the device; may be repeated."""
        ...

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...


class ForceSensor(Device, Protocol):
    """A six-axis force/torque sensor that streams."""

    @property
    def rate(self) -> float:
        """Samples per second, as read back from the device, Hz."""
        ...

    @property
    def latency(self) -> float:
        """Time between two deliveries of samples, s."""
        ...

    @property
    def ranges(self) -> NDArray[np.float64]:
        """Largest magnitude of Fx..Tz the device is calibrated for, (6,), N and N m; NaN if unknown."""
        ...

    @property
    def health(self) -> StreamHealth:
        """Counts of the stream since `start`."""
        ...

    def start(self) -> None:
        """Begin to stream; returns when the first sample has come."""
        ...

    def read(self) -> ForceBlock:
        """Give the samples that have come since the last call; never waits."""
        ...

    def bias(self) -> None:
        """Take the present load as zero."""
        ...

    def stop(self) -> None:
        """End the stream."""
        ...


class Actuator(Device, Protocol):
    """A linear actuator; positions in metres from fully retracted, positive towards the specimen."""

    @property
    def uncertainty(self) -> float:
        """Half-width within which the actuator stops around its target, m (dead band and half a count)."""
        ...

    @property
    def counts(self) -> int | None:
        """The device's own reading behind the last position; None if it has none."""
        ...

    def set_limits(self, low: float, high: float) -> tuple[float, float]:
        """Set the travel limits in the device itself, m; give those it really has, not wider than asked for."""
        ...

    def position(self) -> float:
        """Ask for the present position, m."""
        ...

    def move_to(self, position: float, speed: float) -> None:
        """Start moving to `position` (m) at `speed` (m/s); returns at once."""
        ...

    def halt(self) -> None:
        """Stop where it is."""
        ...

    def retract(self) -> None:
        """Start moving to the lower limit at full speed; one attempt, reconnecting if need be."""
        ...


@dataclass(frozen=True, slots=True)
class CameraFrame:
    """One picture as the camera encoded it.

    Parameters
    ----------
    time : float
        When it was taken on the bench's clock, s.
    number : int
        Number since `start`; a number that is skipped is a dropped frame.
    data : bytes
        The encoded picture.
    format : str
        `jpeg` or `png`.
    """

    time: float
    number: int
    data: bytes
    format: str = "jpeg"


@dataclass(frozen=True, slots=True)
class CameraHealth:
    """Frames received, dropped and repeated byte for byte (`frozen`) since `start`."""

    received: int = 0
    dropped: int = 0
    frozen: int = 0


class CameraDriver(Device, Protocol):
    """A camera that gives encoded pictures."""

    @property
    def rate(self) -> float:
        """Nominal frames per second, Hz."""
        ...

    @property
    def health(self) -> CameraHealth:
        """Counts of the stream since `start`."""
        ...

    def start(self) -> None:
        """Begin to take frames; numbers begin at 0."""
        ...

    def read(self) -> list[CameraFrame]:
        """Give the frames that have come since the last call; never waits."""
        ...

    def stop(self) -> None:
        """Stop taking frames."""
        ...


class Connection(ABC):
    """Something that is connected explicitly and always let go."""

    @abstractmethod
    def connect(self) -> None:
        """Open the device."""

    @abstractmethod
    def close(self) -> None:
        """Let go of the device."""

    def __enter__(self) -> Self:
        self.connect()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
