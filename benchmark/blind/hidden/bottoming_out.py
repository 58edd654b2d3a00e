"""A stiff floor that is met as a ball meets a plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale


@dataclass(frozen=True, kw_only=True)
class BottomingOut(Hidden):
    """`floor` as a share of the shallow press; beyond it force grows with the power 1.5."""

    slug = "bottoming_out"
    floor: float

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Floors at 0.6 to 0.8."""
        return cls(scale=scale, floor=float(rng.uniform(0.6, 0.8)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Extra force beyond the floor."""
        beyond = np.clip(depth - self.floor * self.scale.shallow, 0.0, None) / self.scale.deep
        return 3.0 * self.amplitude * self.scale.force * beyond**1.5
