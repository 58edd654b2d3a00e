"""Second forms of effects of what force sensor and camera report."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.hidden.hidden_effect import Hidden, SessionScale
from benchmark.blind.motion import Array


@dataclass(frozen=True, kw_only=True)
class FilteredInertia(Hidden):
    """The tool's acceleration behind a filter of `delay` s, without ringing."""

    slug = "tool_inertia"
    delay: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Filters of 5 to 20 ms."""
        return cls(scale=scale, delay=float(rng.uniform(5e-3, 20e-3)))

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force and the tool's inertia."""
        acceleration = np.gradient(np.gradient(depth, time), time)
        t = np.arange(0.0, 10.0 * self.delay, time[1] - time[0])
        answer = np.exp(-t / self.delay)
        felt = np.convolve(acceleration, answer / answer.sum())[: time.size]
        return force + self.amplitude * self.scale.force * felt / (self.scale.speed / 0.05)


@dataclass(frozen=True, kw_only=True)
class LogarithmicDrift(Hidden):
    """A zero that creeps as log(1 + t / `time`), with a share that runs on evenly."""

    slug = "force_drift"
    time: float
    even: float
    sign: int

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Up or down, 2 to 10 s, 0.2 to 0.6 even."""
        return cls(
            scale=scale,
            time=float(rng.uniform(2.0, 10.0)),
            even=float(rng.uniform(0.2, 0.6)),
            sign=int(rng.choice([-1, 1])),
        )

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force and drift."""
        creep = np.log1p(time / self.time) / np.log1p(20.0 / self.time)
        drift = (1.0 - self.even) * creep + self.even * time / 20.0
        out: Array = force + 0.2 * self.sign * self.amplitude * self.scale.force * drift
        return out


class HardLimit(Hidden):
    """The amplifier stops at its limit, corner and all."""

    slug = "force_saturation"
    largest = 5.0

    def in_trial(self, rng: np.random.Generator) -> Self:
        """A sensor's range is the same in all trials."""
        return self

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force up to the limit."""
        return force / np.clip(self.amplitude * abs(force) / self.scale.force, 1.0, None)


class RunningLatency(Hidden):
    """Frames are late, and later and later by a clock that runs slow."""

    slug = "camera_latency"
    only_markers = True

    def instants(self, frames: Array) -> Array:
        """When frames were taken: before their stamps."""
        late: Array = 0.85 + 0.3 * frames / frames[-1]
        return np.clip(frames - 0.2 * self.amplitude * late, 0.0, None)


@dataclass(frozen=True, kw_only=True)
class ObliquePerspective(Hidden):
    """Magnified in proportion to the sinking, round the optical axis at (`x`, `y`) m."""

    slug = "perspective"
    only_markers = True
    largest = 3.0
    x: float
    y: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """An axis within 3 mm."""
        place = rng.uniform(-3e-3, 3e-3, 2)
        return cls(scale=scale, x=float(place[0]), y=float(place[1]))

    def sight(self, x: Array, y: Array, sinking: Array) -> tuple[Array, Array]:
        """Seen positions."""
        nearer = self.amplitude / 50e-3 * sinking
        return x + nearer * (x - self.x), y + nearer * (y - self.y)


@dataclass(frozen=True, kw_only=True)
class OblongPixels(Hidden):
    """Another scale, `ratio` of it along y."""

    slug = "marker_scale_error"
    only_markers = True
    sign: int
    ratio: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Either sign, 0.8 to 1.2."""
        return cls(scale=scale, sign=int(rng.choice([-1, 1])), ratio=float(rng.uniform(0.8, 1.2)))

    def sight(self, x: Array, y: Array, sinking: Array) -> tuple[Array, Array]:
        """Seen positions."""
        error = 0.05 * self.sign * self.amplitude
        return x * (1.0 + error), y * (1.0 + self.ratio * error)


@dataclass(frozen=True, kw_only=True)
class StickSlip(Hidden):
    """Outside the catalogue: while it moves under load the guide sticks and slips every `length` m."""

    slug = "outside_stick_slip"
    length: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Every 0.3 to 0.5 mm."""
        return cls(scale=scale, length=float(rng.uniform(0.3e-3, 0.5e-3)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """A saw of force, against the motion."""
        way = np.cumsum(np.abs(np.diff(depth, prepend=depth[0])))
        speed = np.gradient(depth, time)
        saw = (way / self.length) % 1.0 - 0.3
        return 0.2 * self.amplitude * self.scale.force * saw * np.tanh(20.0 * speed / self.scale.speed)


@dataclass(frozen=True, kw_only=True)
class RoomCycle(Hidden):
    """Outside the catalogue: the room's cooling swings the sensor's zero with `period` s, in step with the trials."""

    slug = "outside_room_cycle"
    period: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """3 to 6 s."""
        return cls(scale=scale, period=float(rng.uniform(3.0, 6.0)))

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force and the swing of its zero."""
        return force + 0.1 * self.amplitude * self.scale.force * np.sin(2 * np.pi * time / self.period)


@dataclass(frozen=True, kw_only=True)
class SnapThrough(Hidden):
    """Outside the catalogue: a pocket gives way at `place` of the shallow press and comes back when unloaded."""

    slug = "outside_snap_through"
    place: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """At 0.4 to 0.7."""
        return cls(scale=scale, place=float(rng.uniform(0.4, 0.7)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """A dent in the force over a few tenths of a millimetre."""
        away = (depth - self.place * self.scale.shallow) / (0.08 * self.scale.shallow)
        return -0.3 * self.amplitude * self.scale.force * np.where(depth > 0.0, np.exp(-0.5 * away**2), 0.0)


@dataclass(frozen=True, kw_only=True)
class PixelLocking(Hidden):
    """Outside the catalogue: tracked places lean towards whole pixels of `pixel` m."""

    slug = "outside_pixel_locking"
    only_markers = True
    pixel: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Pixels of 0.15 to 0.3 mm."""
        return cls(scale=scale, pixel=float(rng.uniform(0.15e-3, 0.3e-3)))

    def sight(self, x: Array, y: Array, sinking: Array) -> tuple[Array, Array]:
        """Seen positions."""
        lean = 0.5 * self.amplitude * self.pixel / (2 * np.pi)
        phase = 2 * np.pi / self.pixel
        return x - lean * np.sin(phase * x), y - lean * np.sin(phase * y)


@dataclass(frozen=True, kw_only=True)
class FlickeringLight(Hidden):
    """Outside the catalogue: a light that flickers with `frequency` Hz makes the picture breathe."""

    slug = "outside_flickering_light"
    only_markers = True
    frequency: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """0.4 to 0.9 times a second at 30 frames a second."""
        return cls(scale=scale, frequency=float(rng.uniform(0.4, 0.9)))

    def sight(self, x: Array, y: Array, sinking: Array) -> tuple[Array, Array]:
        """Seen positions."""
        frame = np.arange(len(x))[:, None] / 30.0
        error = 5e-3 * self.amplitude * np.sin(2 * np.pi * self.frequency * frame)
        return x * (1.0 + error), y * (1.0 + error)
