"""A dossier says what is shown, what speaks against the model, and what nobody has answered."""

import json
from pathlib import Path

import pytest

from benchmark.dossier import make_dossier
from benchmark.errors import InputError
from tests.benchmark.dossier.test_evidence import known_cases, run_result, verified

CONTEXT = """schema = 1
name = "trainer <b>"
question_of_interest = "Is the force right?"
context_of_use = "presses to 5 N"
model_influence = "high"
decision_consequence = "low"
quantities = ["deflection profile"]
[[evidence]]
question = "review"
says = "A second person read the inputs."
source = "lab book 12"
"""


@pytest.fixture
def verification(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    known_cases(monkeypatch, "hayes")
    return verified(tmp_path / "v", "hayes/ratio_1")


def statuses(folder: Path) -> dict[str, str]:
    document = json.loads((folder / "dossier.json").read_text())
    return {each["factor"]: each["status"] for each in document["factors"]}


def test_each_factor_stands_where_its_questions_do(tmp_path, verification) -> None:
    made = make_dossier([verification, run_result(tmp_path / "r")], None, tmp_path / "out")
    found = statuses(made.folder)
    assert len(found) == 13
    assert found["code_verification"] == "shown"
    assert found["solver"] == "shown"
    assert found["model_inputs"] == found["quantities"] == "missing"
    assert found["test_samples"] == "partly"
    assert found["output"] == "contradicted"
    assert "2 of 13" not in made.headline
    assert made.headline.endswith("have none")
    page = (made.folder / "report.html").read_text()
    assert "python -m benchmark check" in page
    assert "No context of use was given" in page


def test_the_context_answers_what_a_person_must(tmp_path, verification) -> None:
    (tmp_path / "context.toml").write_text(CONTEXT)
    made = make_dossier([verification], tmp_path / "context.toml", tmp_path / "out")
    document = json.loads((made.folder / "dossier.json").read_text())
    by_factor = {each["factor"]: each for each in document["factors"]}
    assert by_factor["use"]["evidence"][0]["says"] == "A second person read the inputs."
    assert by_factor["use"]["missing"] == ["inputs_kept"]
    assert by_factor["quantities"]["status"] == "contradicted"
    page = (made.folder / "report.html").read_text()
    assert "trainer &lt;b&gt;" in page
    assert "model influence high, decision consequence low" in page


def test_a_load_beyond_what_was_measured_is_told(tmp_path) -> None:
    run = run_result(tmp_path / "r")
    (run / "tables" / "measured.csv").write_text("trial,force_N\na,0.2\na,3.5\n")
    for most, status in (("3 N", "partly"), ("5 N", "contradicted")):
        (tmp_path / "context.toml").write_text(CONTEXT.replace("quantities", f'max_force = "{most}"\nquantities'))
        made = make_dossier([run], tmp_path / "context.toml", tmp_path / "out")
        assert statuses(made.folder)["relevance"] == status


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('question = "review"', 'question = "reviewed"', "is no question; allowed: versions, gate"),
        ('"high"', '"huge"', "line 5, model_influence"),
        ("name =", "nom =", "nom"),
        ("schema = 1", "schema = 2", "is not a schema"),
        ('["deflection profile"]', '["stress"]', "quantities"),
    ],
)
def test_a_wrong_context_is_refused_with_its_key(tmp_path, verification, old, new, told) -> None:
    (tmp_path / "context.toml").write_text(CONTEXT.replace(old, new))
    with pytest.raises(InputError, match=told):
        make_dossier([verification], tmp_path / "context.toml", tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_result_is_given_once_and_never_written_over(tmp_path, verification) -> None:
    with pytest.raises(InputError, match="given twice"):
        make_dossier([verification, verification], None, tmp_path / "out")
    with pytest.raises(InputError, match="which is read"):
        make_dossier([verification], None, verification)
    with pytest.raises(InputError, match="no result is given"):
        make_dossier([], None, tmp_path / "out")


def test_what_is_compared_with_another_code_is_not_taken_for_measured(tmp_path) -> None:
    folder = run_result(tmp_path / "r")
    (folder / "tables" / "profile.csv").write_text("layer,r_mm,fem_mm,wave_mm\n")
    (tmp_path / "context.toml").write_text(CONTEXT)
    made = make_dossier([folder], tmp_path / "context.toml", tmp_path / "out")
    assert "deflection profile: compared, code to code." in (made.folder / "report.html").read_text()
