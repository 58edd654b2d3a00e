"""Area and centroid of polygons."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.vision.markers.centroid import area_centroids, fan_centroids

far = st.floats(-1e3, 1e3)


def test_a_triangle_and_a_square():
    x = np.array([[0.0, 3.0, 0.0]])
    y = np.array([[0.0, 0.0, 3.0]])
    centroids, areas = area_centroids(x, y)
    assert np.allclose(centroids, [[1.0, 1.0]])
    assert np.allclose(areas, [4.5])


@given(far, far, st.floats(0.5, 50), st.floats(0.5, 2.0), st.floats(0, 3))
def test_an_ellipse_lies_about_its_middle(x0, y0, radius, longer, turn):
    angle = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    shape = radius * (longer * np.cos(angle) + 1j * np.sin(angle)) * np.exp(1j * turn)
    centroids, areas = area_centroids(x0 + shape.real[None], y0 + shape.imag[None])
    assert np.allclose(centroids, [[x0, y0]], atol=1e-9 * (1 + abs(x0) + abs(y0)))
    assert abs(areas[0] / (np.pi * longer * radius**2) - 1) < 0.002


@given(st.floats(0.5, 50), st.floats(0.0, 0.3), st.floats(0, 6))
def test_on_rays_at_even_angles_it_is_the_same(radius, uneven, turn):
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    rays, directions = radius * (1 + uneven * np.cos(angle + turn))[None], np.stack([np.cos(angle), np.sin(angle)])
    corners = rays[:, None] * directions
    assert np.allclose(fan_centroids(rays, directions), area_centroids(corners[:, 0], corners[:, 1])[0], atol=1e-12)


def test_no_area_no_centroid():
    centroids, areas = area_centroids(np.ones((1, 5)), np.ones((1, 5)))
    assert np.isnan(centroids).all()
    assert areas[0] == 0
