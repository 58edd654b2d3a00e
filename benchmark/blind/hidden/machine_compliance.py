"""A rig in series with the specimen that gives way at once and then less."""

from __future__ import annotations

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden


class MachineCompliance(Hidden):
    """Lost depth c F + c2 F^2 / (1 + F / F0)."""

    slug = "machine_compliance"
    only_markers = True  # in series with a linear specimen its force is a gain, and nobody can see it
    gives_way = True
    largest = 2.0

    def travel(self, time: Array, depth: Array, force: Array) -> Array:
        """Depth less what the rig has given way."""
        load = force / self.scale.force
        return depth - 0.15 * self.amplitude * self.scale.deep * (0.6 * load + 0.8 * load**2 / (1.0 + abs(load)))
