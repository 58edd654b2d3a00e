"""A zero that creeps exponentially, and wanders in each trial."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale


@dataclass(frozen=True, kw_only=True)
class ForceDrift(Hidden):
    """Creep with `time` s; `walk` seeds the wandering of one trial."""

    slug = "force_drift"
    time: float
    sign: int
    walk: int | None = None

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
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
