"""Strain measures of element averages, for warnings and reports."""

from __future__ import annotations

import numpy as np

from fem.arrays import FloatArray
from fem.assembly import ElementGeometry


def largest_element_strain(strain: FloatArray, geometry: ElementGeometry) -> float:
    """Largest principal strain of the elements' mean strains.

    Parameters
    ----------
    strain
        Components (components, q, E) at the points of the geometry.
    geometry
        Gauss points with weights.

    Returns
    -------
    float
        Largest absolute value. Means over elements keep the singular edge of a sharp tool from deciding alone.
    """
    weight = geometry.weight / geometry.weight.sum(axis=0)
    return float(geometry.components.largest_principal(np.einsum("kqe,qe->ke", strain, weight)).max())
