"""An answer on the set-up as told against a set-up that is off by what people are usually wrong by."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.base.effect_model import EffectModel, fit
from benchmark.discovery.base.setup_priors import setup_entries, setup_priors, told_priors
from benchmark.discovery.evidence import told_setup as module
from benchmark.discovery.evidence.gains import Gain
from benchmark.discovery.evidence.pool import Pool
from benchmark.discovery.evidence.told_setup import on_told, setup_first, stands, taken_up
from benchmark.discovery.trials.preparing import prepare
from benchmark.files import load_session
from benchmark.physics import catalogue

ALONE = Pool(None, None, "")
RELAXATION = next(effect for effect in catalogue() if effect.slug == "viscoelastic_relaxation")


def fading(time, _depth, elastic):
    """A quarter of the force fades with one second."""
    kept, out = 0.0, np.empty_like(elastic)
    for k, force in enumerate(elastic):
        step = time[k] - time[k - 1] if k else 0.0
        kept += (force - kept) * (1.0 - np.exp(-step))
        out[k] = force - 0.25 * kept
    return out


@pytest.fixture(scope="module")
def relaxing(tmp_path_factory, quick_session):
    """A session that relaxes, its set-up told as it is."""
    session = load_session(quick_session.write_session(tmp_path_factory.mktemp("told") / "s", force=fading, trials=3))
    return session, calibrate(session, prepare(session, 60)).base


def test_a_set_up_as_told_moves_in_the_tool_alone_and_in_what_is_stated(relaxing):
    session, moving = relaxing
    told = on_told(moving, told_priors(session))
    assert set(moving.model.problem.setup) == {"tool.radius", "layer.thickness"}
    assert set(told.model.problem.setup) == {"tool.radius"}
    assert on_told(moving, setup_priors(session)) is moving
    assert stands(told, told, moving, (), ALONE)


def test_a_set_up_that_went_far_does_not_take_the_one_that_was_told_with_it(relaxing):
    session, moving = relaxing
    near = on_told(moving, told_priors(session))
    far = moving.vector.copy()
    far[list(moving.model.problem.shapes).index("modulus")] = -3.0
    gone = on_told(replace(moving, vector=far), told_priors(session))
    assert gone.objective == pytest.approx(near.objective, rel=1e-3)


def test_an_effect_stands_and_what_a_base_may_be_off_by_anyway_does_not(relaxing):
    session, moving = relaxing
    told = on_told(moving, told_priors(session))
    thickness = next(entry for entry in setup_entries(moving.model.problem.tables) if "thickness" in entry.slug)
    found = fit_candidate(told, RELAXATION)
    assert stands(found, told, moving, catalogue(), ALONE)
    wide = replace(moving.model.problem, setup={**moving.model.problem.setup, "layer.thickness": 1.0})
    anywhere = fit(EffectModel(wide, ()), moving.vector, moving.nuisance, most=8)
    assert not stands(fit_candidate(told, thickness), told, anywhere, (), ALONE)


@pytest.mark.parametrize(
    ("without_a", "without_b", "whole", "expected"),
    [
        (50.0, 60.0, 100.0, True),
        (100.0, 60.0, 100.0, False),  # a base that moves does without the first what the first does
        (50.0, 100.0, 100.0, False),
        (50.0, 60.0, 150.0, False),  # and with both it gains by moving
    ],
)
def test_each_of_several_effects_must_be_missed_by_a_base_that_moves(
    monkeypatch, without_a, without_b, whole, expected
):
    a, b = (SimpleNamespace(slug=slug) for slug in "ab")
    by_slugs = {"b": without_a, "a": without_b, "ab": whole}
    chosen, told, moving = 100.0, 0.0, 10.0
    monkeypatch.setattr(module, "held_out", lambda fit: np.full(4, getattr(fit, "density", fit) / 4))
    monkeypatch.setattr(module, "foretold", lambda fits, _: [np.full(4, fit / 4) for fit in fits])
    monkeypatch.setattr(
        module, "rebuilt_each", lambda base, rows, *_: [by_slugs["".join(each.slug for each in row)] for row in rows]
    )
    monkeypatch.setattr(module, "_others_in_place", lambda *_: [])
    found = SimpleNamespace(model=SimpleNamespace(effects=(a, b)), density=chosen)
    assert stands(found, told, moving, (), ALONE) is expected


@pytest.mark.parametrize(
    ("won", "density", "seen", "expected"),
    [
        (16.0, 106.0, True, False),
        (16.0, 104.0, True, True),  # no more than chance
        (14.0, 106.0, True, True),  # one step says that it comes nowhere near
        (16.0, 106.0, False, True),  # these data cannot show it
    ],
)
def test_another_effect_must_not_foretell_more_on_a_base_that_moves(monkeypatch, won, density, seen, expected):
    chosen, other, hidden = (SimpleNamespace(slug=slug) for slug in ("chosen", "other", "hidden"))
    model = SimpleNamespace(effects=(chosen,), problem=SimpleNamespace(study=None))
    found = SimpleNamespace(model=model, objective=1000.0, density=100.0)
    less = SimpleNamespace(model=model, objective=1020.0, density=50.0)
    instead = SimpleNamespace(model=SimpleNamespace(effects=(other,)), density=density)
    monkeypatch.setattr(module, "held_out", lambda fit: np.full(4, fit.density / 4))
    monkeypatch.setattr(module, "foretold", lambda fits, _: [np.full(4, fit.density / 4) for fit in fits])
    monkeypatch.setattr(module, "rebuilt_each", lambda *_: [less, found])
    monkeypatch.setattr(module, "usable", lambda _, effect: effect is not hidden)
    monkeypatch.setattr(
        module, "screen", lambda _, effects: [SimpleNamespace(effect=each, won=won) for each in effects]
    )
    monkeypatch.setattr(module, "seen", lambda fit, effect: seen)
    work = SimpleNamespace(map=map, fits=lambda _, pairs: [instead] if pairs == [(less, other)] else [])
    told = moving = SimpleNamespace(density=0.0)
    assert stands(found, told, moving, (hidden, chosen, other), work) is expected


@pytest.mark.parametrize(
    ("slug", "each", "first"),
    [
        ("setup.layer.thickness", [3.0] * 4, True),  # 9 without the best trial
        ("setup.layer.thickness", [2.0] * 4, False),
        ("machine_compliance", [3.0] * 4, False),
    ],
)
def test_a_set_up_that_is_surely_another_is_an_answer(slug, each, first):
    gain = Gain(np.array(each), float(np.mean(each)), 0.1, 9.0)
    assert setup_first(SimpleNamespace(steps=(SimpleNamespace(slug=slug, gain=gain),))) is first
    assert not setup_first(SimpleNamespace(steps=()))


def chosen(fit, *slugs, **alike):
    """A selection of effects, and of set-up entries with what looks like each."""
    entries = [SimpleNamespace(slug=f"setup.tool.{key}") for key in alike]
    effects = (*(effect for effect in catalogue() if effect.slug in slugs), *entries)
    lookalikes = {entry.slug: rivals for entry, rivals in zip(entries, alike.values(), strict=True)}
    return SimpleNamespace(
        chosen=SimpleNamespace(model=SimpleNamespace(effects=effects)), base=fit, lookalikes=lookalikes
    )


def test_what_a_set_up_that_moves_takes_up_is_told_of():
    problem = SimpleNamespace(
        setup={"tool.radius": 0.05, "layer.thickness": 0.04},
        shape_priors={"modulus": 3.0, "tool.radius": 0.05, "layer.thickness": 0.04},
    )
    base = SimpleNamespace(model=SimpleNamespace(problem=problem), vector=np.array([9.0, 0.01, -0.03]))
    (remark,) = taken_up(chosen(base, "machine_compliance"), chosen(base))
    assert "would need machine compliance" in remark
    assert "(layer.thickness)" in remark
    assert taken_up(chosen(base), chosen(base)) == ()
    assert taken_up(chosen(base, radius=("setup.layer.thickness",)), chosen(base)) == ()
    alike = ("setup.layer.thickness", "perspective", "pretension")
    (remark,) = taken_up(chosen(base, "adhesion", radius=alike), chosen(base, "adhesion"))
    assert "would need perspective beside adhesion;" in remark
    assert taken_up(chosen(base, "adhesion", radius=alike), chosen(base, "adhesion", "perspective")) == ()
    assert taken_up(chosen(base, "adhesion"), chosen(base, "adhesion")) == ()
    (remark,) = taken_up(chosen(base, "adhesion", "machine_compliance"), chosen(base, "adhesion"))
    assert "would need machine compliance beside adhesion;" in remark
    assert taken_up(chosen(base, "adhesion", "machine_compliance"), chosen(base, "perspective")) == ()
