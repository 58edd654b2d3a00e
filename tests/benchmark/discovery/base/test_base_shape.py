"""What a camera that is not quite told makes of the lower face."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.discovery.base.base_shape import Shape, ShapedTable
from benchmark.physics import LowerFaceMotion
from benchmark.response.elastic_table import ElasticTable, SeparableField

DEPTH, RADIUS = np.linspace(0.0, 4e-3, 50), np.linspace(0.0, 20e-3, 40)
REST = np.array([[0.0, 6e-3], [8e-3, 0.0], [-8e-3, 6e-3], [1e-3, -2e-3]])


@pytest.fixture
def told() -> ShapedTable:
    """A face that sinks most on the axis and moves outwards in proportion to the radius."""
    sink = SeparableField(DEPTH[None], np.exp(-((RADIUS / 9e-3) ** 2))[None])
    out = SeparableField(0.02 * DEPTH[None], (RADIUS / 1e-2)[None])
    return ShapedTable(ElasticTable(DEPTH, 100.0 * DEPTH, RADIUS, out, sink), Shape(), 4e-3)


def _seen(table: ShapedTable, **shape: float) -> tuple[np.ndarray, np.ndarray]:
    depth = np.array([0.0, 1e-3, 3e-3])
    spread = LowerFaceMotion(depth, np.ones(3))
    return replace(table, shape=Shape(**shape)).lower_face(spread, REST)


def test_a_tilted_camera_sees_what_sinks_move_sideways(told: ShapedTable) -> None:
    plain, sunk = _seen(told)
    seen, same = _seen(told, tilt_x=0.02, tilt_y=-0.01)
    np.testing.assert_array_equal(same, sunk)
    np.testing.assert_allclose((seen - plain)[..., 0], 0.02 * sunk, atol=1e-15)
    np.testing.assert_allclose((seen - plain)[..., 1], -0.01 * sunk, atol=1e-15)


def test_an_axis_beside_the_grid_moves_markers_as_if_the_grid_lay_beside_it(told: ShapedTable) -> None:
    reach = np.sqrt(np.max(np.sum(REST**2, axis=1)))
    off = np.array([1e-3, -0.5e-3])
    seen, sunk = _seen(told, centre_x=off[0] / reach, centre_y=off[1] / reach)
    spread = LowerFaceMotion(np.array([0.0, 1e-3, 3e-3]), np.ones(3))
    there, as_deep = told.lower_face(spread, REST - off)
    np.testing.assert_allclose(seen, there + off, atol=1e-15)
    np.testing.assert_allclose(sunk, as_deep, atol=1e-15)


def test_a_lens_distorts_what_moves_and_leaves_the_picture_at_rest(told: ShapedTable) -> None:
    plain, _ = _seen(told)
    seen, _ = _seen(told, lens=0.01)
    np.testing.assert_array_equal(seen[0], plain[0])
    reach = np.max(np.sum(REST**2, axis=1))

    def pictured(places: np.ndarray) -> np.ndarray:
        return places * (1.0 + 0.01 * np.sum(places**2, axis=-1, keepdims=True) / reach)

    np.testing.assert_allclose(seen - seen[0], pictured(plain) - pictured(plain[:1]), atol=1e-15)
