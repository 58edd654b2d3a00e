"""Identified constants of the FEM's layers give an effect the size that its equation says."""

from dataclasses import replace

import numpy as np
import pytest

import fem
from benchmark.physics import NotInFemError, TrialContext, catalogue, fem_identification
from benchmark.physics.fem_identification import relaxation_factor, stiffened

THICKNESS = 10e-3
PROBLEM = fem.Problem(
    layers=(fem.Layer("fat", THICKNESS, 1000.0, fem.NeoHookean(5e4, 0.48)),),
    tool=fem.Tool(5e-3, "uniform_pressure"),
    support=fem.Support("bonded"),
    discretisation=fem.Discretisation("coarse"),
)
PEAK = 1.0


def with_law(law: fem.Material, kinematics: str = "finite") -> fem.Problem:
    return replace(PROBLEM, layers=(replace(PROBLEM.layers[0], material=law),), kinematics=kinematics)


def quadratic(depth):
    return 1.0 + 40.0 * (depth / THICKNESS) ** 2


def depths(problem, force):
    return fem.prepare(problem).run(fem.Load("force", np.arange(1.0, force.size + 1), force)).depth


@pytest.fixture(scope="module")
def found():
    return stiffened(PROBLEM, quadratic, "force", PEAK)


def test_the_press_has_the_wanted_factor_between_the_loads_that_were_fitted(found):
    force = PEAK * np.array([0.25, 0.6, 0.9])
    depth = depths(found.problem, force)
    dense = np.linspace(0.025, 1.0, 40) * PEAK
    plain = depths(PROBLEM, dense)
    np.testing.assert_allclose(np.interp(depth, plain, dense) * quadratic(depth), force, rtol=0.005)
    assert depth[-1] < 0.9 * np.interp(force[-1], dense, plain)


def test_the_law_is_said_with_its_misfit(found):
    assert found.law.startswith("Yeoh, c20 = ")
    assert 0.0 < found.misfit < 0.003


def test_stiffening_with_an_exponent_is_identified_from_its_own_factor(monkeypatch):
    asked = []

    def identified(problem, factor, control, peak):
        asked.append((factor(np.array([2e-3, 4e-3])), control, peak))
        return fem_identification.StiffenedLaw(problem, "Yeoh", 0.001)

    monkeypatch.setattr(fem_identification, "stiffened", identified)
    (effect,) = (each.richer for each in catalogue() if each.slug == "strain_stiffening")
    around = TrialContext(5e-3, THICKNESS, 4e-3, PEAK, 10.0, control="force")
    _, remark = effect.fem.change({"b_1": 0.5, "b_2": 2.0, "b_3": 3.0}, PROBLEM, around)
    x = np.array([0.2, 0.4])
    assert asked[0][0] == pytest.approx(1.0 + (0.5 * x + 2.0 * x**2) * np.exp(3.0 * x**2))
    assert asked[0][1:] == ("force", PEAK)
    assert "Yeoh" in remark


def test_the_moduli_at_rest_stay(found):
    (layer,) = found.problem.layers
    assert 2.0 * layer.material.c10 == pytest.approx(5e4 / (2.0 * 1.48))
    assert found.problem == replace(PROBLEM, layers=(layer,))


@pytest.mark.parametrize(
    ("problem", "factor", "message"),
    [
        (with_law(fem.LinearElastic(5e4, 0.48), "linear"), quadratic, "needs finite strain"),
        (with_law(fem.Yeoh(8e3, 1e3, 0.0, 0.48)), quadratic, "fat has a law of its own, Yeoh"),
        (PROBLEM, lambda depth: 1.0 + (depth > 1e-3), "no law of the layers stiffens"),
    ],
    ids=["small strain", "other law", "step"],
)
def test_what_the_fem_cannot_carry_is_said(problem, factor, message):
    with pytest.raises(NotInFemError, match=message):
        stiffened(problem, factor, "force", PEAK)


def test_the_force_fades_by_the_wanted_share():
    share, depth = 0.3, 2e-3
    factor = relaxation_factor(PROBLEM, share, "depth", depth)
    term = fem.PronyTerm(factor * share, 0.1)
    relaxing = replace(PROBLEM, layers=(replace(PROBLEM.layers[0], relaxation=(term,)),))
    time = np.array([1e-4, 0.1, 10.0])
    held = fem.prepare(relaxing).run(fem.Load("depth", time, np.full(3, depth))).force
    assert factor > 1.005
    assert held[-1] / held[0] == pytest.approx(1.0 - share, abs=0.002)


def test_a_share_beyond_what_shear_can_lose_is_refused():
    stiff = with_law(fem.LinearElastic(5e4, 0.45), "linear")
    with pytest.raises(NotInFemError, match=r"cannot let 97\.9 % of the force fade"):
        relaxation_factor(stiff, 0.979, "depth", 1e-3)
