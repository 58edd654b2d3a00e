"""A specimen that stiffens exponentially with depth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale


@dataclass(frozen=True, kw_only=True)
class StrainStiffening(Hidden):
    """Extra force e^(k s) - 1 - k s over the share s of the deepest press."""

    slug = "strain_stiffening"
    steepness: float

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Steepness 2.5 to 5."""
        return cls(scale=scale, steepness=float(rng.uniform(2.5, 5.0)))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Extra force."""
        k, share = self.steepness, np.clip(depth, 0.0, None) / self.scale.deep
        more: Array = (np.expm1(k * share) - k * share) / (np.expm1(k) - k)
        return 0.5 * self.amplitude * self.scale.force * more
