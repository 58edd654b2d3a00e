"""Hidden effects of what force sensor and camera report."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from benchmark.blind.hidden.hidden_effect import Hidden, SessionScale
from benchmark.blind.motion import Array

ROUNDNESS = 12.0


@dataclass(frozen=True, kw_only=True)
class HiddenToolInertia(Hidden):
    """Acceleration through a mount of `ringing` Hz, damped to a half."""

    slug = "tool_inertia"
    ringing: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Mounts of 12 to 20 Hz."""
        return cls(scale=scale, ringing=float(rng.uniform(12.0, 20.0)))

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force and the tool's inertia."""
        step = time[1] - time[0]
        acceleration = np.gradient(np.gradient(depth, time), time)
        t = np.arange(0.0, 0.3, step)
        answer = np.exp(-np.pi * self.ringing * t) * np.cos(0.87 * 2 * np.pi * self.ringing * t)
        felt = np.convolve(acceleration, answer / answer.sum())[: time.size]
        return force + self.amplitude * self.scale.force * felt / (self.scale.speed / 0.05)


@dataclass(frozen=True, kw_only=True)
class HiddenForceDrift(Hidden):
    """Creep with `time` s; `walk` seeds the wandering of one trial."""

    slug = "force_drift"
    time: float
    sign: int
    walk: int | None = None

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Up or down, 8 to 40 s."""
        return cls(scale=scale, time=float(rng.uniform(8.0, 40.0)), sign=int(rng.choice([-1, 1])))

    def in_trial(self, rng: np.random.Generator) -> Self:
        """A wandering of its own."""
        return replace(super().in_trial(rng), walk=int(rng.integers(2**32)))

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force and drift."""
        drift: Array = -np.expm1(-time / self.time) / -np.expm1(-20.0 / self.time)
        if self.walk is not None:
            steps = np.random.default_rng(self.walk).normal(0.0, 1.0, time.size)
            drift = drift + 0.15 * np.cumsum(steps) / np.sqrt(time.size)
        return force + 0.2 * self.sign * self.amplitude * self.scale.force * drift


class HiddenForceSaturation(Hidden):
    """F / (1 + (F / L)^p)^(1/p) with a high p."""

    slug = "force_saturation"
    largest = 5.0

    def in_trial(self, rng: np.random.Generator) -> Self:
        """A sensor's range is the same in all trials."""
        return self

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force up to the limit."""
        over = self.amplitude * abs(force) / self.scale.force
        return force / (1.0 + over**ROUNDNESS) ** (1.0 / ROUNDNESS)


@dataclass(frozen=True, kw_only=True)
class HiddenCameraLatency(Hidden):
    """`jitter` seeds the scatter of one trial."""

    slug = "camera_latency"
    only_markers = True
    jitter: int | None = None

    def in_trial(self, rng: np.random.Generator) -> Self:
        """A scatter of its own."""
        return replace(super().in_trial(rng), jitter=int(rng.integers(2**32)))

    def instants(self, frames: Array) -> Array:
        """When frames were taken: before their stamps."""
        late = np.ones(frames.size)
        if self.jitter is not None:
            late *= np.random.default_rng(self.jitter).gamma(16.0, 1 / 16.0, frames.size)
        return np.clip(frames - 0.2 * self.amplitude * late, 0.0, None)


class HiddenPerspective(Hidden):
    """D / (D - w) with the camera D below the lower face."""

    slug = "perspective"
    only_markers = True
    largest = 3.0

    def sight(self, x: Array, y: Array, sinking: Array) -> tuple[Array, Array]:
        """Seen positions."""
        nearness = self.amplitude / 50e-3
        factor = 1.0 / (1.0 - nearness * sinking)
        return x * factor, y * factor


@dataclass(frozen=True, kw_only=True)
class HiddenMarkerScaleError(Hidden):
    """`sign` +1: markers look farther from the middle at (`x`, `y`) m than they are."""

    slug = "marker_scale_error"
    only_markers = True
    sign: int
    x: float
    y: float

    @classmethod
    def draw(cls, scale: SessionScale, rng: np.random.Generator) -> Self:
        """Either sign, a middle within 1.5 mm."""
        middle = rng.uniform(-1.5e-3, 1.5e-3, 2)
        return cls(scale=scale, sign=int(rng.choice([-1, 1])), x=float(middle[0]), y=float(middle[1]))

    def sight(self, x: Array, y: Array, sinking: Array) -> tuple[Array, Array]:
        """Seen positions."""
        across, along = x - self.x, y - self.y
        error = 0.05 * self.sign * self.amplitude * (1.0 + 0.1 * (across**2 + along**2) / 15e-3**2)
        return x + error * across, y + error * along
