"""The edge on a ray, on profiles that are known in closed form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import erf

from bench_hw.vision.markers.edges import find_edges, ray_fan, sample

FAN = ray_fan(10.0, 70.0)


def profiles(edge: np.ndarray, blur: float, ink: float = 35.0, paper: float = 205.0) -> np.ndarray:
    """Grey levels (1, rays, samples) of edges at `edge` (rays,), each blurred by a Gaussian."""
    step = 0.5 * (1 + erf((FAN.radii - edge[:, None]) / (np.sqrt(2) * blur)))
    return (ink + (paper - ink) * step).astype(np.float32)[None]


@given(st.floats(8.5, 11.5), st.floats(0.5, 1.0))
def test_a_blurred_edge_is_where_it_is_whatever_the_blur(place, blur):
    edges = find_edges(profiles(np.full(FAN.directions.shape[1], place), blur), FAN, np.zeros((1, 2)))
    assert edges.there.all()
    assert np.abs(edges.radius - place).max() < 0.01
    assert edges.contrast[0] == pytest.approx(170.0, abs=1.0)


def test_uneven_light_is_seen_and_taken_off():
    """Light that grows by 1 % of itself per pixel to the right: the mid level at the edge is tilted by 12 levels."""
    rays = FAN.directions.shape[1]
    light = 1 + 0.01 * FAN.directions[0][:, None] * FAN.radii
    lit = (profiles(np.full(rays, 10.0), 0.8) * light).astype(np.float32)
    first = find_edges(lit, FAN, np.zeros((1, 2)))
    assert first.tilt[0] == pytest.approx([12.0, 0.0], abs=0.1)
    shift = [
        float((find_edges(lit, FAN, tilt).radius @ FAN.directions.T)[0, 0]) for tilt in (first.tilt * 0, first.tilt)
    ]
    assert abs(shift[1]) < 0.1 * abs(shift[0])


def test_rays_without_ink_without_paper_or_over_strange_paper_have_no_edge():
    rays = FAN.directions.shape[1]
    grey = profiles(np.full(rays, 10.0), 0.8)
    grey[0, 0], grey[0, 1], grey[0, 2] = 205.0, 35.0, np.where(FAN.radii < 10, 35.0, 120.0)
    edges = find_edges(grey, FAN, np.zeros((1, 2)))
    assert edges.there[0, :4].tolist() == [False, False, False, True]
    assert edges.there[0, 3:].all()


def test_a_light_marker_on_a_dark_sheet_has_none():
    grey = profiles(np.full(FAN.directions.shape[1], 10.0), 0.8, ink=205.0, paper=35.0)
    assert not find_edges(grey, FAN, np.zeros((1, 2))).there.any()


def test_samples_lie_between_pixels_and_are_black_outside():
    y, x = np.mgrid[:60, :80]
    ramp = (x + 2 * y).astype(np.uint8)
    values = sample(ramp, np.array([[40.3, 30.6]]), FAN)[0]
    places = np.array([40.3, 30.6])[:, None, None] + FAN.directions[:, :, None] * FAN.radii
    assert np.abs(values - (places[0] + 2 * places[1])).max() < 0.02
    assert sample(ramp, np.array([[-100.0, 30.0]]), FAN).max() == 0.0


@pytest.mark.parametrize(("radius", "spacing"), [(2.6, 12.0), (10.0, 24.0), (10.0, 70.0), (40.0, 200.0)])
def test_rays_stay_clear_of_the_neighbours(radius, spacing):
    fan = ray_fan(radius, spacing)
    assert fan.radii[-1] + radius < spacing or fan.radii[-1] <= radius + 2.5
    assert fan.radii[0] < radius < fan.smooth_radii[-1]
    assert np.allclose(fan.filters.sum(axis=0), 1.0, atol=1e-6)
