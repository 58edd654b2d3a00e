"""A session of one silicone layer through the verb: what is written, and what is refused."""

import csv
import json
import math
import re
import shutil
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from benchmark.cli.app import main
from benchmark.errors import InputError
from benchmark.files import load_scenario, load_session, load_tissue
from benchmark.files.sessions.fit_table import FitTable
from benchmark.identification import FittingError
from benchmark.identification.parameters.layer_fit import LayerFit
from benchmark.identification.parameters.session_problem import assembled
from benchmark.response.differentiated_ramp import elastic_ramp
from benchmark.runs import fit_run, fitted_session, parameters_run
from benchmark.runs.fit_run import FitRecord, FitRequest, fit_to_folder
from benchmark.runs.fitted_session import FittedSession
from benchmark.runs.parameters_run import ParameterWish, with_setup
from benchmark.scripting import Unheard

SESSION = """schema = 1
name = "one layer"
specimen = "layer.toml"
synthetic = true
[tool]
radius = "5 mm"
contact = "rigid_bonded"
[support]
kind = "bonded"
[fit]
free = ["silicone.youngs_modulus"]
exact = ["all"]
"""
TISSUE = """schema = 1
name = "one layer"
[[layers]]
name = "silicone"
thickness = "12 mm"
density = "1000 kg/m^3"
youngs_modulus = "50 kPa"
poisson_ratio = 0.45
"""


