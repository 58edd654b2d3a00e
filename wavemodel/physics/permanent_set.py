"""Permanent set: the surface does not come back, and later cycles meet it later."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.physics.course import Memory, require


@dataclass(frozen=True)
class PermanentSet:
    """Below the deepest depth d_m so far the surface stands at s = fraction max(d_m - onset, 0).

    What the tool meets is d_c = (d - s) d_m / (d_m - s): the first loading is the base law, unloading starts from its
    peak and ends at s, and reloading follows it back (elastic unloading of an elastic-plastic body, with the recovery
    of W. C. Oliver and G. M. Pharr 1992, J Mater Res 7:1564, scaled instead of shifted).

    Attributes
    ----------
    fraction
        0 to 0.95; zero: off.
    onset
        Depth that leaves no set, m, 0 to 10.
    """

    fraction: float
    onset: float = 0.0

    def __post_init__(self) -> None:
        require("permanent set", "fraction", self.fraction, "", 0.0, 0.95)
        require("permanent set", "onset", self.onset, "m", 0.0, 10.0)

    def meet(self, depth: FloatArray, memory: Memory) -> tuple[FloatArray, FloatArray, Memory]:
        """Depth below the surface (n,) that the tool (n,) meets, the surface (n,), m, and the memory."""
        deepest = np.maximum.accumulate(np.maximum(depth, memory[0] if memory else 0.0))
        surface = self.fraction * np.maximum(deepest - self.onset, 0.0)
        scale = np.divide(deepest, deepest - surface, out=np.ones_like(depth), where=deepest > 0.0)
        return (depth - surface) * scale, surface, (float(deepest[-1]),)
