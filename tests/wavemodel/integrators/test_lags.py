import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from wavemodel import Prony
from wavemodel.integrators.lags import LagSum, creep, lag_step, lagged, relaxation, slopes


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


LAW = LagSum(0.5, np.array([0.3, -0.2]), np.array([0.1, 2.0]), rate=0.05)


def test_a_step_comes_at_once_and_then_through_the_lags():
    time = np.array([0.0, 0.05, 1.0, 50.0])
    out, _ = LAW.follow(np.diff(time, prepend=0.0), np.ones(4), LAW.rest(0.0))
    expected = 0.5 + 0.3 * (1 - np.exp(-time / 0.1)) - 0.2 * (1 - np.exp(-time / 2.0))
    np.testing.assert_allclose(out, expected, rtol=1e-12)
    assert LAW.static == pytest.approx(0.6)


def test_a_sum_goes_on_where_it_stopped():
    rng = np.random.default_rng(0)
    durations, values = rng.uniform(0.0, 0.5, 40), rng.normal(size=40)
    whole, _ = LAW.follow(durations, values)
    first, memory = LAW.follow(durations[:17], values[:17])
    second, _ = LAW.follow(durations[17:], values[17:], memory)
    np.testing.assert_allclose(np.concatenate([first, second]), whole, rtol=1e-11, atol=1e-13)


def test_having_been_there_for_ever_is_static():
    out, _ = LAW.follow(np.ones(3), np.full(3, 2.0), LAW.rest(2.0))
    np.testing.assert_allclose(out, 1.2, rtol=1e-13)


def test_a_slope_needs_a_duration():
    np.testing.assert_allclose(slopes(np.array([0.0, 2.0]), np.array([1.0, 2.0]), 0.0), [0.0, 0.5])


SERIES = st.lists(
    st.tuples(st.floats(0.001, 0.3), st.floats(-3.0, 3.0)),
    min_size=1,
    max_size=3,
    unique_by=lambda term: round(term[1], 2),
).map(lambda terms: Prony([g for g, _ in terms], [10.0**t for _, t in terms]))


def dense(series, eta, step, force):
    """Depth by the exponential of x and the branches q: eta x' = F - x + sum g q, tau q' = x - q."""
    g, tau = np.array(series.strength), np.array(series.time)
    if eta:
        matrix = np.block([[np.array([[-1.0]]) / eta, g / eta], [1.0 / tau[:, None], -np.diag(1.0 / tau)]])
        push = np.concatenate([[1.0 / eta], np.zeros(tau.size)])
    else:
        matrix, push = (np.outer(1.0 / tau, g) - np.diag(1.0 / tau)), 1.0 / tau
    d = push.size
    big = np.zeros((d + 2, d + 2))
    big[:d, :d], big[:d, d], big[d, d + 1] = matrix, push, 1.0
    transfer, state, before, out = expm(big * step), np.zeros(d), 0.0, []
    for value in force:
        state, before = (transfer @ np.concatenate([state, [before, (value - before) / step]]))[:d], value
        out.append(state[0] if eta else value + g @ state)
    return np.array(out)


@pytest.mark.parametrize("eta", [0.0, 0.02])
@pytest.mark.parametrize("series", [Prony((0.3,), (0.5,)), Prony((0.2, 0.35), (0.07, 3.0)), Prony((0.9,), (0.2,))])
def test_creep_equals_a_dense_solution(series, eta):
    force = np.random.default_rng(1).normal(size=60)
    found, _ = creep(series, eta).follow(np.full(60, 0.1), force)
    np.testing.assert_allclose(found, dense(series, eta, 0.1, force), rtol=1e-10, atol=1e-11)


def test_one_term_creeps_and_relaxes_by_its_closed_forms():
    """After a step: G = 1 - g (1 - e^-t/tau); J = 1/(1-g) - g/(1-g) e^(-t (1-g)/tau)."""
    g, tau = 0.4, 0.7
    time = np.linspace(0.1, 5.0, 30)
    durations, ones = np.diff(time, prepend=0.1), np.ones(30)
    relaxed, _ = relaxation(Prony((g,), (tau,))).follow(durations, ones)
    crept, _ = creep(Prony((g,), (tau,))).follow(durations, ones)
    np.testing.assert_allclose(relaxed, 1 - g * (1 - np.exp(-(time - 0.1) / tau)), rtol=1e-12)
    np.testing.assert_allclose(crept, 1 / (1 - g) - g / (1 - g) * np.exp(-(time - 0.1) * (1 - g) / tau), rtol=1e-12)


@settings(deadline=None)
@given(SERIES, st.sampled_from([0.0, 1e-4, 0.3]))
def test_creep_undoes_relaxation(series, eta):
    """Their transforms multiply to one at every rate, and what is left in the end is the static answer."""
    forth, back = relaxation(series, eta), creep(series, eta)
    for s in np.geomspace(1e-5, 1e5, 21):
        there = forth.instant + forth.rate * s + (forth.weight / (1 + s * forth.time)).sum()
        again = back.instant + (back.weight / (1 + s * back.time)).sum()
        assert there * again == pytest.approx(1.0, rel=1e-10)
    assert back.static == pytest.approx(1.0 / series.long_term, rel=1e-10)
    assert np.all(back.weight > 0.0)


def test_nothing_fades_without_a_series():
    values = np.array([1.0, -2.0])
    for law in (creep(Prony()), relaxation(Prony())):
        np.testing.assert_array_equal(law.follow(np.ones(2), values)[0], values)
