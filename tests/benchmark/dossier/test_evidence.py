"""Each kind of result answers the questions that it can, and says why an answer is worth less than it seems."""

import json
from pathlib import Path

import pytest

from benchmark.dossier.evidence import AGAINST, CIRCULAR, PARTIAL, SYNTHETIC, evidence_of, read_result
from benchmark.errors import InputError
from benchmark.verification.cases import Case
from reports import write_json, write_text, write_whole


def result(folder: Path, files: dict[str, object]) -> Path:
    def fill(new: Path) -> None:
        for name, content in files.items():
            if isinstance(content, str):
                write_text(new / name, content)
            else:
                write_json(new / name, content)

    write_whole(folder, fill)
    return folder


def answers(folder: Path) -> dict[str, list[tuple[str, tuple[str, ...]]]]:
    found: dict[str, list[tuple[str, tuple[str, ...]]]] = {}
    for each in evidence_of(read_result(folder)):
        found.setdefault(each.question, []).append((each.says, each.limits))
    return found


def known_cases(patch: pytest.MonkeyPatch, *names: str) -> None:
    """`verify` has cases of these names and no others."""
    cases = tuple(Case(name, "made up for a test", lambda: ()) for name in names)
    patch.setattr("benchmark.verification.cases.all_cases", lambda: cases)


def verified(folder: Path, *names: str, passed: bool = True) -> Path:
    """A result of `verify` with these rows."""
    rows = [{"case": name, "source": "Hayes 1972", "passed": passed or name != names[-1]} for name in names]
    return result(folder, {"verification.json": {"schema": 1, "cases": rows}})


def test_a_failed_case_speaks_against_the_code(tmp_path, monkeypatch) -> None:
    known_cases(monkeypatch, "hayes/ratio", "cook")
    ((says, limits),) = answers(verified(tmp_path / "v", "hayes/ratio/1", "cook", passed=False))["closed_forms"]
    assert says.startswith("1 of 2 values")
    assert limits == (AGAINST,)


def test_families_that_were_not_verified_are_told(tmp_path, monkeypatch) -> None:
    """Seven values of one family, none of the finite elements, had an answer to every question."""
    known_cases(monkeypatch, "hayes/ratio_1", "hayes/ratio_2", "cook", "wave_hayes")
    ((says, limits),) = answers(verified(tmp_path / "v", "hayes/ratio_1", "wave_hayes/far"))["closed_forms"]
    assert says.endswith("of 1 of 3 families. Not run: hayes, cook.")
    assert limits == (PARTIAL,)
    every = verified(tmp_path / "all", "hayes/ratio_1", "hayes/ratio_2", "cook", "wave_hayes/far")
    ((says, limits),) = answers(every)["closed_forms"]
    assert says.endswith("of 3 of 3 families.")
    assert limits == ()
    known_cases(monkeypatch, "cook", "cooked")
    assert "Not run: cook." in answers(verified(tmp_path / "like", "cooked"))["closed_forms"][0][0]


VALIDATION = """quantity,protocol,simulation,measure,value,unit
maximum of skin,verification,fem,mesh: u_num,0.004,mm
maximum of skin,verification,fem,load steps: u_num,0.001,mm
peak force,fitted to these trials (circular),fem,E,-0.001,N
peak force,fitted to these trials (circular),fem,u_val,0.004,N
peak force,fitted to these trials (circular),fem,not assessed,u_num,
peak force,"prediction, stiffness of the other trials",fem,E,0.09,N
peak force,"prediction, stiffness of the other trials",fem,u_val,0.01,N
peak force,"prediction, stiffness of the other trials",fem,not assessed,none,
"""


CONDITIONS = """condition,protocol,simulation,trials,D_N,E_N,u_num_N,u_input_N,u_D_N,u_val_N
shallow,fitted to these trials (circular),fem,3,2.0,0.01,,0.02,0.01,0.022
deep,fitted to these trials (circular),fem,3,4.0,-0.6,,0.1,0.02,0.102
"""


def test_a_condition_that_is_missed_speaks_against_the_model_beside_a_mean_that_is_not(tmp_path) -> None:
    folder = run_result(tmp_path / "r", conditions=CONDITIONS)
    found = [(says, limits) for says, limits in answers(folder)["agreement"] if "deep" in says or "shallow" in says]
    words = "fem, peak force of deep (fitted to these trials (circular)): -15 % off, |E| is 5.9 u_val."
    assert found == [(words, (AGAINST,))]


