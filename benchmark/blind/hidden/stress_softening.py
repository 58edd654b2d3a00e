"""Softer below the deepest depth reached so far, by a square root or a logarithm."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale


@dataclass(frozen=True, kw_only=True)
class StressSoftening(Hidden):
    """Loss of force with the distance to the deepest depth so far."""

    slug = "stress_softening"
    largest = 2.0
    logarithmic: bool

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Either form."""
        return cls(scale=scale, logarithmic=bool(rng.random() < 0.5))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """What is missing."""
        deepest = np.maximum.accumulate(np.clip(depth, 1e-9, None))
        below = np.clip(1.0 - np.clip(depth, 0.0, None) / deepest, 0.0, 1.0)
        loss = np.log1p(5.0 * below) / np.log(6.0) if self.logarithmic else np.sqrt(below)
        return -0.4 * self.amplitude * loss * elastic
