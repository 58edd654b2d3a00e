"""Rate-independent hysteresis by the Bouc-Wen equation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale
from benchmark.blind.hidden.tools import touching


@dataclass(frozen=True, kw_only=True)
class DryFriction(Hidden):
    """w' = v / `reach` (1 - |w|^n (0.7 sign(v w) + 0.3)), rested whenever the tool is in air."""

    slug = "dry_friction"
    reach: float
    power: float
    growing: bool

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """A friction force that grows with the load, or not."""
        return cls(
            scale=scale,
            reach=float(rng.uniform(0.03, 0.12)) * scale.shallow,
            power=float(rng.uniform(1.0, 2.0)),
            growing=bool(rng.random() < 0.5),
        )

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Friction against the motion."""
        load = 0.3 + 0.7 * elastic / self.scale.force if self.growing else touching(depth, 0.1 * self.scale.shallow)
        return 0.2 * self.amplitude * self.scale.force * load * self._state(depth)

    def _state(self, depth: Array) -> Array:
        out, now = np.zeros(depth.size), 0.0
        pressed, moves = (depth > 0.0).tolist(), (np.diff(depth) / self.reach).tolist()
        for row, move in enumerate(moves):
            part = min(max(move, -0.5), 0.5)
            now += part * (1.0 - abs(now) ** self.power * (0.7 * np.sign(part * now) + 0.3))
            now = now if pressed[row + 1] else 0.0
            out[row + 1] = now
        return out
