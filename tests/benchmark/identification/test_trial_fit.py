from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmark.identification import FittingError, NoContactError, TrialData, fit_trial, trial_fit
from benchmark.response import ForceCurve


@pytest.mark.parametrize("factor", [0.02, 1.0, 40.0])
@pytest.mark.parametrize(("zero", "onset"), [(0.0, 0.0), (-0.3, 6e-4), (0.2, -3e-4)])
def test_exact_without_noise(trial, factor, zero, onset):
    fit = fit_trial(trial(factor=factor, zero=zero, onset=onset))
    assert fit.stiffness == pytest.approx(factor, rel=1e-6)
    assert fit.zero == pytest.approx(zero, abs=1e-6 * fit.peak)
    assert fit.onset == pytest.approx(onset, abs=1e-8)
    assert fit.residual_percent < 1e-4


def test_exact_where_the_trial_starts_in_contact(trial):
    made = trial(onset=-7e-4)  # the least depth is -0.5 mm: there is always contact
    fit = fit_trial(made)
    assert fit.onset == pytest.approx(-7e-4, abs=1e-8)
    assert fit.zero == pytest.approx(0.01, abs=1e-6)
    assert fit.rest > fit.zero


def test_residual_is_that_of_the_noise(trial):
    fit = fit_trial(trial(noise=0.01, seed=3))
    assert fit.residual_percent == pytest.approx(1.0, rel=0.15)
    assert fit.residual_max > 2 * fit.residual_rms
    assert fit.lag_one < 0.2
    assert set(fit.correlations) == {"log_stiffness, rest", "log_stiffness, onset", "rest, onset"}
    assert fit.correlations["log_stiffness, onset"] > 0.5


def test_standard_errors_match_the_scatter_over_repeats(trial):
    fits = [fit_trial(trial(noise=0.01, rho=0.7, seed=seed)) for seed in range(150)]
    for value, stderr in (("log_stiffness", "log_stiffness_stderr"), ("zero", "zero_stderr")):
        scatter = np.std([getattr(fit, value) for fit in fits])
        assert np.sqrt(np.mean([getattr(fit, stderr) ** 2 for fit in fits])) == pytest.approx(scatter, rel=0.25)


def test_a_fading_force_leaves_the_contact_where_it_is(fading_trial):
    fit = fit_trial(fading_trial(g=0.5, tau=2.0))
    assert fit.time_dependent
    assert fit.contact_from_loading
    assert any("hold" in note for note in fit.notes)
    assert fit.onset == pytest.approx(2e-4, abs=4e-4)
    assert fit.zero == pytest.approx(0.01, abs=0.05 * fit.peak)
    assert 0.5 * 1.7 < fit.stiffness < 1.7
    assert fit.residual_percent > 5.0


def test_a_million_rows_are_averaged_and_said(trial):
    fit = fit_trial(trial(rows=1_000_000, noise=0.02))
    assert fit.stiffness == pytest.approx(1.7, rel=2e-3)
    assert fit.rows_fitted == 2000
    assert "1000000 rows averaged in groups to 2000 for the fit" in fit.notes
    assert fit.residual_percent == pytest.approx(2.0, rel=0.01)  # over all measured rows


@pytest.mark.parametrize("row", [3, 70, 140])
def test_a_bad_sample_does_not_move_the_contact(trial, row):
    made = trial(noise=0.003)
    force = made.force.copy()
    force[row] += 5.0 * force.max()
    fit = fit_trial(replace(made, force=force))
    assert fit.onset_range == pytest.approx(fit_trial(made).onset_range, abs=1e-4)
    assert not fit.time_dependent


def test_no_force_over_the_noise_is_no_contact(trial, ar1):
    made = trial()
    for rho in (0.0, 0.9):
        air = replace(made, force=0.02 * ar1(np.random.default_rng(1), made.rows, rho))
        with pytest.raises(NoContactError, match=r"trial a \(slow\): no force rises with depth over the noise"):
            fit_trial(air)


@pytest.mark.parametrize("rows", [25, 100, 1000])
def test_a_force_by_another_law_is_kept_with_its_misfit(rows):
    time = np.arange(rows) / 10
    depth = np.linspace(-2e-4, 4e-3, rows)
    noise = 5e-3 * np.random.default_rng(rows).normal(size=rows)
    force = 0.3 * np.expm1(1.2e3 * np.maximum(depth, 0.0)) + noise  # 36 N at the peak
    straight = ForceCurve(np.array([1e-3, 9e-3]), np.array([0.3, 2.7]))
    fit = fit_trial(TrialData("a", "slow", time, depth, force, straight))
    assert fit.peak == pytest.approx(36.2, rel=0.1)
    assert fit.residual_percent > 10.0


