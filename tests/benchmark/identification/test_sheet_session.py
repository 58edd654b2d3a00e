"""Force and markers fitted together, on sessions simulated anew without rendering any picture.

The hidden sheet is the shipped table; depths come in counts of the actuator, forces and markers with noise of the size
that the drivers and the tracker leave. The long test draws twenty sessions like the shipped one.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bench_hw.simulated.tabulated import TabulatedSpecimen, read_sheet
from benchmark.files import load_session
from benchmark.identification import Film, TrialData, filmed_trial, fit_session, fit_sheet
from benchmark.identification.fitted_parameters import sheet_parameters
from benchmark.identification.sheet_session import Pooled
from benchmark.response import CameraView
from benchmark.runs.options import Listener
from benchmark.runs.report.values import sheet_headline
from benchmark.runs.trials.session_tables import base_curves, session_sheets
from benchmark.sessions import SHIPPED
from benchmark.sessions.phantom_sheet import RELAXATION, TRUE_FACTOR

COUNT = 50e-3 / 1023
DEEP = 6.2e-3
PRESS = ((-2e-3, 1.0), (2e-3, 4.0), (0.0, 2.0), (-2e-3, 1.0))
RICH = (
    (-2e-3, 1.0), (0.0, 2.0), (2e-3, 1.0), (0.0, 1.0), (2e-3, 1.0), (0.0, 1.0), (2e-3, 1.0), (0.0, 1.0), (2e-3, 4.0),
    (2e-3, 6.0), (4e-3, 2.0), (0.0, 2.0), (-2e-3, 1.0),
)  # fmt: skip
"""Depth at the end of each stretch, m, and how long it takes, s."""


class Quiet:
    def say(self, text: str) -> None:
        pass

    def progress(self, title: str):
        from contextlib import nullcontext

        return nullcontext(lambda *_: None)


@pytest.fixture(scope="module")
def model():
    """The shipped specimen and its sheet under the phantom's tool, with the specimen's own (not the hidden) modulus."""
    session = load_session(Path(SHIPPED) / "phantom")
    setup = (session.specimen, session.tool, session.support)
    listener: Listener = Quiet()
    curve = base_curves(session, {setup: DEEP}, listener).curves[setup]
    sheets, warnings = session_sheets(session, {setup: DEEP}, CameraView(70e-3), listener)
    assert not warnings
    return session.specimen.layers, curve, sheets[setup]


def one_trial(name, stretches, curve, rng, relaxation=RELAXATION):
    """A trial and its film; its stiffness scatters by 2 %, its contact by 0.05 mm, its axis by 0.3 mm."""
    ends = np.cumsum([duration for _, duration in stretches])
    time = np.arange(0.0, ends[-1], 1e-3)
    depth = np.interp(time, [0.0, *ends], [-2e-3, *(end for end, _ in stretches)])
    specimen = TabulatedSpecimen(
        read_sheet("phantom"), relaxation, float(np.exp(rng.normal(0.0, 0.02))), tuple(rng.normal(0.0, 0.3e-3, 2))
    )
    answer = specimen(time, depth - rng.normal(0.0, 0.05e-3), 0)
    rows, frames = np.arange(5, len(time), 10), np.arange(40, len(time), 83)
    read = COUNT * np.round(depth / COUNT)
    force = answer.force[rows, 2] + rng.normal(0.0, 2e-3, len(rows))
    markers = answer.markers[frames]
    seen = CameraView(70e-3).seen(markers[..., :2], markers[..., 2])
    film = Film(time[frames], seen + rng.normal(0.0, 2e-6, seen.shape))
    return TrialData(name, "rich" if stretches is RICH else "press", time[rows], read[rows], force, curve), film


def one_session(model, rng, presses=10, rich=3, relaxation=RELAXATION):
    layers, curve, sheet = model
    made = [one_trial(f"press_{k}", PRESS, curve, rng, relaxation) for k in range(presses)]
    made += [one_trial(f"rich_{k}", RICH, curve, rng, relaxation) for k in range(rich)]
    alone = fit_session([trial for trial, _ in made], layers)
    starts = {trial.key: trial for trial in alone.trials}
    filmed = [(filmed_trial(trial, film), sheet) for trial, film in made]
    return alone, fit_sheet(filmed, starts)


@pytest.fixture(scope="module")
def small(model):
    return one_session(model, np.random.default_rng(1), presses=2, rich=2)


def test_modulus_and_relaxation_are_found(small) -> None:
    _, fit = small
    assert fit.stiffness.value == pytest.approx(TRUE_FACTOR, rel=0.05)
    assert fit.stiffness.low < TRUE_FACTOR < fit.stiffness.high
    (share, tau), *_ = RELAXATION
    assert fit.share is not None
    assert fit.tau is not None
    assert fit.share.value == pytest.approx(share, rel=0.1)
    assert fit.tau.value == pytest.approx(tau, rel=0.25)


def test_held_out_trials_are_predicted(small) -> None:
    _, fit = small
    assert max(each.force_percent for each in fit.held_out) < 5.0
    assert max(each.marker_mm for each in fit.held_out) < 0.05


def test_thickness_and_stiffness_are_not_told_apart_by_force_alone(small, model) -> None:
    alone, fit = small
    shallow = [each for each in fit.with_thickness if each.condition == "press"]
    assert all(abs(each.force_correlations["log_stiffness, log_thickness"]) > 0.99 for each in shallow)
    rows = {row.name: row for row in sheet_parameters(fit, model[0], alone.parameters)}
    assert not rows["thickness_factor"].identifiable
    assert "gauge of the thickness" in rows["thickness_factor"].source
    for name in ("thickness_factor", "stiffness_factor.thickness_free"):
        assert rows[name].ci95_low is None
    assert rows["silicone.youngs_modulus"].identifiable
    assert rows["silicone.youngs_modulus"].value == pytest.approx(400.0 * fit.stiffness.value)


def test_an_elastic_sheet_without_a_hold_has_no_relaxation_and_says_what_would_tell(model) -> None:
    alone, fit = one_session(model, np.random.default_rng(2), presses=2, rich=0, relaxation=())
    assert fit.share is None
    assert fit.relaxation.share == 0.0
    rows = {row.name: row for row in sheet_parameters(fit, model[0], alone.parameters)}
    assert rows["relaxation.g_1"].value is None
    assert "hold" in rows["relaxation.g_1"].source


def test_a_relaxation_that_may_be_none_has_no_interval_but_a_most(small, model) -> None:
    alone, fit = small
    unsure = replace(fit, share=Pooled(0.01, -0.02, 0.04, 3), tau=Pooled(1.0, 0.1, 9.0, 3))
    rows = {row.name: row for row in sheet_parameters(unsure, model[0], alone.parameters)}
    for name in ("relaxation.g_1", "relaxation.tau_1"):
        assert (rows[name].ci95_low, rows[name].identifiable) == (None, False)
        assert "not to be told from none (at most 0.04, 95 %)" in rows[name].source


def test_one_trial_is_said_in_the_singular(small, model) -> None:
    alone, fit = small
    lone = replace(fit, stiffness=replace(fit.stiffness, trials=1), trials=fit.trials[:1])
    assert sheet_headline(lone).startswith("force and markers of 1 trial together")
    rows = {row.name: row for row in sheet_parameters(lone, model[0], alone.parameters)}
    assert rows["contact_onset"].source.startswith("mean over 1 trial of")
    assert sheet_headline(fit).startswith(f"force and markers of {fit.stiffness.trials} trials together")


def test_a_time_that_one_trial_does_not_bound_has_no_upper_end(small) -> None:
    """A hold of an elastic sheet: its share is none, and the logarithm of its time has an error of thousands."""
    _, fit = small
    time = Pooled(0.2, -2e3, 2e3, 1).exp()
    assert (time.value, time.low, time.high) == (pytest.approx(1.2214, rel=1e-4), 0.0, np.inf)
    lone = replace(fit, share=Pooled(0.0, -1e-3, 1e-3, 1), tau=time)
    assert lone.relaxation.share == 0.0
    assert "relaxes" not in sheet_headline(lone)
    assert lone.to_dict()["relaxation_time_s"]["ci95"] == [0.0, np.inf]


def test_a_single_trial_without_standard_errors_identifies_nothing(small, model) -> None:
    alone, fit = small
    lone = replace(fit, stiffness=Pooled(1.0, 0.0, np.inf, 1))
    factor = next(iter(sheet_parameters(lone, model[0], alone.parameters)))
    assert (factor.ci95_low, factor.ci95_high, factor.identifiable) == (None, None, False)


def test_a_film_outside_the_trials_time_is_left_out(model) -> None:
    trial, film = one_trial("a", PRESS, model[1], np.random.default_rng(3))
    assert filmed_trial(trial, replace(film, time=film.time + 100.0)) is None


@pytest.mark.slow
def test_the_interval_holds_the_hidden_modulus_in_17_of_20_sessions(model) -> None:
    inside, errors = 0, []
    for seed in range(20):
        _, fit = one_session(model, np.random.default_rng(100 + seed))
        inside += fit.stiffness.low <= TRUE_FACTOR <= fit.stiffness.high
        errors.append(fit.stiffness.value / TRUE_FACTOR - 1.0)
        assert max(each.force_percent for each in fit.held_out) < 5.0
    print(f"inside {inside} of 20, errors {np.round(100 * np.array(errors), 2).tolist()} %")
    assert inside >= 17
    assert np.abs(errors).max() < 0.05
