"""Lost motion at reversals, taken up smoothly: several plays of different width side by side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale
from benchmark.blind.hidden.tools import play

WIDTHS = (0.6, 1.0, 1.4)


@dataclass(frozen=True, kw_only=True)
class Backlash(Hidden):
    """`side` -1: taken up for pressing when the trial begins; +1: for retracting, so that the first press is late."""

    slug = "backlash"
    side: int

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Either side."""
        return cls(scale=scale, side=int(rng.choice([-1, 1])))

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """What is left of the motion behind the plays."""
        lost = 0.3 * self.amplitude * self.scale.shallow
        out = np.zeros_like(depth)
        for share in WIDTHS:
            start = depth[0] + 0.5 * self.side * share * lost
            out += (play(depth, share * lost, start) - start + depth[0]) / len(WIDTHS)
        return out
