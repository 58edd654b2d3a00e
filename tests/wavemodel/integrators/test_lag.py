import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wavemodel.integrators.lag import lag_step, lagged


def test_creep_under_a_ramp_and_hold_is_the_closed_form():
    eta, ramp = 0.3, 0.5
    time = np.linspace(0.05, 2.0, 40)
    force = np.minimum(time / ramp, 1.0)
    exact = np.where(
        time <= ramp + 1e-12,
        (time - eta * (1 - np.exp(-time / eta))) / ramp,
        1 - eta / ramp * (np.exp(ramp / eta) - 1) * np.exp(-time / eta),
    )
    np.testing.assert_allclose(lagged(np.diff(time, prepend=0.0) / eta, force), exact, rtol=1e-12)


def test_a_step_without_duration_keeps_what_was_there():
    np.testing.assert_allclose(lagged(np.array([0.0, 1.0]), np.array([5.0, 2.0]), last=2.0, start=2.0)[0], 2.0)


def test_goes_on_where_it_stopped():
    rng = np.random.default_rng(3)
    ratio, force = rng.uniform(0, 2, 30), rng.normal(size=30)
    whole = lagged(ratio, force)
    rest = lagged(ratio[12:], force[12:], last=force[11], start=whole[11])
    np.testing.assert_allclose(rest, whole[12:], rtol=1e-12)


@given(st.floats(0.0, 1e12))
def test_coefficients_are_a_mean(ratio):
    step = lag_step(np.array(ratio))
    assert abs(step.keep + step.first + step.last - 1.0) < 1e-15
    assert min(step.keep, step.first, step.last) >= -1e-15
