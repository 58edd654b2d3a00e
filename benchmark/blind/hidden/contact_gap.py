"""Free travel before contact, which ends in a soft toe instead of a corner."""

from __future__ import annotations

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden


class ContactGap(Hidden):
    """Travel is lost up to the gap, and less and less of it on the way there."""

    slug = "contact_gap"
    largest = 2.0

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """Depth less what the gap has taken."""
        gap = 0.4 * self.amplitude * self.scale.shallow
        if gap == 0.0:
            return depth
        lost = gap * (1.0 - np.exp(-((np.clip(depth, 0.0, None) / (0.6 * gap)) ** 2)))
        return np.where(depth > 0.0, np.clip(depth - lost, 0.0, None), depth)
