"""The manufactured fields themselves; their rates are gated with the other cases."""

import numpy as np
import pytest

from fem.materials.components import AXISYMMETRIC
from fem.materials.deformation import Deformation
from fem.verification.manufactured import bulge, errors, stream


@pytest.mark.parametrize("field", [stream, bulge])
def test_the_gradient_belongs_to_the_displacement(field):
    r, z, h = np.array([0.3, 0.8]), np.array([-0.7, -0.2]), 1e-6
    by_r = (field(r + h, z)[0] - field(r - h, z)[0]) / (2 * h)
    by_z = (field(r, z + h)[0] - field(r, z - h)[0]) / (2 * h)
    u, H = field(r, z)
    np.testing.assert_allclose(H, np.stack((by_r[0], by_z[0], u[0] / r, by_r[1], by_z[1])), atol=1e-9)


def test_neither_field_changes_the_volume():
    r, z = np.meshgrid(np.linspace(0.1, 1, 5), np.linspace(-1, 0, 5))
    np.testing.assert_allclose(Deformation(AXISYMMETRIC, bulge(r, z)[1]).volume_change, 0.0, atol=1e-14)
    np.testing.assert_allclose(stream(r, z)[1][AXISYMMETRIC.normal].sum(axis=0), 0.0, atol=1e-12)


@pytest.mark.parametrize("kinematics", ["linear", "finite"])
def test_errors_fall_from_mesh_to_mesh(kinematics):
    found = [errors(kinematics, 0.499, count) for count in (4, 8, 16)]
    for name in ("displacement", "gradient"):
        coarse, middle, fine = (getattr(each, name) for each in found)
        assert fine < middle < coarse


@pytest.mark.parametrize("kinematics", ["linear", "finite"])
def test_no_locking(kinematics):
    """The error at nu = 0.4999 is the one at 0.45, not a multiple."""
    assert errors(kinematics, 0.4999, 8).displacement < 1.5 * errors(kinematics, 0.45, 8).displacement