LONE = """quantity,protocol,simulation,measure,value,unit
peak force,fitted to these trials (circular),fem,E,-0.000452,N
peak force,fitted to these trials (circular),fem,u_val,{},N
peak force,fitted to these trials (circular),fem,not assessed,"u_num, u_D",
"""


@pytest.mark.parametrize("told", ["", "0.000221"])
def test_without_a_replicate_nothing_is_judged(tmp_path, told) -> None:
    """An u_val of the fitted stiffness alone spoke against a model that is right."""
    found = answers(run_result(tmp_path / "r", validation=LONE.format(told)))
    assert "agreement" not in found
    ((says, limits),) = found["rigour"]
    assert "no u_val without u_D, which needs a replicate; not assessed: u_num, u_D" in says
    assert PARTIAL in limits


def test_one_condition_is_judged_by_the_mean_of_all_alone(tmp_path) -> None:
    head, *rows = CONDITIONS.splitlines(keepends=True)
    lone = head + "".join(row for row in rows if row.startswith("deep"))
    found = answers(run_result(tmp_path / "r", conditions=lone))
    assert not any("peak force of deep" in says for says, _ in found["agreement"])


def test_conditions_without_a_replicate_are_not_judged(tmp_path) -> None:
    """They were, by the u_val that older results have there."""
    lone = CONDITIONS.replace(",0.1,0.02,0.102", ",0.1,,0.1")
    found = answers(run_result(tmp_path / "r", conditions=lone))
    assert not any("deep" in says for says, _ in found["agreement"])


def run_result(
    folder: Path, *, synthetic: bool = False, conditions: str = "", validation: str = VALIDATION, status: str = "good"
) -> Path:
    layer = {"percent_error_max": 0.2, "equivalent": True}
    document = {
        "schema": 1, "name": "skin", "complete": True, "equivalence_margin": 0.02,
        "models": {"fem": {"name": "FEM", "failure": None}, "wave": {"name": "wave model", "failure": None}},
        "comparison": {"dermis": layer, "fat": {**layer, "percent_error_max": 0.7}},
        "trials": {"session": "day", "synthetic": synthetic, "count": 4},
        "verdict": {"status": status, "headline": "Equivalent, but the profile is off by 60 %."},
    }  # fmt: skip
    more = {"tables/validation_conditions.csv": conditions} if conditions else {}
    return result(folder, {"results.json": document, "tables/validation.csv": validation, **more})


def test_a_run_tells_its_own_error_and_that_of_its_prediction(tmp_path) -> None:
    found = answers(run_result(tmp_path / "r"))
    assert found["refinement"] == [("fem: u_num up to 0.004 mm (maximum of skin, mesh).", ())]
    assert [limits for _, limits in found["agreement"]] == [(CIRCULAR,), (AGAINST,)]
    assert "9 u_val" in found["agreement"][1][0]
    assert len(found["unseen"]) == 1
    assert "0.7 % (fat)" in found["second_model"][0][0]


def test_what_the_page_of_a_run_has_against_its_models_stands_in_the_dossier(tmp_path) -> None:
    """A profile 60 % off, not green on the page, was equivalent without a limit here."""
    ((says, limits),) = answers(run_result(tmp_path / "good"))["second_model"]
    assert "60 %" not in says
    assert limits == ()
    ((says, limits),) = answers(run_result(tmp_path / "but", status="finding"))["second_model"]
    assert says.endswith("Equivalent, but the profile is off by 60 %.")
    assert limits == (AGAINST,)
    older = run_result(tmp_path / "older")
    document = json.loads((older / "results.json").read_text())
    del document["verdict"]
    (older / "results.json").write_text(json.dumps(document))
    ((says, limits),) = answers(older)["second_model"]
    assert "make the result again" in says
    assert limits == (PARTIAL,)


def test_what_comes_of_synthetic_trials_is_marked(tmp_path) -> None:
    found = answers(run_result(tmp_path / "r", synthetic=True))
    for question in ("sample_quantity", "same_press", "rigour", "unseen"):
        assert all(SYNTHETIC in limits for _, limits in found[question])


def test_a_parameter_that_is_not_determined_is_told_as_such(tmp_path) -> None:
    known = {"value": 61.2, "unit": "kPa", "ci95": [58.0, 64.0], "identifiable": True}
    lost = {"value": 1.0, "unit": "kPa", "ci95": None, "identifiable": False}
    document = {
        "schema": 1, "session": {"synthetic": False}, "trials": [1, 2, 3],
        "parameters": {"fat.youngs_modulus": known, "skin.youngs_modulus": lost},
    }  # fmt: skip
    told = answers(result(tmp_path / "f", {"fit.json": document}))["input_uncertainty"]
    assert told[0] == ("From 3 trials: fat.youngs_modulus 61.2 kPa [58, 64].", ())
    assert told[1] == ("Not determined by these trials: skin.youngs_modulus.", (AGAINST,))


