"""Consolidation by the full series, with a contact that a domed tool widens with depth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale
from benchmark.blind.hidden.tools import lost_memory

MODES = np.arange(1.0, 9.0)


@dataclass(frozen=True, kw_only=True)
class PoroelasticDrainage(Hidden):
    """`time` s of the slowest mode at full contact; mode n is n^2 faster and n^2 smaller."""

    slug = "poroelastic_drainage"
    time: float

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Two to ten seconds."""
        return cls(scale=scale, time=float(np.exp(rng.uniform(np.log(2.0), np.log(10.0)))))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """What has drained is missing."""
        contact = 0.1 + 0.9 * np.clip(depth, 0.0, None) / self.scale.deep  # radius squared, of the largest
        rates = MODES**2 / (self.time * contact[:, None])
        shares = MODES**-2 / (MODES**-2).sum()
        drained: Array = lost_memory(time, elastic, rates) @ shares
        return -0.5 * self.amplitude * drained
