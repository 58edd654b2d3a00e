"""What counts as determined where the likelihood is steep at the estimate and flat beside it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.identification.parameters.identifiability import LARGEST_ERROR, directions, errors_alone
from benchmark.identification.parameters.identified import NOT_DETERMINED, Estimate, Identified, identify
from benchmark.identification.parameters.identified_tissue import identified_tissue
from benchmark.identification.parameters.law_shapes import shear_modulus
from benchmark.identification.parameters.layer_fit import begun, fit_layers
from benchmark.identification.parameters.presses import press_surrogate
from benchmark.identification.parameters.profile_likelihood import Profile, largest_errors
from benchmark.response.differentiated_ramp import DifferentiatedRamp, RampDerivative
from tests.benchmark.identification.parameters.conftest import TISSUE

DERMIS, TRIALS, SCATTER = "dermis", 6, 2e-2
TOLD = shear_modulus(TISSUE.layer(DERMIS))


def folded_ramp(session, tissue, tool, support, depth, keys, model="fem", steps=24, *, judge_mesh=False):
    """A force that is least where the dermis is as told, and rises faster to the soft side."""
    levels = np.linspace(0.0, depth, steps + 1)
    away = np.log(shear_modulus(tissue.layer(DERMIS)) / TOLD)
    steep = 0.06 if away > 0.0 else 0.15
    force = 1e4 * tool.radius * levels * np.exp(steep * away**2)
    by = {f"{DERMIS}.stiffness": RampDerivative(2.0 * steep * away * force)}
    return DifferentiatedRamp(
        levels, force, None, {key: by[key] for key in keys}, mesh_error=0.0 if judge_mesh else None
    )


@pytest.fixture
def folded(toy, monkeypatch):
    """A factory of fits to a dermis so many times as stiff as told, found on the stiff side of the fold."""
    monkeypatch.setattr(press_surrogate, "differentiated_ramp", folded_ramp)

    def fit(away):
        problem = toy(keys=("dermis.youngs_modulus",), tools=(0,), trials=TRIALS)
        generator = np.random.default_rng(5)
        top = 1e4 * problem.presses[0].setup[1].radius * np.exp(0.06 * away**2)
        gains = generator.normal(size=TRIALS)
        gains = np.exp(SCATTER * (gains - gains.mean()) / gains.std())

        def pressed(trial, gain):
            force = gain * top * np.maximum(trial.data.depth, 0.0)
            noisy = force + 1e-3 * force.max() * generator.normal(size=force.size)
            return replace(trial, data=replace(trial.data, force=noisy))

        trials = tuple(map(pressed, problem.trials, gains))
        one = problem.parameters[0]
        started = replace(one, start=one.start * np.exp(away))
        problem = replace(problem, trials=trials, parameters=(started,), trust=1e-3)
        return fit_layers(begun(problem, np.zeros(TRIALS), np.zeros(TRIALS)))

    return fit


def answer(found):
    return identify(found, (), directions(found), ["a"] * TRIALS, ("folded",))


def test_a_value_with_a_fold_in_its_region_is_not_determined_though_its_interval_ends(folded) -> None:
    found = folded(0.25)
    told = answer(found)
    (own,), at = told.profiles, float(found.vector[0])
    assert own.determined(at)
    assert float(errors_alone(found.fit, found.problem.free)[0]) < LARGEST_ERROR
    (estimate,) = told.estimates
    assert not estimate.identifiable
    assert estimate.low is None
    assert estimate.text.endswith(NOT_DETERMINED)
    assert "at others that follow them as well; allowed 35 %" in estimate.reason
    assert told.to_dict()["determined_limits"] == pytest.approx({"factor": 2.0, "standard_error": 0.354}, abs=1e-3)


def test_away_from_the_fold_the_same_trials_determine_it(folded) -> None:
    (estimate,) = answer(folded(0.9)).estimates
    assert estimate.identifiable
    assert estimate.low * 1e3 < 3.0 * TOLD * np.exp(0.9) < estimate.high * 1e3


def test_what_a_fit_ends_with_that_did_not_settle_is_not_determined(folded) -> None:
    """Its intervals are those of a surrogate that the model does not follow."""
    told = answer(folded(0.9))
    loose = replace(told, found=replace(told.found, disagreement=5e-3))
    (estimate,) = loose.estimates
    assert not estimate.identifiable
    assert (estimate.low, estimate.high) == (None, None)
    assert "did not settle" in estimate.reason
    assert sum("did not settle" in one for one in loose.warnings) == 2  # of the value, and of the fit
    assert "still differs by 0.5 % from the one that they were fitted with (allowed 0.05 %)" in loose.warnings[-1]


def test_a_value_that_is_not_determined_stands_in_the_tissue_file_without_an_uncertainty(folded) -> None:
    told = answer(folded(0.9))
    sure = identified_tissue(told)
    lost = identified_tissue(replace(told, found=replace(told.found, disagreement=5e-3)))
    assert 0.0 < sure.uncertainties[f"{DERMIS}.youngs_modulus"] < 0.5
    assert f"{DERMIS}.youngs_modulus" not in lost.uncertainties
    assert lost.not_determined == (f"{DERMIS}.youngs_modulus",)
    assert lost.layer(DERMIS).youngs_modulus == pytest.approx(sure.layer(DERMIS).youngs_modulus)


def test_an_interval_that_rests_on_a_prior_is_not_called_not_determined() -> None:
    told = Estimate(
        "fat.thickness", 5.0, 4.0, 6.0, "mm", False, "5 mm +/- 10 %; a ruler", "the trials tell nothing of it"
    )
    assert told.standing == "on its prior alone"
    assert told.warning == "fat.thickness rests on its prior alone: the trials tell nothing of it"
    assert told.text == "fat.thickness 5 mm (95 % 4 to 6, on its prior alone)"
    assert told.source == "on its prior alone (5 mm +/- 10 %; a ruler): the trials tell nothing of it"
    lost = replace(told, low=None, high=None)
    assert lost.standing == NOT_DETERMINED
    assert lost.warning == "fat.thickness is not determined: the trials tell nothing of it"
    assert lost.text == "fat.thickness not determined"


def test_only_points_within_the_region_count() -> None:
    errors = np.array([[9.0, 9.0], [0.1, 0.2], [0.3, 0.1], [9.0, 9.0]])
    one = Profile(np.arange(4.0), np.array([9.0, 0.0, 3.0, 9.0]), errors, 0.5, 2.5, 2.0)
    assert largest_errors((one, one)) == pytest.approx([0.3, 0.2])


def test_conditions_that_one_law_cannot_follow_leave_nothing_determined(toy):
    """Forces of one tool 5 times as large went into the trials' gains: moduli had tight intervals all the same."""
    problem = toy(keys=("subcutaneous_fat.youngs_modulus",))
    groups = [trial.data.condition for trial in problem.trials]

    def answer_to(factor):
        trials = tuple(
            replace(one, data=replace(one.data, force=factor * one.data.force)) if name == "tool 1" else one
            for one, name in zip(problem.trials, groups, strict=True)
        )
        made = begun(replace(problem, trials=trials), np.zeros(len(trials)), np.zeros(len(trials)))
        return identify(fit_layers(made), (), directions(made), groups, ["toy"])

    followed, torn = answer_to(1.0), answer_to(5.0)
    assert followed.conflict == ""
    assert torn.undetermined == torn.estimates
    assert "one law does not follow all conditions; " in torn.headline
    (said,) = (text for text in torn.warnings if text.startswith("one law does not follow all conditions: their"))
    errors = {one.condition: one.rms_percent for one in torn.held_out}
    assert min(errors.values()) > 10.0
    for name, error in errors.items():
        assert f"{name} to {error:.3g} %" in said
    over = [one.to_dict()["force_over_model"] for one in torn.held_out]
    assert over[1] / over[0] == pytest.approx(5.0, rel=0.2)
    assert "subcutaneous_fat.youngs_modulus" in said


def test_rows_of_one_key_say_whose_it_is():
    """Two tools of one session, and two specimens of which both thicknesses were told."""
    small, wide = (SimpleNamespace(radius=radius) for radius in (5e-3, 8e-3))
    presses = [SimpleNamespace(specimen=k, session=SimpleNamespace(name=name)) for k, name in enumerate("ab")]

    def told(key, **whose):
        return SimpleNamespace(**{"key": key, "told": True, "tool": None, "specimen": None} | whose)

    radii = [told("tool.radius", tool=tool) for tool in (small, wide)]
    thick = [told("fat.thickness", specimen=k) for k in (0, 1)]
    problem = SimpleNamespace(parameters=[*radii, *thick, told("hole", specimen=0)], presses=presses)
    found = SimpleNamespace(found=SimpleNamespace(problem=problem))
    said = [Identified._whose(found, each) for each in problem.parameters]
    assert said == [", tool of 5 mm", ", tool of 8 mm", ", a", ", b", ""]