@pytest.fixture
def session(tmp_path):
    folder, text = tmp_path / "session", SESSION
    folder.mkdir()
    generator = np.random.default_rng(5)
    for number in range(3):
        time = np.linspace(0.0, 10.0, 80)
        depth = np.interp(time, [0, 1, 5, 9, 10], [-0.1, 0.0, 1.0, 0.0, -0.1])
        force = 1.3 * np.maximum(depth, 0.0) * (1.0 + 0.01 * generator.normal()) + 0.004 * generator.normal(size=80)
        with (folder / f"press_{number}.csv").open("w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(("time_s", "depth_mm", "force_N"))
            rows.writerows(zip(time, depth, force, strict=True))
        text += f'[[trials]]\nfile = "press_{number}.csv"\ncondition = "slow"\n'
    (folder / "session.toml").write_text(text)
    (folder / "layer.toml").write_text(TISSUE)
    return folder


def fit(session, out, wish=None):
    request = FitRequest(session, settings={"fem.mesh": "coarse"}, wish=wish or ParameterWish())
    return fit_to_folder(request, out, Unheard())


def test_a_fit_of_parameters_writes_a_tissue_that_a_run_takes(session, tmp_path) -> None:
    outcome = fit(session, tmp_path / "out")
    found = json.loads((tmp_path / "out" / "fit.json").read_text())
    told = found["parameters"]["silicone.youngs_modulus"]
    assert told["identifiable"]
    assert told["ci95"][0] < told["value"] < told["ci95"][1]
    assert told["value"] == pytest.approx(50.0 * found["stiffness_factor"]["value"], rel=0.02)
    assert "silicone.youngs_modulus" in outcome.headline
    assert found["settled"]
    assert "silicone.youngs_modulus" in (tmp_path / "out" / "report.html").read_text()
    tissue = load_tissue(tmp_path / "out" / "identified.toml")
    assert tissue.layers[0].youngs_modulus == pytest.approx(1e3 * told["value"])
    assert 0.0 < tissue.uncertainties["silicone.youngs_modulus"] < 0.1
    assert "one layer" in tissue.citation
    scenario = load_scenario("phantom", {"tissue": str(tmp_path / "out" / "identified.toml")})
    assert scenario.tissue == tissue


def test_a_fit_that_does_not_settle_is_written_and_ends_with_exit_code_4(session, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(LayerFit, "settled", property(lambda _: False))
    out = tmp_path / "out"
    assert main(["fit", str(session), "--set", "fem.mesh=coarse", "--out", str(out), "--quiet"]) == 4
    printed = capsys.readouterr()
    assert printed.out.startswith("Not settled: 3 trials: silicone.youngs_modulus")
    assert "the fit did not settle" in printed.err
    assert str(out) in printed.err
    assert json.loads((out / "fit.json").read_text())["settled"] is False
    assert '"verdict incomplete"' in (out / "report.html").read_text()


def test_a_stiffness_that_still_moves_with_effects_in_the_fit_is_not_settled(monkeypatch) -> None:
    made = SimpleNamespace(settled=False, fit=SimpleNamespace(warnings=()), added={})
    monkeypatch.setattr(fitted_session, "fit_with_effects", lambda *_: made)
    repair, told = SimpleNamespace(slugs=("backlash",), name="model"), SimpleNamespace(warnings=(), followed={})
    assert not FitRecord(fitted_session._fitted_with(repair, told, (), told), repair, 0).settled


def in_contact(session, seed):
    """Presses that begin as the tool touches, of the finite elements' own force at 50 kPa."""
    trusting(session)
    made = load_session(session, {"fem.mesh": "coarse"})
    ramp = elastic_ramp(made, made.specimen, made.tool, made.support, 0.9e-3, 12)
    generator, depth = np.random.default_rng(seed), np.linspace(0.0, 0.8, 161)
    for number in range(3):
        force = CubicSpline(1e3 * ramp.depth, ramp.force)(depth) * (1.0 + 0.02 * generator.normal())
        force += 5e-4 * generator.normal(size=depth.size)
        rows = (f"{2.0 * d:.4f},{d:.5f},{f:.7f}" for d, f in zip(depth, force, strict=True))
        (session / f"press_{number}.csv").write_text("\n".join(["time_s,depth_mm,force_N", *rows]) + "\n")


@pytest.mark.parametrize("seed", [2, 4])
def test_records_that_begin_in_contact_have_the_interval_of_their_standard_error(session, tmp_path, seed) -> None:
    """Touch, zero and gain are nearly one there: an interval ended 0.07 standard errors away on one side."""
    in_contact(session, seed)
    fit(session, tmp_path / "out")
    found = json.loads((tmp_path / "out" / "fit.json").read_text())
    value, (low, high) = (found["parameters"]["silicone.youngs_modulus"][key] for key in ("value", "ci95"))
    assert low < 50.0 < high
    error = found["directions"][0]["standard_error"]
    halves = math.log(high / value) / error, math.log(value / low) / error
    assert 1.3 < min(halves) < max(halves) < 4.5


def plainly(session, out, **settings):
    """fit.json of a fit of one stiffness under a flat tool that slides, whose edge nobody told."""
    told = {"fem.mesh": "coarse", "tool.contact": "rigid_frictionless", **settings}
    fit_to_folder(FitRequest(session, settings=told, wish=ParameterWish(free=())), out, Unheard())
    return json.loads((out / "fit.json").read_text())


def trusting(session, *keys):
    text = (session / "session.toml").read_text()
    (session / "session.toml").write_text(text.replace('exact = ["all"]', f"exact = {json.dumps(keys)}"))


THICKNESS, POISSON = "silicone.thickness", "silicone.poisson_ratio"


@pytest.mark.parametrize(
    ("trusted", "settings", "share"),
    [
        (("tool.edge_radius", THICKNESS, POISSON), {"tool.radius": "5.05 mm", "tool.edge_radius": "0.5 mm"}, 0.01),
        (("tool.radius", THICKNESS, POISSON), {"tool.edge_radius": "0.55 mm"}, 0.1 * 3.0**0.5),
        (("tool.radius", "tool.edge_radius", POISSON), {THICKNESS: "12.42 mm"}, 0.035),
    ],
)
def test_the_wider_interval_is_what_fits_with_another_set_up_say(session, tmp_path, trusted, settings, share) -> None:
    trusting(session, *trusted)
    plain, moved = plainly(session, tmp_path / "plain"), plainly(session, tmp_path / "moved", **settings)
    scatter, wide = plain["stiffness_factor"], plain["with_setup_uncertain"]
    value = scatter["value"]
    assert wide["value"] == value
    own = abs(math.log(moved["stiffness_factor"]["value"] / value))
    unit = {0.01: 1.0, 0.035: 1.0}.get(share, 1.0 / share)
    said = 0.01 * float(re.search(r"told: \S+ ([\d.]+) %$", wide["interval"])[1])
    assert said == pytest.approx(own * unit, rel=0.15)
    assert wide["ci95"][0] < scatter["ci95"][0]
    assert wide["ci95"][1] > scatter["ci95"][1]


def test_what_is_exact_leaves_the_scatter_of_the_trials_alone(session, tmp_path) -> None:
    assert plainly(session, tmp_path / "out")["with_setup_uncertain"] is None


def test_a_trial_that_another_set_up_leaves_without_contact_ends_nothing(session, tmp_path, monkeypatch) -> None:
    """A constant weight was fitted, and ended in a fault of the program as the set-up was moved."""

    def none(trial):
        raise FittingError(f"{trial.label}: no force rises")

    trusting(session, "tool.edge_radius", THICKNESS, POISSON)
    monkeypatch.setattr(parameters_run, "fit_trial", none)
    found = plainly(session, tmp_path / "out")
    assert found["with_setup_uncertain"] is None
    assert any("was not worked out: trial" in text for text in found["warnings"])


def test_two_tools_are_wrong_each_for_itself(session, tmp_path) -> None:
    """Half the trials under each: the mean stiffness moves by less than under one tool."""

    def radius_moves(found):
        return float(re.search(r"tool.radius ([\d.]+) %", found["with_setup_uncertain"]["interval"])[1])

    trusting(session, "tool.edge_radius", THICKNESS, POISSON)
    one = radius_moves(plainly(session, tmp_path / "one"))
    file = session / "session.toml"
    more = 'condition = "other"\n[conditions.other.tool]\nradius = "5.01 mm"\n'
    listed = file.read_text().rstrip().removesuffix('condition = "slow"')
    file.write_text(listed + more)
    own, others = 2.0 / 3.0, 1.0 / 3.0
    two = radius_moves(plainly(session, tmp_path / "two"))
    assert two == pytest.approx(one * math.hypot(own, others), rel=0.1)


def test_a_stiffness_of_force_and_markers_is_left_as_it_is() -> None:
    name, sheet = SimpleNamespace(name="a"), SimpleNamespace(sheet=object())
    filmed = FittedSession(name, None, (), ("before",), {}, filmed=sheet)
    assert with_setup(filmed, (), Unheard()) == filmed
    first, said = with_setup(filmed, ("tool.radius",), Unheard()).warnings
    assert first == "before"
    assert said.startswith("exact tool.radius is passed over: with markers")


def test_what_is_exact_is_refused_where_a_model_file_leaves_it_without_use(session, tmp_path, nothing_computed) -> None:
    (tmp_path / "model.toml").write_text(MODEL)
    wish = ParameterWish(free=(), exact=("tool.radius",))
    with pytest.raises(InputError, match=r"^exact tool\.radius is of no use with --model"):
        fit_to_folder(FitRequest(session, model=tmp_path / "model.toml", wish=wish), tmp_path / "out", Unheard())


def test_with_effects_in_the_fit_nothing_of_the_elastic_set_up_is_said(monkeypatch) -> None:
    """Its derivatives are those of the force without the effects."""

    def asked(*_):
        pytest.fail("the set-up was asked")

    found = SimpleNamespace(session=SimpleNamespace(fit=FitTable()), warnings=())
    monkeypatch.setattr(fit_run, "load_repair", lambda *_: "repair")
    monkeypatch.setattr(fit_run, "fit_trials", lambda *_, **__: found)
    monkeypatch.setattr(fit_run, "with_setup", asked)
    monkeypatch.setattr(fit_run, "common_factor_warnings", asked)
    record = fit_run.carry_out_fit(FitRequest(Path("session"), model=Path("model.toml")), Unheard())
    assert record.found is found


def test_an_edge_that_nobody_told_is_uncertain_and_one_that_was_told_is_not(session, tmp_path) -> None:
    trusting(session)
    assumed = plainly(session, tmp_path / "assumed")["with_setup_uncertain"]
    told = plainly(session, tmp_path / "told", **{"tool.edge_radius": "0.5 mm"})["with_setup_uncertain"]
    assert "tool.edge_radius" in assumed["interval"]
    assert "tool.edge_radius" not in told["interval"]
    assert assumed["ci95"][0] < told["ci95"][0]
    stated = plainly(session, tmp_path / "stated", **{"tool.edge_radius": "0.5 mm +/- 0.1 mm"})["with_setup_uncertain"]
    assert "tool.edge_radius" in stated["interval"]
    assert assumed["ci95"][1] > stated["ci95"][1] > told["ci95"][1]


def test_what_is_assumed_of_a_further_session_is_said_with_its_name(session, tmp_path) -> None:
    other = tmp_path / "other"
    shutil.copytree(session, other)
    file = other / "session.toml"
    text = file.read_text().replace('name = "one layer"', 'name = "day two"')
    file.write_text(text.replace('radius = "5 mm"\n', "").replace('[support]\nkind = "bonded"\n', ""))
    outcome = fit(session, tmp_path / "out", ParameterWish(sessions=(other,)))
    assert any(each.startswith("day two: the tool's radius is not given") for each in outcome.warnings)
    assert any(each.startswith("day two: the support is not given") for each in outcome.warnings)
    assert len(set(outcome.warnings)) == len(outcome.warnings)


def test_what_is_said_takes_the_place_of_the_sessions_table() -> None:
    own = FitTable(free=("a",), law="yeoh", exact=("all",))
    table = ParameterWish(free=("b", "c"), forward="wave").table(own)
    assert (table.free, table.law, table.forward, table.exact) == (("b", "c"), "yeoh", "wave", ("all",))


@pytest.mark.parametrize(
    ("wish", "named"),
    [
        (ParameterWish(free=("bone.youngs_modulus",)), "bone.youngs_modulus"),
        (ParameterWish(laws=("rubber",)), "law"),
        (ParameterWish(free=(), laws=("yeoh",)), "--free"),
    ],
)
def test_what_cannot_be_fitted_is_refused_by_its_name(session, tmp_path, wish, named) -> None:
    with pytest.raises(InputError, match=named):
        fit(session, tmp_path / "out", wish)
    assert not (tmp_path / "out").exists()


@pytest.fixture
def nothing_computed(monkeypatch):
    def computed(*_):
        pytest.fail("the finite elements were at work")

    monkeypatch.setattr("benchmark.runs.fitted_session.base_curves", computed)


@pytest.mark.parametrize(
    ("wish", "says"),
    [
        (ParameterWish(forward="fea"), "--forward, forward: 'fea' is not allowed; allowed: 'fem' or 'wave'"),
        (ParameterWish(laws=("yeoh", "gentt")), "--law gentt: no such law; allowed: neo_hookean"),
        (
            ParameterWish(free=("youngs_modulus",)),
            "--free youngs_modulus: this specimen and set-up have no such number",
        ),
        (ParameterWish(free=("silicone.density",)), "--free silicone.density: no force depends on it"),
        (ParameterWish(free=(), laws=("yeoh",)), "a law or a posterior need free parameters: give --free"),
        (ParameterWish(free=("silicon.relaxation",)), "--free silicon.relaxation: this specimen"),
        (ParameterWish(free=("tool.radios",)), r"--free tool.radios: .* tool.radius, tool.edge_radius, support.hole"),
        (ParameterWish(free=("tool.tilt",)), "--free tool.tilt: this specimen and set-up have no such number"),
        (ParameterWish(free=("support.hole_radius",)), "--free support.hole_radius: this specimen and set-up have"),
        (ParameterWish(free=("law.c20_over_c10",), laws=("gent",)), "--free law.c20_over_c10: the fit has no such law"),
    ],
)
def test_what_is_mistyped_is_refused_before_anything_is_computed(session, tmp_path, nothing_computed, wish, says):
    with pytest.raises(InputError, match=says):
        fit(session, tmp_path / "out", wish)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (
            '[fit.fixed]\n"silicone.youngs_module" = "50 kPa"\n',
            r"\[fit.fixed\] silicone.youngs_module: .* did you mean silicone.youngs_modulus\? allowed: LAYER",
        ),
        ('[fit.fixed]\n"silicone.density" = 1200\n', r"\[fit.fixed\] silicone.density: no force depends on it"),
        ('[fit.fixed]\n"tool.tilt" = "3 deg"\n', r"\[fit.fixed\] tool.tilt: this specimen and set-up have no such"),
        (
            '[fit.bounds]\n"silicon.youngs_modulus" = ["5 kPa", "200 kPa"]\n',
            r"\[fit.bounds\] silicon.youngs_modulus: .* is free \(--free\); did you mean silicone.youngs_modulus\?",
        ),
        (
            '[fit.bounds]\n"silicone.youngs_modulus" = ["200 kPa", "5 kPa"]\n',
            r"\[fit.bounds\] silicone.youngs_modulus: allowed are two values above 0, the lower one first",
        ),
        (
            '[fit.priors]\n"silicone.thicknes" = { value = "12 mm +/- 5 %", source = "gauge" }\n',
            r"\[fit.priors\] silicone.thicknes: this is not among what is free \(--free\); known: silicone.youngs_mod",
        ),
        (
            '[fit.priors]\n"silicone.youngs_modulus" = { value = "12 kPa", source = "gauge" }\n',
            r"\[fit.priors\] silicone.youngs_modulus: give a value with its uncertainty",
        ),
    ],
)
def test_what_a_session_tells_of_a_fit_is_refused_before_anything_is_computed(
    session, tmp_path, nothing_computed, table, says
):
    file = session / "session.toml"
    text = file.read_text().replace("[[trials]]", f"{table}[[trials]]", 1)
    file.write_text(text)
    with pytest.raises(InputError, match=f"^{file}: {says}"):
        fit(session, tmp_path / "out")
    other = tmp_path / "fit.toml"
    other.write_text("[fit]\nfree = ['silicone.youngs_modulus']\n" + table)
    file.write_text(SESSION + text[text.index("[[trials]]") :])
    with pytest.raises(InputError, match=f"^{other}: {says}"):
        fit(session, tmp_path / "out", ParameterWish(file=other))


