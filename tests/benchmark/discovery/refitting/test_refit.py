"""Effects put into the models and refitted there, on the shipped pad of two tools, whose hidden law is known."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.effect_model import EffectModel, Fit
from benchmark.discovery.base.setup_priors import told_priors
from benchmark.discovery.evidence.told_setup import on_told
from benchmark.discovery.refitting.native_terms import C20, C30, PRETENSION, STIFFENING
from benchmark.discovery.refitting.press_model import PressModel
from benchmark.discovery.refitting.refit import picked, refit
from benchmark.discovery.refitting.refit_result import ModelRefit
from benchmark.discovery.refitting.solid_press import FemSpecimen
from benchmark.discovery.refitting.unseen import splits
from benchmark.discovery.trials.preparing import prepare
from benchmark.files import Session, load_session
from benchmark.physics import catalogue
from benchmark.sessions import SHIPPED


@pytest.fixture(scope="module")
def pad() -> Session:
    """Two trials of each condition on a coarse mesh, the tool's radius known to 0.2 %."""
    session = load_session(SHIPPED / "gel_pad", {"fem.mesh": "coarse", "tool.radius": "5 mm +/- 0.2 %"})
    return replace(session, trials=tuple(each for each in session.trials if not each.name.endswith("3")))


@pytest.fixture(scope="module")
def stiffened(pad: Session) -> Fit:
    """Stiffening as the engine fits it, without a search."""
    base = on_told(calibrate(pad, prepare(pad, 120)).base, told_priors(pad))
    return picked(base, [each for each in catalogue() if each.slug == "strain_stiffening"])


@pytest.fixture(scope="module")
def in_fem(pad: Session, stiffened: Fit) -> ModelRefit:
    """The finite elements' refit."""
    return refit(pad, stiffened, "fem")


def test_the_law_of_the_solid_is_found_within_that_of_its_layers(in_fem: ModelRefit) -> None:
    numbers = {each.estimate.name: each.estimate.value for each in in_fem.numbers}
    assert in_fem.carried[0].inside
    assert 0.5 < numbers[C20] < 1.5, "c20 over c10: 0.5 in the skin and 1.5 in the gel"
    assert 0.0 <= numbers[C30] < 0.2, "c30 over c10: 0 in the skin and 0.1 in the gel"
    assert in_fem.apart < 2e-3


def test_an_unseen_tool_is_predicted_with_the_effect_alone(in_fem: ModelRefit) -> None:
    tools = [each for each in in_fem.predictions if each.held_out == "tool"]
    assert {each.name for each in tools} == {"wide", "shallow, deep"}
    for each in tools:
        assert each.after < 0.1 * each.before, each
        assert each.explained is not None
        assert each.explained > 0.98


def test_what_a_memory_in_the_model_changes_grows_with_the_stiffness_of_each_trial(stiffened: Fit) -> None:
    problem = stiffened.model.problem
    plain = EffectModel(problem, ())
    faded = np.full(len(problem.trials[0].motion.time), -0.1)
    vector, own = np.zeros(plain.size), np.zeros_like(stiffened.nuisance)
    vector[0], own[0, 0] = np.log(2.0), np.log(3.0)
    apart = zip(
        PressModel(problem, (), fading={0: faded}).signals(vector, own), plain.signals(vector, own), strict=True
    )
    for index, (with_it, without) in enumerate(apart):
        expected = (-0.6 if index == 0 else -0.2) if problem.trials[index].condition == 0 else 0.0
        np.testing.assert_allclose(with_it[:, 0] - without[:, 0], expected, atol=1e-12)
    assert {trial.condition for trial in problem.trials} > {0}


def test_model_and_search_add_about_as_much(in_fem: ModelRefit) -> None:
    assert in_fem.adds == pytest.approx(in_fem.found_adds, rel=0.25)


def test_the_document_has_every_prediction(in_fem: ModelRefit) -> None:
    document = in_fem.document()
    assert [each["held_out"] for each in document["predictions"]] == [
        "nothing",
        "condition",
        "condition",
        "tool",
        "tool",
    ]
    assert document["effects"][0]["name"] == "strain_stiffening"
    assert document["predictions"][0]["unit"] == "N"


def test_a_condition_with_a_tool_of_its_own_is_an_unseen_tool(stiffened: Fit) -> None:
    found = {each.name: (each.kind, int(each.left.sum())) for each in splits(stiffened)}
    assert found == {
        "shallow": ("condition", 2), "deep": ("condition", 2), "wide": ("tool", 2), "shallow, deep": ("tool", 4),
    }  # fmt: skip


def test_derivatives_by_a_term_are_those_of_its_presses(pad: Session) -> None:
    specimen = FemSpecimen(pad, (), (STIFFENING,))
    setup = pad.setups[0]
    here = {C20: 0.8, C30: 0.05}
    table = specimen.table(setup, 2e-3, here)
    more = specimen.pressed(setup, 2e-3, {**here, C20: 0.81}, {})
    less = specimen.pressed(setup, 2e-3, {**here, C20: 0.79}, {})
    slope = (more.force - less.force) / 0.02
    deep = table.depth > 0.2 * table.depth[-1]
    np.testing.assert_allclose(table.by[C20].force[0][deep], slope[deep], rtol=5e-3)


def test_a_pretension_is_stated_in_the_session(pad: Session) -> None:
    specimen = FemSpecimen(pad, (), (PRETENSION,))
    setup = pad.setups[0]
    tense, loose = (specimen.pressed(setup, 1e-3, {"physics.pretension": stress}, {}) for stress in (5e3, 1.0))
    assert tense.force[-1] > 1.01 * loose.force[-1]


def test_a_law_of_its_own_is_left_on_top(pad: Session) -> None:
    assert STIFFENING.refused(pad) is None
    assert "law of its own" in str(STIFFENING.refused(STIFFENING.changed(pad, {C20: 0.1, C30: 0.0})))
