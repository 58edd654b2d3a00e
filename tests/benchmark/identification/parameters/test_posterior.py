import logging
import warnings
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.experiments.parameters_answer import ParametersAnswer
from benchmark.identification.parameters.posterior import Posterior, _Density, posterior, split_r_hat


def test_r_hat_tells_chains_that_mixed_from_chains_that_did_not() -> None:
    chains = np.random.default_rng(1).normal(size=(400, 8, 2))
    apart = chains + np.array([0.0, 3.0]) * np.arange(8)[:, None]
    assert split_r_hat(chains) == pytest.approx([1.0, 1.0], abs=0.01)
    assert split_r_hat(apart)[1] > 2.0


def test_the_density_falls_from_the_fit_as_its_covariance_says(toy_fit) -> None:
    found = toy_fit()
    density = _Density(found)
    count = len(found.problem.parameters)
    covariance = found.fit.covariance[:count, :count]
    middle, spread = density.start[:-1], np.sqrt(np.diag(covariance))
    values, vectors = np.linalg.eigh(covariance / np.outer(spread, spread))
    step = spread * vectors[:, -1] * np.sqrt(values[-1])
    assert middle == pytest.approx(found.vector[:count])
    fall = [density(density.start) - density(density.start + sign * np.append(step, 0.0)) for sign in (-1.0, 1.0)]
    assert np.mean(fall) == pytest.approx(0.5, rel=0.1)
    assert density(density.start + 100.0) == -np.inf


def test_the_scatter_is_as_likely_as_the_gains_say(toy_fit) -> None:
    """Gains of trials that tell them sharply: flat in the scatter, its logarithm has the density of R - 1 gains."""
    found = toy_fit(noise=1e-4)
    density, gains = _Density(found), found.fit.nuisance[:, 2]
    density._error_normal = density._error_normal + 1e12 * np.eye(len(density._error_normal))  # the model is exact
    at = [np.append(found.vector[:3], np.log(scatter)) for scatter in (0.01, 0.02)]
    want = -0.5 * np.sum(gains**2) * (0.02**-2 - 0.01**-2) - (gains.size - 1) * np.log(2.0)
    assert density(at[1]) - density(at[0]) == pytest.approx(want, rel=0.1)


def test_short_chains_are_told_of_once_in_our_words() -> None:
    chains, one = np.zeros((2400, 4, 2)), np.ones(2)
    drawn = Posterior(chains, one, one, one, one, np.array([20.0, 61.0]))
    answer = ParametersAnswer(SimpleNamespace(warnings=()), posterior=drawn)
    assert [each for each in answer.warnings if "2400 steps are shorter than 50 times" in each] == list(answer.warnings)
    assert "autocorrelation time of 61 steps" in drawn.short
    assert Posterior(chains, one, one, one, one, np.array([20.0, 48.0])).short == ""


def test_the_sampler_says_nothing_of_its_own(toy_fit, monkeypatch, caplog) -> None:
    pytest.importorskip("emcee", reason="emcee is optional: pip install tissuebench[posterior]")
    monkeypatch.setattr("benchmark.identification.parameters.posterior.STEPS", 700)
    with warnings.catch_warnings(), caplog.at_level(logging.WARNING):
        warnings.simplefilter("error")
        drawn = posterior(toy_fit(), 1)
    assert drawn.short
    assert not caplog.records


@pytest.mark.slow
def test_posterior_and_profile_agree(toy_fit) -> None:
    pytest.importorskip("emcee", reason="emcee is optional: pip install tissuebench[posterior]")
    found = toy_fit()
    drawn = posterior(found, 1)
    assert drawn.converged
    assert drawn.effective.min() > 400
    spread = np.sqrt(np.diag(found.fit.covariance))[list(found.problem.free)]
    quantiles = [found.quantile_of(k) for k in found.problem.free]
    assert (drawn.high - drawn.low) / (2.0 * np.array(quantiles) * spread) == pytest.approx(1.0, abs=0.15)
