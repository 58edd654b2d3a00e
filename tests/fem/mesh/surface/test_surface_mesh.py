import numpy as np
import pytest

from fem.mesh.surface.surface_mesh import mean_ratio, measure_quality, tetrahedron_volume

REGULAR = np.array([[1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, 1.0]])
RIGHT = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])


def test_the_regular_tetrahedron_is_the_best():
    assert mean_ratio(REGULAR[None])[0] == pytest.approx(1.0)
    assert mean_ratio(7.0 * RIGHT[None])[0] == pytest.approx(12 * 0.5 ** (2 / 3) / 9)
    assert mean_ratio(RIGHT[None] * [1.0, 1.0, 1e-9])[0] < 1e-5


def test_volumes_have_a_sign():
    np.testing.assert_allclose(tetrahedron_volume(np.stack((RIGHT, RIGHT[[0, 2, 1, 3]]))), [1 / 6, -1 / 6])


def test_the_report_counts_volume_by_layer():
    points = np.concatenate((RIGHT, [[-1.0, 0.0, 0.0]]))
    quality = measure_quality(points, np.array([[0, 1, 2, 3], [0, 2, 4, 3]]), np.array([1, 0]), 0.5)
    np.testing.assert_allclose(quality.layer_volume, [1 / 6, 1 / 6])
    assert quality.volume_error == pytest.approx(-1 / 3)
    assert str(quality).startswith("2 tetrahedra, mean ratio 0.84")
