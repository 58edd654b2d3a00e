"""A surface that does not come back: the set grows under load and saturates with depth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale


@dataclass(frozen=True, kw_only=True)
class PermanentSet(Hidden):
    """`delay` s until the set is there; `shown` of it stays in the lower face."""

    slug = "permanent_set"
    largest = 3.0
    delay: float
    shown: float

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Quick or slow, seen by the camera or not."""
        return cls(scale=scale, delay=float(rng.uniform(0.1, 0.6)), shown=float(rng.choice([0.0, 0.5, 1.0])))

    def indent(self, time: Array, depth: Array) -> Array:
        """Depth less the set so far."""
        return depth - self._set(time, depth)

    def surface(self, time: Array, depth: Array, strained: Array) -> Array:
        """The lower face keeps its share of the set, pressed or not."""
        return np.clip(strained, 0.0, None) + self.shown * self._set(time, depth)

    def _set(self, time: Array, depth: Array) -> Array:
        """(n,) m: it follows the largest set that the depth asks for, never back."""
        wanted = 0.25 * self.amplitude * self.scale.deep * -np.expm1(-np.clip(depth, 0.0, None) / self.scale.deep)
        share = -np.expm1(-(time[1] - time[0]) / self.delay)
        out, now = np.zeros(depth.size), 0.0
        for row, target in enumerate(wanted.tolist()):
            now += share * max(target - now, 0.0)
            out[row] = now
        return out
