"""A sensor that weighs the accelerating tool, on a mount that rings a little."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale


@dataclass(frozen=True, kw_only=True)
class ToolInertia(Hidden):
    """Acceleration through a mount of `ringing` Hz, damped to a half."""

    slug = "tool_inertia"
    ringing: float

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
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