def test_a_fit_of_one_factor_is_told_without_what_it_only_carries_along(tmp_path) -> None:
    row = {"unit": "", "ci95_low": 0.9, "ci95_high": 1.1, "value": 1.0, "identifiable": True}
    empty = {"ci95_low": None, "ci95_high": None, "identifiable": False, "unit": "kPa"}
    rows = [row | {"name": "stiffness_factor"}, row | empty | {"name": "fat.youngs_modulus"}]
    rows += [row | empty | {"name": "fat.thickness"}, row | {"name": "contact_onset"}]
    document = {"schema": 1, "session": {"synthetic": False}, "trials": [1, 2], "parameters": rows}
    told = answers(result(tmp_path / "f", {"fit.json": document}))["input_uncertainty"]
    assert told[0][0] == "From 2 trials: stiffness_factor 1 [0.9, 1.1]."
    assert told[1][0] == "Not determined by these trials: fat.youngs_modulus."


@pytest.mark.parametrize(
    ("verdict", "limits"), [("named", ()), ("partly_explained", (AGAINST,)), ("cannot_tell", (AGAINST,))]
)
def test_a_discovery_that_leaves_something_open_speaks_against_the_model(tmp_path, verdict, limits) -> None:
    gap = {"force_z": {"closed": 0.93}, "marker_x": {"closed": None}}
    document = {
        "schema": 1, "synthetic": False, "verdict": verdict, "statement": "The model lacks relaxation.", "gap": gap,
        "effects": [{"name": "viscoelastic_relaxation"}], "conditions": ["slow", "fast"], "trials": ["a", "b", "c"],
        "channels": ["force_z"], "own": [{"zero_N": -0.02, "late_ms": None, "touch_mm": 0.01}],
    }  # fmt: skip
    found = answers(result(tmp_path / "d", {"discovery.json": document}))
    assert found["missing_effect"] == [("The model lacks relaxation.", limits)]
    assert "force_z 93 %" in found["unseen"][0][0]
    assert found["condition_uncertainty"][0][0].startswith("Fitted to each of 1 trials: zero of the force up to 0.02 N")


def test_a_file_changed_since_is_told(tmp_path) -> None:
    folder = result(tmp_path / "c", {"check.json": {"schema": 1, "passed": True, "accuracy": [1], "timing": []}})
    (folder / "check.json").write_text(json.dumps({"schema": 1, "passed": True, "accuracy": [], "timing": []}))
    ((says, limits),) = answers(folder)["versions"]
    assert "check.json" in says
    assert limits == (AGAINST,)


def test_what_is_no_result_is_refused_by_name(tmp_path) -> None:
    with pytest.raises(InputError, match=r"is no result .* verification\.json"):
        read_result(tmp_path)
    (tmp_path / "fit.json").write_text("[")
    with pytest.raises(InputError, match=r"fit\.json cannot be read"):
        read_result(tmp_path)
    (tmp_path / "fit.json").write_text('{"schema": 7}')
    with pytest.raises(InputError, match="schema is 7; allowed: 1"):
        read_result(tmp_path)
    (tmp_path / "fit.json").write_text('{"schema": 1}')
    with pytest.raises(InputError, match="make the result again"):
        evidence_of(read_result(tmp_path))


@pytest.mark.parametrize(("within", "limits"), [(True, ()), (False, (AGAINST,))])
def test_two_models_are_judged_by_the_margin_over_the_history(tmp_path, within, limits) -> None:
    """Not by the test, whose outcome depends on the number of rows; of older results there is that alone."""
    folder = run_result(tmp_path / "r")
    document = json.loads((folder / "results.json").read_text())
    for entry in document["comparison"].values():
        entry |= {"equivalent": not within, "within_margin": within}
    (folder / "results.json").write_text(json.dumps(document))
    ((says, found),) = answers(folder)["second_model"]
    assert found == limits
    assert ("equivalence is not shown" in says) is not within


def test_two_models_are_called_by_their_names(tmp_path) -> None:
    folder = run_result(tmp_path / "r")
    document = json.loads((folder / "results.json").read_text())
    document["models"]["fem"]["name"] = "table of my code"
    (folder / "results.json").write_text(json.dumps(document))
    says = answers(folder)["second_model"][0][0]
    assert says.startswith("skin: wave model against table of my code within 0.7 % (fat)")
