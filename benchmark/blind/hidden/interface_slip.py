"""Layers that slide over a threshold: seen in the lower face, and hardly or not in the force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale
from benchmark.blind.hidden.tools import play, smooth_excess


@dataclass(frozen=True, kw_only=True)
class InterfaceSlip(Hidden):
    """`threshold` of the shallow press; `sticky`: it slides back only past as much on the other side."""

    slug = "interface_slip"
    only_markers = True
    largest = 1.5
    threshold: float
    sticky: bool
    felt: float

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Sticky or not, felt in the force or not."""
        return cls(
            scale=scale,
            threshold=float(rng.uniform(0.3, 0.6)),
            sticky=bool(rng.random() < 0.5),
            felt=float(rng.choice([0.0, 0.1])),
        )

    def surface(self, time: Array, depth: Array, strained: Array) -> Array:
        """The lower face follows only part of what is over the threshold."""
        return strained - 0.6 * self.amplitude * self._slid(strained)

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Sliding layers are a little softer."""
        slid = np.clip(self._slid(depth), 0.0, None) / self.scale.deep
        return -self.felt * self.amplitude * slid * elastic

    def _slid(self, depth: Array) -> Array:
        """(n,) m of depth that is over the threshold."""
        pressed, limit = np.clip(depth, 0.0, None), self.threshold * self.scale.shallow
        if self.sticky:
            return play(pressed, 2.0 * limit, 0.0)
        return np.where(depth > 0.0, smooth_excess(pressed, limit, 0.1 * limit), 0.0)
