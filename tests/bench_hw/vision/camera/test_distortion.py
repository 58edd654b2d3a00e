"""The distortion forwards, against OpenCV and against its own derivative."""

import cv2
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from bench_hw.vision.camera.distortion import distort, jacobian, undistort, undistort_near

small = st.floats(-0.5, 0.5)
lens = st.tuples(small, small, st.floats(-0.02, 0.02), st.floats(-0.02, 0.02), small)
point = st.tuples(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6)).map(np.array)


@given(lens, point)
def test_it_is_opencvs_distortion(coefficients, at):
    projected, _ = cv2.projectPoints(
        np.array([[*at, 1.0]]), np.zeros(3), np.zeros(3), np.eye(3), np.array(coefficients)
    )
    assert np.allclose(distort(at, coefficients), projected.ravel(), atol=1e-12)


@given(lens, point)
def test_the_jacobian_is_the_derivative(coefficients, at):
    step = 1e-6
    x, y = (
        (distort(at + step * axis, coefficients) - distort(at - step * axis, coefficients)) / (2 * step)
        for axis in np.eye(2)
    )
    slope = jacobian(at, coefficients)
    assert np.allclose([slope.xx, slope.xy, slope.xy, slope.yy], [x[0], x[1], y[0], y[1]], atol=1e-7)
    assert np.isclose(slope.determinant, x[0] * y[1] - x[1] * y[0], atol=1e-6)


PAPER = (0.07, -0.48, -0.01, -0.01, 0.0)
mild = st.floats(-0.4, 0.4)
mild_lens = st.tuples(mild, mild, st.floats(-0.01, 0.01), st.floats(-0.01, 0.01), st.floats(-0.1, 0.1))


@given(mild_lens, st.tuples(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6)).map(np.array))
def test_it_gives_back_what_was_distorted_on_the_near_side(coefficients, point):
    way = np.linspace(0.0, 1.0, 200)[:, None] * point
    assume(jacobian(way, coefficients).determinant.min() > 1e-3)
    assert np.allclose(undistort(distort(point, coefficients), coefficients), point, atol=1e-8)


@given(mild_lens, st.tuples(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5)).map(np.array))
def test_what_it_gives_is_an_inverse_or_nothing(coefficients, seen):
    found = undistort(seen, coefficients)
    if np.isfinite(found).all():
        assert np.allclose(distort(found, coefficients), seen, atol=1e-11)
        assert jacobian(found, coefficients).determinant > 0
    else:
        assert np.isnan(found).all()


def test_beyond_the_fold_there_is_nothing():
    """With k1 = 0, k2 = -0.48 a radius of 0.803 is seen at 0.643 and no radius is seen farther out."""
    fold = (1 / (5 * 0.48)) ** 0.25
    seen = fold * (1 - 0.48 * fold**4)
    coefficients = (0.0, -0.48, 0.0, 0.0, 0.0)
    assert np.isnan(undistort(np.array([seen * 1.001, 0.0]), coefficients)).all()
    assert undistort(np.array([seen * 0.999, 0.0]), coefficients)[0] == pytest.approx(fold, abs=0.03)
    assert undistort(np.array([seen * 0.999, 0.0]), coefficients)[0] < fold


def test_shapes_and_missing_points_are_kept():
    points = np.full((2, 3, 2), 0.1)
    points[0, 0] = np.nan
    found = undistort(points, PAPER)
    assert found.shape == (2, 3, 2)
    assert np.isnan(found[0, 0]).all()
    assert np.isfinite(found[1]).all()
    assert undistort(np.zeros((0, 2)), PAPER).shape == (0, 2)


def test_near_a_known_inverse_a_few_steps_are_enough():
    points = np.random.default_rng(1).uniform(-0.35, 0.35, (200, 2))
    found = undistort_near(distort(points, PAPER), PAPER, points + 0.01, steps=3)
    assert np.abs(found - points).max() < 1e-9
    assert np.isnan(undistort_near(np.array([[0.9, 0.0]]), PAPER, np.array([[0.2, 0.0]]))).all()


def test_opencvs_default_inverse_is_off_in_the_corners_where_this_one_is_not():
    """At f = 620 px the five default steps err by more than a pixel in the corners of 640 x 480."""
    matrix = np.array([[620.0, 0, 319.5], [0, 620.0, 239.5], [0, 0, 1]])
    corners = np.array([[0.0, 0.0], [639, 0], [0, 479], [639, 479]])
    seen = (corners - matrix[:2, 2]) / 620.0
    theirs = cv2.undistortPoints(corners.reshape(-1, 1, 2), matrix, np.array(PAPER)).reshape(-1, 2)
    there = np.isfinite(undistort(seen, PAPER)).all(axis=1)
    assert there.sum() >= 3
    assert np.abs(distort(theirs, PAPER) - seen)[there].max() * 620 > 0.5
    assert np.abs(distort(undistort(seen[there], PAPER), PAPER) - seen[there]).max() * 620 < 1e-8
