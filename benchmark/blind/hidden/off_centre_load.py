"""The tool's axis beside the middle of the markers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale
from benchmark.blind.specimens import HOLE_RADIUS


@dataclass(frozen=True, kw_only=True)
class OffCentreLoad(Hidden):
    """The whole field moves to `angle` (rad); nearer to the rim the sheet is a little stiffer."""

    slug = "off_centre_load"
    only_markers = True
    angle: float

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Any direction."""
        return cls(scale=scale, angle=float(rng.uniform(-np.pi, np.pi)))

    @property
    def offset(self) -> float:
        """Of the axis, m."""
        return 5e-3 * self.amplitude

    def centre(self) -> tuple[float, float]:
        """Where the axis is."""
        return self.offset * float(np.cos(self.angle)), self.offset * float(np.sin(self.angle))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Stiffer towards the rim."""
        return 0.8 * (self.offset / HOLE_RADIUS) ** 2 * elastic