def test_a_drift_in_the_air_is_no_contact(trial):
    made = trial(noise=0.0)
    air = replace(made, force=0.05 * np.linspace(0.0, 1.0, made.rows) + 1e-3 * np.sin(np.arange(made.rows) ** 2.0))
    with pytest.raises(NoContactError, match="no force rises"):
        fit_trial(air)


def test_press_of_the_wrong_sign_asks_for_it(trial):
    made = trial()
    with pytest.raises(NoContactError, match="press positive"):
        fit_trial(replace(made, force=-made.force))


def test_constant_force_is_no_contact(trial):
    made = trial()
    with pytest.raises(NoContactError, match="no force rises"):
        fit_trial(replace(made, force=np.full(made.rows, 0.5)))


def test_no_motion_is_said(trial):
    made = trial()
    with pytest.raises(NoContactError, match=r"less than 0\.001 mm: no motion"):
        fit_trial(replace(made, depth=np.full(made.rows, 2e-3)))


def test_a_curve_that_ends_early_leaves_rows_out_and_says_so(trial, curve):
    made = trial()
    short = replace(made, curve=ForceCurve(curve.depth[:13], curve.force[:13]))  # to 3.6 of 4.8 mm
    fit = fit_trial(short)
    assert fit.stiffness == pytest.approx(1.7, rel=1e-3)
    assert fit.rows_fitted < made.rows
    assert any("beyond the force curve" in note for note in fit.notes)


def test_peak_and_hold_are_those_of_the_whole_trial(fading_trial, curve):
    made = fading_trial(g=0.5, tau=2.0)
    short = fit_trial(replace(made, curve=ForceCurve(curve.depth[:13], curve.force[:13])))
    assert short.rows_fitted < 60
    assert short.time_dependent
    assert short.peak == pytest.approx(made.force.max() - short.zero)


def test_a_curve_that_is_far_too_short_is_refused(trial, curve):
    made = replace(trial(), curve=ForceCurve(curve.depth[:2] / 3000, curve.force[:2]))
    part = replace(made, depth=made.depth + 5e-4, time=made.time)
    part = replace(part, **{key: getattr(part, key)[8:100] for key in ("time", "depth", "force")})
    with pytest.raises(FittingError, match="the force curve ends at"):
        fit_trial(part)


def test_an_onset_beyond_what_the_data_allow_stays_at_the_bound(trial):
    made = trial()
    steep = replace(made, force=made.force + 3.0 * (made.depth > 4.9e-3))  # no elastic law bends like this
    fit = fit_trial(steep)
    low, high = fit.onset_range
    assert low <= fit.onset <= high
    assert fit.log_stiffness_stderr > 0
    assert fit.onset_at_bound == any("end of the range" in note for note in fit.notes)


@settings(max_examples=25, deadline=None)
@given(st.floats(0.05, 20.0), st.floats(-0.5, 0.5), st.integers(0, 1000))
def test_scaling_the_force_scales_the_stiffness(size, shift, seed):
    depth = np.interp(np.arange(120), [0, 10, 110, 120], [-5e-4, -5e-4, 5e-3, 5e-3])
    points = np.linspace(0, 8e-3, 20)
    curve = ForceCurve(points, 2e5 * points**1.5)
    generator = np.random.default_rng(seed)
    force = curve(depth - 1e-4) + 0.5 * generator.normal(size=120) * 0.02
    one = fit_trial(TrialData("a", "b", np.arange(120.0), depth, force, curve))
    other = fit_trial(TrialData("a", "b", np.arange(120.0), depth, size * (force + shift), curve))
    assert other.stiffness == pytest.approx(size * one.stiffness, rel=1e-4)
    assert other.zero == pytest.approx(size * (one.zero + shift), abs=1e-4 * size)
    assert other.onset == pytest.approx(one.onset, abs=1e-7)


def test_a_long_trial_is_averaged_once(trial, monkeypatch):
    made, calls, average = trial(noise=0.01, seed=3), [], trial_fit.reduced
    rows = np.arange(0.0, made.rows - 1, made.rows / 4100)
    time, depth, force = (np.interp(rows, np.arange(made.rows), each) for each in (made.time, made.depth, made.force))
    monkeypatch.setattr(trial_fit, "reduced", lambda *given: calls.append(given) or average(*given))
    assert fit_trial(replace(made, time=time, depth=depth, force=force)).rows_fitted <= 2000
    assert len(calls) == 1
