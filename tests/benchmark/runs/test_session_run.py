"""A model of one's own beside measured trials: what is said of one that remembers."""

import os
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.files import load_tissue
from benchmark.files.tissue import PronyTerm
from benchmark.identification.sheet_model import NONE, Relaxation
from benchmark.runs import session_run

SETUPS = ("narrow", "wide")


@pytest.mark.parametrize(("remembers", "said"), [(False, 0), (True, 1)])
def test_a_model_that_remembers_the_trials_before_is_pointed_out(monkeypatch, remembers: bool, said: int) -> None:
    """Each trial's force depended on those before it, without a word."""
    calls = []

    def force(trial, found, wave, own):
        calls.append(wave)
        return trial.depth * (1.0 + remembers * 1e-3 * len(calls))

    monkeypatch.setattr(session_run, "_wave_force", force)
    trials = [SimpleNamespace(name=f"t{n}", condition="slow", depth=np.linspace(0.0, 1.0, 5)) for n in range(4)]
    waves = {setup: setup for setup in SETUPS}
    answers = [(SETUPS[n % 2], trial, force(trial, None, SETUPS[n % 2], None)) for n, trial in enumerate(trials)]
    found = session_run._remembers("springs", answers, waves, None)
    assert len(found) == said
    assert all("the springs answers the same trial differently each time: slow/t0" in each for each in found)
    assert calls[4:] == (["narrow"] if remembers else ["narrow", "wide"])


def test_what_a_model_writes_past_python_beside_trials_is_not_on_stdout(monkeypatch, capfd) -> None:
    """It stood before the object of `--json`."""
    monkeypatch.setattr(session_run, "_wave", lambda *_: os.write(1, b"loud"))
    session = SimpleNamespace(trials=["a trial"], setup=lambda _: ("gel", "flat", "base"))
    found = SimpleNamespace(session=session, fit=SimpleNamespace(trials=[]), trials=[SimpleNamespace(key="t0")])
    assert session_run._predictions(found, session_run.NOTHING) == ((), ())
    assert capfd.readouterr() == ("", "loud")


@pytest.mark.parametrize("relaxation", [NONE, Relaxation(0.06, 1.5)])
def test_the_relaxation_that_films_told_is_in_both_models_side_by_side(relaxation) -> None:
    """The FEM beside the trials relaxed, that of the comparison did not: 3.4 % apart under one name."""
    found = SimpleNamespace(stiffness_factor=0.8, filmed=SimpleNamespace(sheet=SimpleNamespace(relaxation=relaxation)))
    told = load_tissue("skin_forearm")
    tissue = session_run.relaxing_tissue(found, told)
    terms = () if relaxation == NONE else (PronyTerm(g=0.06, tau=1.5),)
    assert all(layer.relaxation == terms for layer in tissue.layers)
    assert tissue.layers[0].youngs_modulus == pytest.approx(0.8 * told.layers[0].youngs_modulus)
    assert session_run._told_otherwise(found, tissue) == ()
    own = (PronyTerm(g=0.3, tau=0.5),)
    relaxing = told.model_copy(update={"layers": tuple(x.model_copy(update={"relaxation": own}) for x in told.layers)})
    kept = session_run.relaxing_tissue(found, relaxing)
    assert all(layer.relaxation == own for layer in kept.layers)
    assert len(session_run._told_otherwise(found, kept)) == (relaxation != NONE)


def test_films_that_told_no_sheet_leave_the_tissue_as_it_is() -> None:
    found = SimpleNamespace(stiffness_factor=0.8, filmed=SimpleNamespace(sheet=None))
    told = load_tissue("skin_forearm")
    assert session_run.relaxing_tissue(found, told) == session_run.fitted_tissue(found, told)
    assert session_run._told_otherwise(found, told) == ()


def test_a_run_says_that_its_specimen_relaxes_otherwise(monkeypatch) -> None:
    sheet = SimpleNamespace(relaxation=Relaxation(0.06, 1.5))
    found = SimpleNamespace(
        session=SimpleNamespace(name="day"), fit=None, warnings=(), filmed=SimpleNamespace(sheet=sheet)
    )
    monkeypatch.setattr(session_run, "fit_trials", lambda *_, **__: found)
    monkeypatch.setattr(
        session_run, "session_scenario", lambda *_, **__: (SimpleNamespace(tissue=load_tissue("skin_forearm")), ())
    )
    monkeypatch.setattr(session_run, "_predictions", lambda *_: ((), ()))
    monkeypatch.setattr(session_run, "run_scenario", lambda *_, warnings, **__: warnings)
    (said,) = session_run.run_session(None, None, {}, None, None)
    assert said.startswith("the relaxation found in the trials (g = 0.06, tau = 1.5 s)")


def test_the_press_goes_to_the_peak_of_the_trials_and_not_of_their_noise() -> None:
    random, time = np.random.default_rng(1), np.arange(200) / 20.0
    trials = [SimpleNamespace(key=n, time=time, force=0.3 + random.normal(0.0, 5e-3, 200)) for n in range(5)]
    fit = SimpleNamespace(trials=[SimpleNamespace(key=n, zero=0.1) for n in range(5)])
    found = session_run._median_peak(SimpleNamespace(trials=trials, fit=fit))
    assert found == pytest.approx(0.2, abs=1e-3)
