import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter

import fem
from benchmark.cli.app import main
from benchmark.errors import InputError
from benchmark.files.sessions.fit_table import FitTable
from benchmark.identification.parameters import layer_fit
from benchmark.identification.parameters.free_parameters import value_of
from benchmark.identification.parameters.layer_fit import SEARCH, USUAL_SCATTER, begun, fit_layers
from benchmark.identification.parameters.layer_model import FitTrial
from benchmark.identification.parameters.mixed_effects import renoised
from benchmark.identification.parameters.profile_likelihood import profile
from benchmark.identification.parameters.session_problem import _specimens
from benchmark.identification.sheet_model import Relaxation, relaxed
from benchmark.identification.trial_data import TrialData, rows_of
from benchmark.identification.trial_features import contact_range
from benchmark.response.least_squares import least_squares
from benchmark.response.noise import whitener
from tests.benchmark.identification.parameters.conftest import MODULI, PLAIN, TISSUE, TOOLS, TRUTH, zeros_of


def errors(found):
    """(f,) logarithms of values over the truth, in standard errors."""
    spread = np.sqrt(np.diag(found.fit.covariance))
    free = [(k, one) for k, one in enumerate(found.problem.parameters) if one.key in TRUTH]
    return np.array([(found.vector[k] - np.log(TRUTH[one.key])) / spread[k] for k, one in free])


def test_two_tools_tell_three_moduli(toy_fit) -> None:
    fits = [toy_fit(seed=seed) for seed in (3, 4, 5)]
    assert all(one.settled for one in fits)
    assert np.sqrt(np.mean(np.square([errors(one) for one in fits]))) < fits[0].quantile
    assert fits[1].value(2) == pytest.approx(TRUTH["subcutaneous_fat.youngs_modulus"], rel=0.1)


def test_moduli_come_out_of_trials_with_hardly_any_noise(toy_fit) -> None:
    found = toy_fit(noise=1e-4, gain=0.0)
    assert [found.value(k) for k in range(3)] == pytest.approx(list(TRUTH.values()), rel=1e-2)


def remembering(problem, noise=0.01):
    """The problem with noise of a memory of 0.8, a share of each trial's peak."""
    generator = np.random.default_rng(6)

    def noisy(trial):
        shocks = noise * 0.6 * np.ptp(trial.data.force) * generator.normal(size=trial.data.rows)
        return replace(trial, data=replace(trial.data, force=trial.data.force + lfilter([1.0], [1.0, -0.8], shocks)))

    return replace(problem, trials=tuple(map(noisy, problem.trials)))


def test_the_noises_memory_is_that_of_what_ordinary_least_squares_leave(toy) -> None:
    """From a fit with memory it is found again, though noise of the depth has none."""
    problem = remembering(toy(noise=0.0))
    found = fit_layers(begun(problem, np.zeros(10), zeros_of(problem)))
    plain = replace(found.model, white=tuple(whitener(one.count, 0.0) for one in found.model.trials))
    ordinary = least_squares(plain, found.vector, found.fit.nuisance, search=SEARCH)
    assert found.memory == pytest.approx(0.8, abs=0.03)
    assert found.memory == pytest.approx(renoised(ordinary, problem.freedom)[1], abs=1e-5)
    assert found.memory != pytest.approx(renoised(found.fit, problem.freedom)[1], abs=3e-5)


def test_a_fit_ends_at_the_same_answer_wherever_it_takes_the_touch_to_be(toy) -> None:
    """A sharp beginning of the force leaves a corner of the likelihood at each row, and fits end in the next one."""
    problem = remembering(toy(noise=0.0))
    found = fit_layers(begun(problem, np.zeros(10), zeros_of(problem)))
    ends = []
    for touch in (-0.04, -0.02, 0.0, 0.02, 0.04):
        start = found.fit.nuisance + np.array([touch, 0.0, 0.0])
        ends.append(2.0 * least_squares(found.model, found.vector, start, search=SEARCH).objective)
    assert np.ptp(ends) < 0.1


