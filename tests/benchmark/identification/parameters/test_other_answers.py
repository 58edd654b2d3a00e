"""A power of Ogden's law of either sign: trials by the closed form of a cylinder between plates that slide."""

import sys
from dataclasses import replace

import numpy as np
import pytest

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
