"""Strain measures of element averages, for warnings and reports."""

from __future__ import annotations

import numpy as np

from fem.arrays import FloatArray
from fem.assembly import Geometry


def largest_principal(strain: FloatArray) -> FloatArray:
    """Largest principal strain by absolute value, (*points), of components (5, *points)."""
    rr, rz, tt, _, zz = strain
    middle, radius = 0.5 * (rr + zz), np.hypot(0.5 * (rr - zz), rz)
    out: FloatArray = np.maximum(np.abs(middle) + radius, np.abs(tt))
    return out


def largest_element_strain(strain: FloatArray, geometry: Geometry) -> float:
    """Largest principal strain of the elements' mean strains.

    Parameters
    ----------
    strain
        Components (5, q, E) at the points of the geometry.
    geometry
        Gauss points with weights.

    Returns
    -------
    float
        Largest absolute value. Means over elements keep the singular edge of a sharp tool from deciding alone.
    """
    weight = geometry.weight / geometry.weight.sum(axis=0)
    return float(largest_principal(np.einsum("kqe,qe->ke", strain, weight)).max())