@pytest.mark.parametrize(
    ("apart", "rounds", "settled"),
    [
        ([0.4, 0.2, 0.1, 0.014, 3e-3, 1e-3, 4e-5], 7, True),  # the gel pad's, whose start was a factor of five off
        ([0.4, 0.5, 0.4, 0.5, 0.02, 0.02], 6, False),
        ([0.4, 0.2, 0.1, 0.05, 0.02, 8e-3, 3e-3, 2e-3], 8, False),
    ],
)
def test_a_fit_that_comes_nearer_goes_on_and_one_that_does_not_stops(toy, monkeypatch, apart, rounds, settled) -> None:
    left = iter(apart)
    monkeypatch.setattr(layer_fit, "disagreement", lambda *_: next(left))
    problem = toy(trials=2)
    found = fit_layers(begun(problem, np.zeros(4), zeros_of(problem)))
    assert (found.rounds, found.settled) == (rounds, settled)


def test_the_scatter_of_trials_is_told_from_their_noise(toy_fit) -> None:
    calm, wild = (toy_fit(gain=gain, trials=8).model.gain_deviation for gain in (0.0, 0.05))
    assert calm < 0.5 * USUAL_SCATTER
    assert 0.03 < wild < 0.08


def test_trials_that_differ_by_far_leave_what_they_have_in_common_as_unsure(toy_fit) -> None:
    """Gains that stood at a bound of a factor of e held the common factor fast, whatever the trials scattered."""
    found = toy_fit(keys=("stiffness_factor",), tools=(0,), trials=9, gain=1.0)
    gains = found.fit.nuisance[:, 2]
    assert np.abs(gains).max() > 1.05
    own = profile(found, 0)
    assert 0.5 * (own.high - own.low) == pytest.approx(2.31 * gains.std(ddof=1) / 3.0, rel=0.15)


def test_a_layer_that_fades_takes_its_share_of_the_force_along(toy_fit) -> None:
    share, tau = 0.4, 2.0

    def fade(time, force, shares):
        part = (1.0 - (1.0 - share) ** shares[2]) * force
        return force - part + relaxed(time, part, Relaxation(1.0, tau))

    found = toy_fit(keys=(*MODULI, "subcutaneous_fat.relaxation"), noise=0.002, fade=fade)
    spread = np.sqrt(np.diag(found.fit.covariance))
    for k, truth in ((3, share), (4, tau)):
        assert abs(found.vector[k] - np.log(truth)) < 3.0 * spread[k] < 1.0
    assert np.abs(errors(found)).max() < 3.0


def test_a_common_factor_is_one_number(toy_fit) -> None:
    found = toy_fit(keys=("stiffness_factor",), truth={key: 1.3 * 0.5 * value for key, value in TRUTH.items()})
    assert found.problem.free == (0,)
    own = profile(found, 0)
    assert own.determined(found.vector[0])


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say(toy_fit) -> None:
    inside = []
    for seed in range(200, 260):
        found = toy_fit(seed=seed)
        own = [profile(found, k) for k in range(3)]
        truth = [np.log(TRUTH[key]) for key in MODULI]
        inside += [[one.low <= value <= one.high for one, value in zip(own, truth, strict=True)]]
    share = np.mean(inside, axis=0)
    assert (share >= 0.87).all()


def test_relaxation_of_all_layers_is_one_share_and_time(toy_fit) -> None:
    def fade(time, force, powers):
        part = 0.3 * force
        return force - part + relaxed(time, part, Relaxation(1.0, 3.0))

    told = {key: value_of(key, (TISSUE, TOOLS[0], None)) for key in MODULI}
    found = toy_fit(keys=("stiffness_factor", "relaxation"), noise=0.002, fade=fade, truth=told)
    values = {found.problem.parameters[k].key: found.value(k) for k in found.problem.free}
    assert values["relaxation.g"] == pytest.approx(0.3, rel=0.05)
    assert values["relaxation.tau"] == pytest.approx(3.0, rel=0.05)


