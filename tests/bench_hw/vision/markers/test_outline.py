"""Area and centroid of polygons."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.vision.markers.edges import Edges, ray_fan
from bench_hw.vision.markers.outline import (
    accept_new_outlines,
    area_centroids,
    compare,
    fan_centroids,
    outline_basis,
    shape_waves,
    shapes,
)

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


FAN = ray_fan(10.0, 70.0)
BASIS = outline_basis(FAN)
ANGLE = np.arctan2(FAN.directions[1], FAN.directions[0])
BEFORE = (10.0 + 0.5 * np.cos(3 * ANGLE + 1))[None]
NOISE, SLACK = np.array([0.05]), np.array([0.03])


def edges(radius: np.ndarray, there: np.ndarray | None = None) -> Edges:
    count = len(radius)
    there = np.ones(radius.shape, dtype=bool) if there is None else there
    numbers = np.ones(count)
    steepest = np.zeros((count, radius.shape[1] // 2))
    tilt = np.zeros((count, 2))
    return Edges(np.where(there, radius, 0.0), there, 170 * numbers, tilt, numbers, 0.05 * numbers, steepest)


@given(st.floats(-0.9, 0.9), st.floats(-0.9, 0.9), st.floats(-0.25, 0.25))
def test_a_marker_that_moved_and_grew_a_little_is_its_own(dx, dy, growth):
    moved = BEFORE + growth + dx * np.cos(ANGLE) + dy * np.sin(ANGLE)
    outlines = compare(edges(moved), BEFORE, BASIS, SLACK, NOISE)
    assert outlines.sound.all()
    assert np.array_equal(outlines.radius, moved)


def test_covered_rays_are_filled_from_the_outline_before():
    moved = BEFORE + 0.4 * np.cos(ANGLE) - 0.2 * np.sin(ANGLE) + 0.1
    there = np.ones(BEFORE.shape, dtype=bool)
    there[0, 5:12] = False
    outlines = compare(edges(moved, there), BEFORE, BASIS, SLACK, NOISE)
    assert not outlines.sound[0, 5:12].any()
    assert 0.7 < outlines.share[0] < 1.0
    assert np.abs(outlines.radius - moved).max() < 0.02


def test_edges_of_something_else_are_not_its_own():
    """A straight edge 8.4 px from the middle cuts off a segment."""
    cut = np.minimum(BEFORE, 8.4 / np.maximum(np.cos(ANGLE), 1e-9))
    outlines = compare(edges(np.where(np.cos(ANGLE) > 0, cut, BEFORE)), BEFORE, BASIS, SLACK, NOISE)
    strayed = np.cos(ANGLE) * BEFORE[0] > 9.0
    assert strayed.sum() > 5
    assert not outlines.sound[0, strayed].any()
    assert outlines.sound[0, np.cos(ANGLE) < 0].all()
    assert np.abs(outlines.radius - BEFORE).max() < 0.25


def test_a_marker_cannot_grow_much_from_one_picture_to_the_next():
    assert not compare(edges(BEFORE * 1.15), BEFORE, BASIS, SLACK, NOISE).sound.any()
    assert compare(edges(BEFORE * 1.15), BEFORE, BASIS, np.array([0.2]), NOISE).sound.all()


def test_if_most_outlines_are_new_they_are_taken_and_if_one_is_it_is_not():
    new = np.repeat(BEFORE, 4, axis=0)
    new[:3] += 1.0 * np.cos(2 * ANGLE + np.arange(3)[:, None])
    before = np.repeat(BEFORE, 4, axis=0)
    slack, noise = np.repeat(SLACK, 4), np.repeat(NOISE, 4)
    judged = compare(edges(new), before, BASIS, slack, noise)
    assert judged.share[:3].max() < 0.9
    assert np.array_equal(accept_new_outlines(edges(new), judged, before, BASIS).radius, new)
    new[1:3] = before[1:3]
    judged = compare(edges(new), before, BASIS, slack, noise)
    assert accept_new_outlines(edges(new), judged, before, BASIS).share[0] == judged.share[0] < 0.9


def test_nothing_seen_is_no_error():
    nothing = edges(BEFORE, np.zeros(BEFORE.shape, dtype=bool))
    outlines = compare(nothing, BEFORE, BASIS, SLACK, NOISE)
    assert outlines.share[0] == 0.0
    assert outlines.radius == pytest.approx(BEFORE)


def test_an_ellipse_has_no_third_harmonic_and_a_cut_disc_has():
    ellipse = 12.0 * 8.0 / np.hypot(8.0 * np.cos(ANGLE - 0.4), 12.0 * np.sin(ANGLE - 0.4))
    cut = np.minimum(10.0, 8.5 / np.maximum(np.cos(ANGLE), 1e-6))
    second, third = shapes(np.stack([ellipse, cut]), shape_waves(BASIS)).T
    assert second[0] == pytest.approx(0.2 * np.exp(0.8j), abs=0.01)
    assert abs(third[0]) < 1e-9
    assert abs(third[1]) > 0.02
