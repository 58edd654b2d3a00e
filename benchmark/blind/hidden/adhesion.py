"""A tool that is held on lift-off, by a bond that tears gradually."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale


@dataclass(frozen=True, kw_only=True)
class Adhesion(Hidden):
    """The bond pulls up to `reach` m above the surface and is gone beyond, until the next touch."""

    slug = "adhesion"
    reach: float

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Reaches of 0.3 to 0.8 mm."""
        return cls(scale=scale, reach=float(rng.uniform(0.3e-3, 0.8e-3)))

    def pull(self, time: Array, depth: Array) -> Array:
        """Negative force while the bond holds."""
        share = np.clip(-depth, 0.0, None) / self.reach
        size = -np.expm1(-share / 0.15) * np.cos(0.5 * np.pi * np.clip(share, 0.0, 1.0)) ** 0.5
        return -0.3 * self.amplitude * self.scale.force * np.where(self._held(depth), size, 0.0)

    def _held(self, depth: Array) -> Array:
        """Whether (n,) the bond holds: from a touch until it is torn."""
        out, holds = np.zeros(depth.size), False
        for row, value in enumerate(depth.tolist()):
            holds = value > 0.0 or (holds and value > -self.reach)
            out[row] = holds
        return out.astype(bool)