def test_specimens_that_trials_are_of_are_told_by_a_pattern() -> None:
    names = ("a1", "a2", "b1", "b2_bis")
    trials = [SimpleNamespace(press=0, data=SimpleNamespace(name=name)) for name in names]
    wish = FitTable(free=("stiffness_factor",), specimen_pattern=r"^([a-z])\d")
    assert _specimens(trials, wish) == ("0: a", "0: a", "0: b", "0: b")
    for pattern, said in (("(", "no regular expression"), ("a", "a group"), ("(a)", "does not match")):
        with pytest.raises(InputError, match=said):
            _specimens(trials, wish.model_copy(update={"specimen_pattern": pattern}))


def test_rows_of_a_trial_of_many_cycles_hold_as_many_samples_as_they_are_means_of() -> None:
    """A stroke is followed by forty rows at least, so that of ten cycles some stand for all."""
    time = np.linspace(0.0, 40.0, 1999)
    depth = 1e-3 * (1.0 - np.cos(2.0 * np.pi * time / 4.0))
    trial = TrialData("many", "one", time, depth, 1e3 * depth, PLAIN)
    fitted = FitTrial.of(trial, 0, contact_range(trial.depth, trial.force))
    assert fitted.count.size == fitted.data.rows
    assert 0.2 * time.size < fitted.count.sum() < 0.5 * time.size
    assert FitTrial.of(rows_of(trial, slice(0, 100)), 0, fitted.touch).count.tolist() == [1.0] * 100


@pytest.mark.parametrize("keys", ["pad.relaxation", "relaxation"])
def test_a_compressible_layer_is_fitted_the_series_that_its_shear_modulus_has(tmp_path, keys) -> None:
    """In the finite elements shape relaxes alone: the force's own series had been told, 0.33 and 1.11 s here."""
    folder = tmp_path / "s"
    folder.mkdir()
    prony = (fem.PronyTerm(0.4, 1.0),)
    layer = fem.Layer("pad", 5e-3, 1e3, fem.NeoHookean(5e4, 0.45), prony)
    model = fem.prepare(fem.Problem((layer,), fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded")))
    draw, files = np.random.default_rng(0), []
    for number, speed in enumerate((1e-3, 1e-3, 2e-4, 2e-4)):
        time = np.concatenate([np.linspace(0.0, 3e-4 / speed, 25)[1:], 3e-4 / speed + np.linspace(0.0, 8.0, 80)[1:]])
        depth = np.minimum(speed * time, 3e-4)
        force = model.run(fem.Load("depth", time, depth)).force * (1.0 + 0.01 * draw.normal())
        rows = np.column_stack([time, 1e3 * depth, force + draw.normal(0.0, 2e-4, time.size)])
        files.append(f"t{number}.csv")
        lines = [f"{t:.6f},{d:.7f},{f:.7f}" for t, d, f in [(0.0, 0.0, 0.0), *rows]]
        (folder / files[-1]).write_text("\n".join(["time_s,depth_mm,force_N", *lines]))
    (folder / "pad.toml").write_text(
        'schema = 1\nname = "pad"\n[[layers]]\nname = "pad"\nthickness = "5 mm"\ndensity = "1000 kg/m^3"\n'
        'youngs_modulus = "50 kPa"\npoisson_ratio = 0.45\n'
    )
    trials = "".join(f'[[trials]]\nfile = "{one}"\ncondition = "c{int(one[1]) // 2}"\n' for one in files)
    (folder / "session.toml").write_text(
        'schema = 1\nname = "s"\nspecimen = "pad.toml"\n[tool]\nradius = "5 mm"\ncontact = "rigid_bonded"\n'
        f'[support]\nkind = "bonded"\n{trials}'
    )
    free = ("--free", f"pad.youngs_modulus,{keys}", "--exact", "all")
    assert main(["fit", str(folder), *free, "--out", str(tmp_path / "o"), "--quiet"]) == 0
    found = json.loads((tmp_path / "o" / "fit.json").read_text())["parameters"]
    assert found[f"{keys}.g"]["value"] == pytest.approx(0.4, rel=0.03)
    assert found[f"{keys}.tau"]["value"] == pytest.approx(1.0, rel=0.03)
