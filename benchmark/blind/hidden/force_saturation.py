"""Readings that stop at a limit, by a rounded corner."""

from __future__ import annotations

from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden

ROUNDNESS = 12.0


class ForceSaturation(Hidden):
    """F / (1 + (F / L)^p)^(1/p) with a high p."""

    slug = "force_saturation"
    largest = 5.0

    def in_trial(self, rng: np.random.Generator) -> Self:
        """A sensor's range is the same in all trials."""
        return self

    def reading(self, time: Array, depth: Array, force: Array) -> Array:
        """Force up to the limit."""
        over = self.amplitude * abs(force) / self.scale.force
        return force / (1.0 + over**ROUNDNESS) ** (1.0 / ROUNDNESS)
