"""Intervals of a specimen whose force is no product of powers: those of the model, not of its slope at the estimate."""

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy

from benchmark.identification.parameters.law_shapes import shear_modulus
from benchmark.identification.parameters.layer_fit import begun, fit_layers
from benchmark.identification.parameters.presses import press_surrogate
from benchmark.identification.parameters.profile_likelihood import profile, verified_profiles
from benchmark.response.differentiated_ramp import DifferentiatedRamp, RampDerivative
from benchmark.response.least_squares import least_squares

TRIALS, SCATTER = 6, 1.2e-2


def series_ramp(session, tissue, tool, support, depth, keys, model="fem", steps=24, *, judge_mesh=False):
    """Layers in series, whose shares shift with depth: the force is bounded by each of them."""
    levels = np.linspace(0.0, depth, steps + 1)
    deep = levels / tool.radius
    shares = np.stack([0.5 * np.exp(-6.0 * deep), 0.3 + 0.0 * deep, 0.1 + 2.0 * deep**2])
    soft = shares / np.array([3.0 * shear_modulus(one) for one in tissue.layers])[:, None]
    force = 4.0 * tool.radius * levels / soft.sum(axis=0)
    parts = zip(tissue.layers, soft / soft.sum(axis=0), strict=True)
    by = {f"{one.name}.stiffness": RampDerivative(part * force) for one, part in parts}
    return DifferentiatedRamp(
        levels, force, None, {key: by[key] for key in keys}, mesh_error=0.0 if judge_mesh else None
    )


@pytest.fixture
def found(toy, monkeypatch):
    """A fit to trials of that specimen under one tool."""
    monkeypatch.setattr(press_surrogate, "differentiated_ramp", series_ramp)
    problem = toy(tools=(0,), trials=TRIALS)
    press = problem.presses[0]
    ramp = series_ramp(None, *press.setup, press.depth, ())
    generator = np.random.default_rng(3)

    def pressed(trial):
        force = np.interp(np.maximum(trial.data.depth, 0.0), ramp.depth, ramp.force)
        noisy = force * np.exp(SCATTER * generator.normal()) + SCATTER * force.max() * generator.normal(size=force.size)
        return replace(trial, data=replace(trial.data, force=noisy))

    problem = replace(problem, trials=tuple(pressed(one) for one in problem.trials), trust=3e-3, discrepancy=2e-3)
    return fit_layers(begun(problem, np.zeros(TRIALS), np.zeros(TRIALS)))


def rise_of_the_model(found, index, value):
    """-2 log of the likelihood ratio with a coordinate held, pressed anew until model and table agree."""
    one = found.problem.parameters[index]
    told = one.value(value)
    held = replace(one, start=told, low=told * (1.0 - 1e-9), high=told * (1.0 + 1e-9))
    parameters = tuple(held if k == index else each for k, each in enumerate(found.problem.parameters))
    vector = found.vector.copy()
    vector[index] = value
    problem = replace(found.problem, parameters=parameters)
    other = fit_layers(replace(found, problem=problem, fit=replace(found.fit, vector=vector)), rounds=8)
    assert other.settled
    own = found.model
    told = own.prior_precision * np.isin(np.arange(own.prior_mean.size), found.problem.free, invert=True)
    prior = {"prior_mean": own.prior_mean, "prior_precision": told}
    model = replace(other.model, white=own.white, noise=own.noise, gain_deviation=own.gain_deviation, **prior)
    again = least_squares(model.fixed_at(index, value), other.vector, other.fit.nuisance)
    steadied = (own.prior_precision - told) @ (found.vector - own.prior_mean) ** 2
    return 2.0 * again.objective - (2.0 * found.fit.objective - steadied)


def test_ends_are_where_the_models_own_likelihood_has_fallen_as_far(found) -> None:
    richer, others, profiles = verified_profiles(found)
    assert others == ()
    checked = 0
    for index, own in zip(found.problem.free, profiles, strict=True):
        for end in (own.low, own.high):
            if math.isfinite(end) and abs(end - found.vector[index]) > 0.1:
                assert rise_of_the_model(richer, index, end) == pytest.approx(found.quantile_of(index) ** 2, rel=0.15)
                checked += 1
    assert checked >= 2


def test_the_slope_at_the_estimate_alone_is_not_enough(found) -> None:
    """This specimen parts both: otherwise the test above could not fail."""
    _, _, verified = verified_profiles(found)
    plain = [profile(found, k) for k in found.problem.free]
    ends = [(one.low, one.high) for one in plain], [(one.low, one.high) for one in verified]
    assert np.abs(np.subtract(*ends)).max() > 0.05


def test_the_quantile_is_students_where_the_gains_make_the_variance_and_normal_where_they_do_not(toy_fit) -> None:
    scattered, even = toy_fit(keys=("stiffness_factor",), gain=0.1), toy_fit(gain=0.0, noise=0.02)
    freedom = scattered.problem.freedom
    assert scattered.quantile == pytest.approx(scipy.stats.t.ppf(0.975, freedom))
    assert scattered.quantile_of(0) == pytest.approx(scattered.quantile, rel=0.01)
    for index in even.problem.free:
        assert 1.959 < even.quantile_of(index) < 2.0 < even.quantile
