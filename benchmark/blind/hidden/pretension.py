"""A sheet that was stretched before: a stiffness from the first touch that flattens at large slopes.

Its lower face moves more near the tool and less farther out: finite elements of the three sheets under a tension of
1 kPa show a change of 0.45 - r / 28 mm (within 0.03 from 3 to 16 mm) times the tension's share of the force.
"""

from __future__ import annotations

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden

AT_AXIS, FALL = 0.45, 28e-3


class Pretension(Hidden):
    """Force of a tense membrane over the slope at the tool's edge, and what it changes in the lower face's field."""

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
        factor = np.outer(np.ones(depth.size), 1.0 + share * (AT_AXIS - np.hypot(x, y) / FALL))
        return factor, factor
