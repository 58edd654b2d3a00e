from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.files import load_tissue
from benchmark.identification import TrialData, fit_session
from benchmark.identification.effects_in_fit import fit_with_effects
from benchmark.model_file import AddedEffect, RepairedModel, Value
from benchmark.physics import TrialContext, catalogue
from benchmark.response import ForceCurve
from benchmark.response.pipeline import trial_force

TRUE = 1.3
CURVE = ForceCurve(np.linspace(0.0, 4e-3, 41), 1000.0 * np.linspace(0.0, 4e-3, 41) ** 1.2 / (4e-3**0.2))
RELAXATION = AddedEffect("viscoelastic_relaxation", {"g_1": Value(0.3, ""), "tau_1": Value(2.0, "s")})
MODEL = RepairedModel("m.toml", "ecoflex_00_30", "wave", (RELAXATION,), {}, "corrected")


def _trial(number: int) -> TrialData:
    rng = np.random.default_rng(number)
    time = np.linspace(0.0, 20.0, 400)
    depth = np.interp(time, [0.0, 2.0, 12.0, 14.0, 20.0], [-5e-4, 2.5e-3, 2.5e-3, -5e-4, -5e-4])
    effect = next(each for each in catalogue() if each.slug == "viscoelastic_relaxation")
    around = TrialContext(5e-3, 1e-2, 2.5e-3, 3.0, 20.0)
    force = trial_force(lambda below: TRUE * CURVE(below), [(effect, RELAXATION.values())], time, depth, around)
    return TrialData(f"t{number}", "a", time, depth, force + rng.normal(0.0, 5e-3, time.size), CURVE)


def _session(trials: tuple[TrialData, ...]) -> SimpleNamespace:
    tool = SimpleNamespace(radius=5e-3, contact="rigid_bonded", edge_radius=None)
    rig = {"tool": tool, "support": SimpleNamespace(kind="bonded")}
    measured = [SimpleNamespace(name=t.name, condition=t.condition, **rig) for t in trials]
    tissue = load_tissue("ecoflex_00_30")
    return SimpleNamespace(specimen=tissue, trials=measured, setup=lambda trial: (tissue, trial.tool, trial.support))


def test_the_effect_no_longer_softens_the_fit() -> None:
    trials = tuple(_trial(number) for number in range(4))
    session = _session(trials)
    plain = fit_session(trials, session.specimen.layers)
    repaired = fit_with_effects(session, trials, MODEL)
    assert plain.stiffness_factor < 0.95 * TRUE
    assert repaired.settled
    assert repaired.fit.stiffness_factor == pytest.approx(TRUE, rel=0.03)
    assert repaired.added["a", "t0"].min() < -0.3


def test_the_stiffness_is_no_surer_than_the_effect() -> None:
    trials = tuple(_trial(number) for number in range(4))
    values = {"g_1": Value(0.3, "", (0.2, 0.4)), "tau_1": Value(2.0, "s")}
    unsure = replace(MODEL, effects=(replace(RELAXATION, parameters=values),))
    sure, wide = (fit_with_effects(_session(trials), trials, each).fit for each in (MODEL, unsure))
    stronger = replace(MODEL, effects=(replace(RELAXATION, parameters={**values, "g_1": Value(0.4, "")}),))
    moved = fit_with_effects(_session(trials), trials, stronger).fit.stiffness_factor / sure.stiffness_factor
    assert wide.stiffness_factor == sure.stiffness_factor
    assert wide.stiffness.ci95_high / sure.stiffness_factor == pytest.approx(moved, rel=0.02)
    assert wide.stiffness.ci95_low < wide.stiffness_factor**2 / moved * 1.02
    assert wide.parameters[0].ci95_high == wide.stiffness.ci95_high
