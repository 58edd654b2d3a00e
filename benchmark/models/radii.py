"""Where profiles are sampled."""

from __future__ import annotations

import numpy as np

from benchmark.models.result import Array

REACH = 5.0
PER_RADIUS = 10


def profile_radii(tool_radius: float) -> Array:
    """Radii (m,) in m from the axis to five tool radii, ten to a radius, the tool's edge among them."""
    return np.asarray(tool_radius / PER_RADIUS * np.arange(int(REACH * PER_RADIUS) + 1), dtype=np.float64)
