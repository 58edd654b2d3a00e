"""The simulated pictures: markers where the optics say, to a hundredth of a pixel."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.simulated.picture import CameraModel, Painter, distort, undistort
from bench_hw.simulated.specimen import MarkerGrid

NONE = (0.0, 0.0, 0.0, 0.0, 0.0)


def markers(sunk=0.0):
    rest = MarkerGrid().positions()
    return np.column_stack([rest, np.full(len(rest), sunk)])


def darkness_centroid(picture, near, reach=18):
    x, y = np.rint(near).astype(int)
    window = picture[y - reach : y + reach + 1, x - reach : x + reach + 1].astype(float)
    weight = 205.0 - window
    rows, columns = np.mgrid[y - reach : y + reach + 1, x - reach : x + reach + 1]
    return np.array([(weight * columns).sum(), (weight * rows).sum()]) / weight.sum()


def test_markers_are_where_a_pinhole_puts_them():
    model = CameraModel(distortion=NONE, noise=0.0, lighting=0.0)
    painter = Painter(model, np.random.default_rng(1))
    picture = painter.paint(markers())
    for centre in painter.centres(markers()):
        assert darkness_centroid(picture, centre) == pytest.approx(centre, abs=0.01)
    assert painter.centres(markers())[0] == pytest.approx([319.5 - 20 / 70 * 582, 239.5 - 8 / 70 * 582])


def test_distortion_is_opencvs():
    import cv2

    model = CameraModel()
    matrix = np.array([[582.0, 0, 319.5], [0, 582.0, 239.5], [0, 0, 1]])
    points = np.column_stack([MarkerGrid().positions(), np.full(18, 0.07)])
    projected, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), matrix, np.array(model.distortion))
    painter = Painter(model, np.random.default_rng(1))
    assert painter.centres(markers()) == pytest.approx(projected.reshape(-1, 2), abs=1e-9)


def test_what_sinks_towards_the_camera_looks_larger():
    painter = Painter(CameraModel(distortion=NONE), np.random.default_rng(1))
    flat, sunk = painter.centres(markers()), painter.centres(markers(2e-3))
    centre = np.array([319.5, 239.5])
    assert (sunk - centre) == pytest.approx((flat - centre) * 70 / 68, abs=1e-9)


@given(st.floats(-0.1, 0.1), st.floats(-0.02, 0.02), st.floats(-1e-3, 1e-3), st.floats(-1e-3, 1e-3))
def test_undistort_inverts_distort(k1, k2, p1, p2):
    points = np.stack(np.meshgrid(np.linspace(-0.5, 0.5, 9), np.linspace(-0.4, 0.4, 7)), axis=-1)
    coefficients = (k1, k2, p1, p2, 0.0)
    assert distort(undistort(points, coefficients), coefficients) == pytest.approx(points, abs=1e-9)


def test_a_distortion_that_folds_over_is_refused():
    with pytest.raises(ValueError, match="folds over"):
        Painter(CameraModel(distortion=(-3.0, 0.0, 0.0, 0.0, 0.0)), np.random.default_rng(1))


def test_noise_and_lighting_have_their_stated_size():
    model = CameraModel(noise=4.0, lighting=0.2)
    picture = Painter(model, np.random.default_rng(1)).paint(np.zeros((0, 3))).astype(float)
    assert np.diff(picture, axis=1).std() == pytest.approx(4.0 * np.sqrt(2), rel=0.02)
    assert picture[:, -5:].mean() - picture[:, :5].mean() == pytest.approx(0.2 * 205, rel=0.05)


def test_blur_softens_the_edges():
    def edge(blur):
        picture = Painter(CameraModel(blur=blur, noise=0.0, lighting=0.0), np.random.default_rng(1)).paint(markers())
        return np.abs(np.diff(picture.astype(float), axis=1)).max()

    assert edge(0.3) > 1.5 * edge(1.5)


def test_markers_outside_the_picture_are_simply_not_seen():
    far = np.array([[0.5, 0.5, 0.0]])
    model = CameraModel(noise=0.0, lighting=0.0)
    assert Painter(model, np.random.default_rng(1)).paint(far).min() == 205
