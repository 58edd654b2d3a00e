"""A force that goes with a power of the speed a little below one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale
from benchmark.blind.hidden.tools import touching


@dataclass(frozen=True, kw_only=True)
class ViscousDamping(Hidden):
    """|v|^p against the motion, while the tool touches."""

    slug = "viscous_damping"
    power: float

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Powers 0.75 to 0.9."""
        return cls(scale=scale, power=float(rng.uniform(0.75, 0.9)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Against the motion."""
        speed = np.gradient(depth, time) / self.scale.speed
        drag = np.sign(speed) * np.abs(speed) ** self.power
        return 0.3 * self.amplitude * self.scale.force * touching(depth, 0.15 * self.scale.shallow) * drag
