"""A sheet that was stretched before: a stiffness from the first touch that flattens at large slopes.

A tense membrane is steepest at the tool, a plate half-way to the rim; the lower face moves with the slope.
"""

from __future__ import annotations

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden

NEAR, MIDDLE = 6e-3, 12e-3


class Pretension(Hidden):
    """Force of a tense membrane over the slope at the tool's edge, and its share of the lower face's field."""

    slug = "pretension"

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """Extra force."""
        slope = np.clip(depth, 0.0, None) / (2.0 * self.scale.tool_radius)
        steepest = self.scale.deep / (2.0 * self.scale.tool_radius)
        tense: Array = np.sin(np.arctan(slope)) / np.sin(np.arctan(steepest))
        return 0.5 * self.amplitude * self.scale.force * tense

    def grip(self, x: Array, y: Array, depth: Array) -> tuple[Array, Array]:
        """More motion near the tool, less farther out (m), by the membrane's share of the force."""
        share = 0.5 * self.amplitude / (1.0 + 0.5 * self.amplitude)
        steeper = (MIDDLE / np.clip(np.hypot(x, y), NEAR, None)) ** 1.2
        factor = np.outer(np.ones(depth.size), 1.0 + share * (steeper - 1.0))
        return factor, factor
