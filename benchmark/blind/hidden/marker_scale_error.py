"""Wrong millimetres per pixel, about the picture's middle, with a trace of lens distortion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale


@dataclass(frozen=True, kw_only=True)
class MarkerScaleError(Hidden):
    """`sign` +1: markers look farther from the middle at (`x`, `y`) m than they are."""

    slug = "marker_scale_error"
    only_markers = True
    sign: int
    x: float
    y: float

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Either sign, a middle within 1.5 mm."""
        middle = rng.uniform(-1.5e-3, 1.5e-3, 2)
        return cls(scale=scale, sign=int(rng.choice([-1, 1])), x=float(middle[0]), y=float(middle[1]))

    def sight(self, x: Array, y: Array, sinking: Array) -> tuple[Array, Array]:
        """Seen positions."""
        across, along = x - self.x, y - self.y
        error = 0.05 * self.sign * self.amplitude * (1.0 + 0.1 * (across**2 + along**2) / 15e-3**2)
        return x + error * across, y + error * along
