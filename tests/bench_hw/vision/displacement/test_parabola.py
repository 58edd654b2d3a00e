"""Parabolas and r2."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.vision.displacement import fit_parabolas

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
