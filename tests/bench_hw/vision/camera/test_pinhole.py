"""Undistorted points to metres on the marker plane, with and without perspective."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.errors import InputError
from bench_hw.vision.camera import Camera, Plane, from_plane, survey_domain, to_plane
from bench_hw.vision.camera.pinhole import distance_of, invertible

FX = 600.0
CAMERA = Camera((640, 480), (FX, 610.0), (320.0, 240.0), (0.0,) * 5, Plane(0.070 / FX, 0.0, (350.0, 230.0)))


def test_the_formula_of_the_camera_file():
    """x = mm_per_px fx (xn - xn0), y = mm_per_px fx (yn - yn0): fx for both, the plane is at mm_per_px fx."""
    point = np.array([0.1, -0.2])
    x0, y0 = 30.0 / FX, -10.0 / 610.0
    assert np.allclose(to_plane(CAMERA, point), [0.070 * (0.1 - x0), 0.070 * (-0.2 - y0)])
    assert distance_of(CAMERA) == pytest.approx(0.070)


places = st.tuples(st.floats(-0.03, 0.03), st.floats(-0.03, 0.03)).map(np.array)


@given(places, st.floats(-0.02, 0.05))
def test_there_and_back(place, sunk):
    assert np.allclose(to_plane(CAMERA, from_plane(CAMERA, place, sunk), sunk), place, atol=1e-15)


def test_perspective_is_as_large_as_the_motion():
    """At r = 10 mm a marker that has sunk by 2 mm 70 mm before the camera seems to lie 0.29 mm farther out."""
    straight = Camera((640, 480), (FX, FX), (320.0, 240.0), (0.0,) * 5, Plane(0.070 / FX, 0.0, (320.0, 240.0)))
    seen = from_plane(straight, np.array([0.010, 0.0]), 0.002)
    assert to_plane(straight, seen)[0] - 0.010 == pytest.approx(0.29e-3, abs=0.005e-3)
    assert to_plane(straight, seen, 0.002)[0] == pytest.approx(0.010, abs=1e-15)


def test_each_marker_has_its_own_depth_and_unknown_ones_no_place():
    points = np.full((3, 2), 0.1)
    found = to_plane(CAMERA, points, np.array([0.0, 0.01, np.nan]))
    assert found[0, 0] != found[1, 0]
    assert np.isnan(found[2]).all()


def test_no_scale_and_impossible_depths_are_refused():
    bare = Camera((640, 480), (FX, FX), (320.0, 240.0), (0.0,) * 5)
    with pytest.raises(InputError, match="no mm_per_px"):
        to_plane(bare, np.zeros(2))
    with pytest.raises(InputError, match=r"sunk by 80 mm.*less than the camera's distance, 70 mm"):
        to_plane(CAMERA, np.zeros(2), 0.08)


PAPER = (0.07, -0.48, -0.01, -0.01, 0.0)


def camera(focal: float, distortion=PAPER) -> Camera:
    return Camera((640, 480), (focal, focal), (319.5, 239.5), distortion)


@pytest.mark.parametrize("focal", [540.0, 582.0, 610.0])
def test_the_papers_distortion_folds_over_in_the_corners_up_to_610_px(focal):
    domain = survey_domain(camera(focal))
    assert not domain.whole
    assert 0.95 < domain.fraction < 1.0
    assert 320 < domain.nearest < 400
    assert "no inverse" in str(domain)


def test_longer_lenses_and_no_distortion_have_the_whole_picture():
    for whole in (camera(640.0), camera(300.0, (0.0,) * 5), camera(582.0, (0.07, 0.0, 0.0, 0.0, 0.0))):
        domain = survey_domain(whole)
        assert (domain.whole, domain.nearest) == (True, np.inf)
        assert "whole picture" in str(domain)


def test_pixels_are_told_apart():
    pixels = np.array([[319.5, 239.5], [0.0, 0.0]])
    assert invertible(camera(560.0), pixels).tolist() == [True, False]
