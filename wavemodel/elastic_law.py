"""The elastic law of a tool on a stack, force over depth: linear, or corrected for a large press."""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.large_press.law import LargePress


@dataclass(frozen=True)
class ElasticLaw:
    """Depth and force of the elastic body, each from the other.

    Attributes
    ----------
    compliance
        Initial depth per force, m/N.
    large
        Correction of a large press, or None.
    """

    compliance: float
    large: LargePress | None = None

    def __call__(self, depth: FloatArray) -> FloatArray:
        """(...) force at depths (...), N.

        Raises
        ------
        WaveError
            If a depth is beyond the range of the correction.
        """
        depth = np.asarray(depth, dtype=np.float64)
        return depth / self.compliance if self.large is None else self.large.force_at(depth)

    def depth_at(self, force: FloatArray) -> FloatArray:
        """(...) depth under forces (...), m."""
        force = np.asarray(force, dtype=np.float64)
        return force * self.compliance if self.large is None else self.large.depth_at(force)
