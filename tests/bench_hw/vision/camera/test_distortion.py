"""The distortion forwards, against OpenCV and against its own derivative."""

import cv2
import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.vision.camera.distortion import distort, jacobian

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
