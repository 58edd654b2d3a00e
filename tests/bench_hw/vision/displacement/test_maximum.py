"""The largest radius."""

import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.vision.displacement.maximum import largest_sample, maximum_radius, sample_noise

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
