"""Parabolas and r2."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.errors import InputError
from bench_hw.vision.displacement import fit_circles, fit_parabolas, inner_nine
from bench_hw.vision.displacement.fits import largest_sample, maximum_radius, sample_noise

number = st.floats(-10, 10)


@given(number, number, number, st.floats(0.01, 10), st.floats(-100, 100))
def test_a_parabola_is_found_again(a, b, c, step, start):
    t = start + step * np.arange(30)
    s = t - start
    fits = fit_parabolas(t, np.stack([a * s**2 + b * s + c, s], axis=1))
    scale = 1 + np.abs([a, b, c]).max() * (1 + s.max()) ** 2
    again = fits.a[0] * t**2 + fits.b[0] * t + fits.c[0]
    assert np.allclose(again, a * s**2 + b * s + c, atol=1e-7 * scale * (1 + abs(start)) ** 2)
    assert fits.r2[1] == pytest.approx(1.0)


def test_r2_is_the_share_of_the_variance_that_is_explained():
    random = np.random.default_rng(0)
    t = np.linspace(-1, 1, 5000)
    noisy = t**2 + random.normal(0, np.std(t**2), len(t))
    assert fit_parabolas(t, noisy).r2 == pytest.approx(0.5, abs=0.03)


def test_gaps_are_left_out_and_too_few_or_constant_values_say_nothing():
    t = np.arange(10.0)
    values = np.stack([t**2, t**2, np.ones(10)], axis=1)
    values[3, 0] = np.nan
    values[:7, 1] = np.nan
    fits = fit_parabolas(t, values)
    assert fits.a[0] == pytest.approx(1.0)
    assert fits.count.tolist() == [9, 3, 10]
    assert np.isnan([fits.a[1], fits.r2[1]]).all()
    assert np.isnan(fits.r2[2])
    assert fits.c[2] == pytest.approx(1.0)
    assert fit_parabolas(t, np.zeros((10, 4, 2))).a.shape == (4, 2)


GRID = np.stack(np.meshgrid(np.arange(6.0) - 2.5, np.arange(3.0) - 1.0), axis=-1).reshape(-1, 2) * 8e-3


@given(st.floats(-50, 50), st.floats(-50, 50), st.floats(0.1, 30), st.integers(3, 12))
def test_points_on_a_circle_give_that_circle(x, y, radius, count):
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False) + 0.3
    points = np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)
    circles = fit_circles(np.stack([points, 2 * points]))
    assert np.allclose(circles.centre, [[x, y], [2 * x, 2 * y]], atol=1e-6)
    assert np.allclose(circles.radius, [radius, 2 * radius], rtol=1e-6)


def test_through_all_nine_the_circle_is_5_7_percent_smaller_than_through_the_ring():
    block = inner_nine(GRID, 3, 6)
    nine, ring = (fit_circles(GRID[None, markers]).radius[0] for markers in (block.nine, block.ring))
    assert ring == pytest.approx(np.sqrt(1.5) * 8e-3)
    assert nine / ring - 1 == pytest.approx(-0.057, abs=0.0003)


def test_a_missing_point_leaves_no_circle():
    points = np.random.default_rng(0).normal(size=(4, 9, 2))
    points[2, 5, 0] = np.nan
    assert np.isnan(fit_circles(points).radius).tolist() == [False, False, True, False]
    assert np.isnan(fit_circles(points).centre[2]).all()
    assert fit_circles(np.full((2, 9, 2), np.nan)).radius.shape == (2,)


def test_the_block_is_the_one_nearest_the_axis_and_ties_go_left():
    block = inner_nine(GRID, 3, 6)
    assert block.centre == 8
    assert block.nine.tolist() == [1, 2, 3, 7, 8, 9, 13, 14, 15]
    assert block.ring.tolist() == [1, 2, 3, 7, 9, 13, 14, 15]
    assert inner_nine(GRID - np.array([10e-3, 0]), 3, 6).centre == 10
    assert inner_nine(GRID, 3, 6, centre=9).nine[4] == 9


def test_what_is_no_block_is_refused():
    with pytest.raises(InputError, match=r"centre marker 6: allowed are .*\[7, 8, 9, 10\]"):
        inner_nine(GRID, 3, 6, centre=6)
    with pytest.raises(InputError, match="at least 3 x 3"):
        inner_nine(GRID, 2, 9)
    with pytest.raises(InputError, match="none of the inner markers"):
        inner_nine(np.full((18, 2), np.nan), 3, 6)


TIME = np.arange(300) / 30
NOISE = 0.003
SHAPES = {
    "parabola": 1 - ((TIME - 5) / 5) ** 2,
    "sine": np.sin(np.pi * TIME / 10) ** 2,
    "triangle": 1 - np.abs(TIME - 5) / 5,
    "hold": np.clip(2 - np.abs(TIME - 5) / 2, 0, 1),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_it_is_right_to_a_hundredth_of_a_pixel(shape):
    """The radius grows by 10 px; a sample's error is 0.003 px, what eight markers at 0.0085 px an axis leave."""
    truth = 100 + 10 * SHAPES[shape]
    random = np.random.default_rng(0)
    errors = [maximum_radius(TIME, truth + random.normal(0, NOISE, 300)).radius - truth.max() for _ in range(60)]
    assert np.sqrt(np.mean(np.square(errors))) < 0.006
    assert np.mean(np.abs(errors) < 0.01) >= 0.95


def test_it_does_not_grow_with_the_length_of_a_hold_as_the_largest_sample_does():
    truth = 100 + 10 * SHAPES["hold"]
    random = np.random.default_rng(1)
    noisy = [truth + random.normal(0, NOISE, 300) for _ in range(40)]
    samples, fits = (np.mean([find(TIME, r).radius - 110 for r in noisy]) for find in (largest_sample, maximum_radius))
    assert samples > 1.5 * NOISE
    assert abs(fits) < 0.5 * samples


def test_time_and_frame_are_those_of_the_peak():
    found = maximum_radius(TIME, 100 + 10 * SHAPES["parabola"], noise=0.001)
    assert found.time == pytest.approx(5.0, abs=0.02)
    assert found.frame == 150
    assert 0 <= found.std < 0.001


def test_gaps_are_no_maximum_and_nothing_is_refused():
    radius = 100 + 10 * SHAPES["parabola"]
    radius[140:160] = np.nan
    assert maximum_radius(TIME, radius).radius < 110.05
    with pytest.raises(InputError, match="no frame has a circle"):
        largest_sample(TIME, np.full(300, np.nan))
    assert maximum_radius(TIME[:3], np.array([1.0, 3.0, 2.0])).radius == 3.0


def test_noise_is_estimated_from_the_samples():
    random = np.random.default_rng(2)
    assert sample_noise(SHAPES["sine"] * 10 + random.normal(0, NOISE, 300)) == pytest.approx(NOISE, rel=0.2)
    assert sample_noise(np.ones(2)) == 0.0