def test_a_mistyped_key_of_what_is_exact_is_refused(session, tmp_path, nothing_computed) -> None:
    """It was passed over, and the value kept its uncertainty."""
    file = session / "session.toml"
    file.write_text(file.read_text().replace('exact = ["all"]', 'exact = ["tool.radius", "silicone.thicknes"]'))
    says = r"exact silicone.thicknes: nothing of that name is told of these trials; did you mean silicone.thickness"
    with pytest.raises(InputError, match=rf"^{file}: \[fit\] {says}"):
        fit(session, tmp_path / "out")
    with pytest.raises(InputError, match=r"^--exact tool.radios: nothing of that name .* did you mean tool.radius"):
        fit(session, tmp_path / "out", ParameterWish(exact=("tool.radios",)))
    with pytest.raises(InputError, match=r"^--exact tool.radios: nothing of that name"):
        fit(session, tmp_path / "out", ParameterWish(free=(), exact=("tool.radios",)))
    ParameterWish(exact=("tool.radius", "silicone.poisson_ratio", "all")).check(load_session(session))
    both = [SimpleNamespace(session=load_session(session))] * 2  # of several sessions the keys are known later
    with pytest.raises(InputError, match=r"^\[fit\] exact silicone.thicknes: nothing of that name"):
        assembled(both, FitTable(free=("silicone.youngs_modulus",), exact=("silicone.thicknes",)))


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ('[fit.fixed]\n"silicone.poisson_ratio" = 0.48', r"\[fit.fixed\] silicone.poisson_ratio"),
        ('[fit.bounds]\n"tool.radius" = ["4 mm", "6 mm"]', r"\[fit.bounds\] tool.radius"),
        ('[fit.priors]\n"tool.radius" = { value = "5 mm +/- 5 %", source = "x" }', r"\[fit.priors\] tool.radius"),
    ],
)
def test_what_only_a_fit_of_parameters_uses_is_refused_without_any(session, tmp_path, nothing_computed, table, says):
    """It was passed over without a word."""
    file = session / "session.toml"
    free, text = 'free = ["silicone.youngs_modulus"]\nexact = ["all"]\n', file.read_text()
    assert free in text
    file.write_text(text.replace(free, f"{table}\n"))
    with pytest.raises(InputError, match=rf"^{file}: {says}: without free parameters this is of no use; give free"):
        fit(session, tmp_path / "out")


