"""A pinhole camera below the sheet: what comes nearer looks larger."""

from __future__ import annotations

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden


class Perspective(Hidden):
    """D / (D - w) with the camera D below the lower face."""

    slug = "perspective"
    only_markers = True
    largest = 3.0

    def sight(self, x: Array, y: Array, sinking: Array) -> tuple[Array, Array]:
        """Seen positions."""
        nearness = self.amplitude / 50e-3
        factor = 1.0 / (1.0 - nearness * sinking)
        return x * factor, y * factor
