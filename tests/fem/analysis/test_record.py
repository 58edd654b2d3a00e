import numpy as np
import pytest

from fem.analysis import record as strain
from fem.assembly.axisymmetric import gauss_geometry
from fem.mesh.quads import build_mesh


def test_one_singular_point_does_not_decide():
    """The largest strain is that of an element's mean."""
    mesh = build_mesh(np.array([0.0, 0.5, 1.0]), np.array([0.0, 1.0]), np.array([0.0]))
    geometry = gauss_geometry(mesh)
    values = np.zeros((5, *geometry.weight.shape))
    values[4, :, 0], values[4, 0, 1] = -0.1, -0.5
    share = geometry.weight[0, 1] / geometry.weight[:, 1].sum()
    assert strain.largest_element_strain(values, geometry) == pytest.approx(max(0.1, 0.5 * share))