MODEL = """schema = 1
[base]
tissue = "layer"
model = "wave"
[[effects]]
name = "machine_compliance"
[effects.parameters]
compliance = "3 um/N"
"""


@pytest.mark.parametrize(
    ("free", "says"),
    [
        ("tool.radios", "--free tool.radios: this specimen and set-up have no such number"),
        (
            "tool.radius",
            "--free and --model do not go together.*leave --model out.*--free KEY,relaxation, or --law yeoh",
        ),
    ],
)
def test_what_goes_with_no_model_file_is_refused_before_anything_is_computed(
    session, tmp_path, nothing_computed, free, says
):
    model = tmp_path / "model.toml"
    model.write_text(MODEL)
    with pytest.raises(InputError, match=says):
        fit_to_folder(FitRequest(session, model=model, wish=ParameterWish(free=(free,))), tmp_path / "out", Unheard())


def test_a_format_that_cannot_be_written_is_refused_before_anything_is_computed(session, tmp_path, nothing_computed):
    with pytest.raises(InputError, match="--export odb: no such format"):
        fit_to_folder(FitRequest(session, export=("odb",)), tmp_path / "out", Unheard())


def test_a_posterior_without_emcee_is_refused_before_anything_is_computed(
    session, tmp_path, nothing_computed, monkeypatch
):
    """The whole fit ran first, and left nothing."""
    monkeypatch.setitem(sys.modules, "emcee", None)
    with pytest.raises(InputError, match="emcee, which is not installed"):
        fit(session, tmp_path / "out", ParameterWish(free=("silicone.youngs_modulus",), posterior=True))
