"""A power of Ogden's law of either sign: trials by the closed form of a cylinder between plates that slide."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from benchmark.files.sessions.fit_table import FitTable
from benchmark.identification.parameters.free_parameters import parameters_of
from benchmark.identification.parameters.identifiability import directions
from benchmark.identification.parameters.identified import identify
from benchmark.identification.parameters.layer_fit import begun, fit_layers
from benchmark.identification.parameters.other_answers import other_answers
from benchmark.identification.parameters.presses import press_surrogate
from benchmark.identification.parameters.session_problem import _informed
from benchmark.response.differentiated_ramp import DifferentiatedRamp, RampDerivative

DERMIS, HEIGHT, AREA = "dermis", 1e-2, 3e-4
MODULUS, TERM = f"{DERMIS}.youngs_modulus", f"{DERMIS}.hyperelastic.terms.0"
TRIALS = 4


def closed_form(shear, power, depth):
    """N: 2 G / alpha (l^(-alpha/2 - 1) - l^(alpha - 1)) over the area at rest, incompressible."""
    stretch = 1.0 - depth / HEIGHT
    return 2.0 * shear / power * AREA * (stretch ** (-0.5 * power - 1.0) - stretch ** (power - 1.0))


def plates_ramp(session, tissue, tool, support, depth, keys, model="fem", steps=24, *, judge_mesh=False):
    levels = np.linspace(0.0, depth, steps + 1)
    (term,) = tissue.layer(DERMIS).hyperelastic.terms
    shear, power, step = 0.5 * term.mu * term.alpha, term.alpha, 1e-5
    force = closed_form(shear, power, levels)
    more, less = (closed_form(shear * (1 + way), power * (1 + way), levels) for way in (step, -step))
    by = {f"{DERMIS}.stiffness": force, f"{TERM}.mu": force, f"{TERM}.alpha": (more - less) / (2.0 * step)}
    found = {key: RampDerivative(by.get(key, 0.0 * force)) for key in keys}
    return DifferentiatedRamp(levels, force, None, found, mesh_error=0.0 if judge_mesh else None)


@pytest.fixture
def pressed(toy, monkeypatch):
    """Factory of problems and their starts: trials of a power, as deep as told, with noise as a share of the peak."""
    monkeypatch.setattr(press_surrogate, "differentiated_ramp", plates_ramp)

    def problem(power, depth=2.5e-3, noise=1e-3):
        made = toy(keys=(MODULUS,), tools=(0,), trials=TRIALS)
        generator = np.random.default_rng(3)
        top, time = closed_form(1e5, power, depth), made.trials[0].data.time
        trials = []
        for one in made.trials:
            way = one.data.depth / one.data.depth.max() * depth
            force = np.exp(1e-2 * generator.normal()) * closed_form(1e5, power, np.maximum(way, 0.0))
            data = replace(one.data, depth=way, force=force + noise * top * generator.normal(size=time.size))
            trials.append(type(one).of(data, 0, one.touch))
        free = (*made.parameters, *parameters_of("law.alpha", made.presses[0].setup, "ogden"))
        presses = tuple(replace(one, depth=1.04 * depth) for one in made.presses)
        return replace(made, presses=presses, trials=tuple(trials), parameters=free, law="ogden", trust=1e-3)

    return problem


def answered(problem):
    """The answer as the command has it."""
    start = begun(problem, np.zeros(TRIALS), np.zeros(TRIALS))
    found, others = other_answers(fit_layers(start), lambda _: None)
    return identify(found, others, directions(start), ["a"] * TRIALS, ("plates",))


@pytest.mark.parametrize("power", [-4.0, -2.0, 0.3, 4.0])
def test_a_power_of_either_sign_is_found_with_its_modulus(pressed, power) -> None:
    modulus, found = answered(pressed(power)).estimates
    assert found.identifiable
    assert found.low < power < found.high
    assert modulus.low < 1e-3 * 2.0 * (1.0 + 0.48) * 1e5 < modulus.high
    assert modulus.high < 1.06 * modulus.low


def test_powers_of_both_signs_that_fit_alike_are_told(pressed, monkeypatch) -> None:
    """Of a toy that is even in the power: nothing tells its sign."""
    one_sided = closed_form

    def even(shear, power, depth):
        return 0.5 * (one_sided(shear, power, depth) + one_sided(shear, -power, depth))

    monkeypatch.setattr(sys.modules[__name__], "closed_form", even)
    told = answered(pressed(-6.0))
    found, own = told.estimates[1], told.found.value(1)
    assert abs(own) == pytest.approx(6.0, rel=0.1)
    assert [one.value(1) for one in told.others] == pytest.approx([-own], rel=0.05)
    assert not found.identifiable
    assert found.low is None
    assert "two or more answers away from each other follow the trials equally well" in found.reason
    assert any(one.startswith("another answer follows the trials as well: ") for one in told.warnings)


def test_a_power_may_be_held_on_one_side(pressed) -> None:
    problem = pressed(-4.0)
    wish = FitTable(free=("law.alpha",), law="ogden", bounds={"law.alpha": (-9, -1)})
    one = _informed(problem.parameters[1], wish)
    assert -9.0 < one.start < -1.0
    found = answered(replace(problem, parameters=(problem.parameters[0], one))).estimates[1]
    assert found.low < -4.0 < found.high


def with_slow_noise(problem, size, memory, seed):
    """The problem with noise of a memory in each trial, its size a share of the peak."""
    generator = np.random.default_rng(seed)
    trials = []
    for one in problem.trials:
        white = generator.normal(size=one.data.rows) * np.sqrt(1.0 - memory**2)
        white[0] = generator.normal()
        slow = lfilter([1.0], [1.0, -memory], white)
        force = one.data.force + size * one.data.force.max() * slow
        trials.append(replace(one, data=replace(one.data, force=force)))
    return replace(problem, trials=tuple(trials))


UNFOLLOWED = "the law does not follow the trials under the tool of 5 mm: residual "


def test_what_all_trials_leave_alike_beyond_their_noise_is_told(pressed) -> None:
    """Positive powers alone: 1 % of the force is left, which a memory of the noise of 0.998 took for chance."""
    problem = pressed(-4.0)
    held = (problem.parameters[0], replace(problem.parameters[1], low=0.5))
    wrong = answered(replace(problem, parameters=held))
    assert wrong.to_dict()["residual_percent_of_peak"] < 2.0
    (said,) = (one for one in wrong.warnings if one.startswith(UNFOLLOWED))
    top = closed_form(1e5, -4.0, 2.5e-3)
    residual, noise = (float(said.split(f"{what} ")[1].split(" N")[0]) for what in ("residual", "noise"))
    assert noise == pytest.approx(1e-3 * top, rel=0.5)
    assert 3e-3 * top < residual < 2e-2 * top
    assert not any(one.startswith(UNFOLLOWED) for one in answered(problem).warnings)


@pytest.mark.parametrize("seed", range(4))
def test_slow_noise_of_each_trial_is_no_course_of_all(pressed, seed) -> None:
    """Its samples scatter by a tenth of it, and the fit leaves most of it."""
    found = answered(with_slow_noise(pressed(4.0, noise=1e-4), 1.5e-2, 0.99, seed))
    assert found.to_dict()["residual_percent_of_peak"] > 0.3
    assert not any("the law does not follow the trials" in one for one in found.warnings)


def test_derivatives_by_a_negative_power_are_those_of_the_force(pressed) -> None:
    problem = pressed(-4.0)
    at = problem.start.copy()
    at[1] = -1.2
    step = np.zeros_like(at)
    step[1] = 1e-5
    tables = [
        begun(replace(problem, parameters=_started(problem, at + way)), *np.zeros((2, TRIALS)))
        for way in (-step, 0.0 * step, step)
    ]
    less, own, more = (one.model.surrogates[0].newest for one in tables)
    slope = np.log(more.force[1:] / less.force[1:]) / 2e-5
    assert own.by[1][100:] == pytest.approx(slope[99:], rel=1e-3)


def _started(problem, at):
    return tuple(replace(one, start=one.value(float(x))) for one, x in zip(problem.parameters, at, strict=False))
