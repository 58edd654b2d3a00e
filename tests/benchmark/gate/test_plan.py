"""The plan: what measured processes are told, and what makes two plans comparable."""

from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.gate.plan import MEASURING, CheckRequest, load_plan, timed_text
from benchmark.sessions import SHIPPED


def test_paths_are_absolute_and_relative_to_the_gate_file(tiny_gate, monkeypatch: pytest.MonkeyPatch) -> None:
    gate = tiny_gate(timed=True)
    monkeypatch.chdir("/")
    plan = load_plan(gate.path)
    assert plan.cases[0]["scenario"] == str(gate.folder / "press.toml")
    assert plan.jobs[0]["own"] == str(gate.model)
    assert plan.references == ("dense",)
    assert not plan.shipped


def test_a_value_put_into_a_scenario_is_refused_by_its_gate_and_case(tiny_gate) -> None:
    """It was said to be of `--set`, which nobody had given."""
    gate = tiny_gate()
    gate.change("gate.toml", 'own = "my_model.py"', 'own = "my_model.py"\nset = { "load.peek" = "1 N" }')
    with pytest.raises(InputError, match=r"gate\.toml, springs: set load\.peek: this key is not known"):
        load_plan(gate.path)


def test_a_session_is_a_shipped_name_or_a_folder(tiny_gate) -> None:
    gate = tiny_gate()
    gate.change(
        "gate.toml", 'model = "wave"\nscenario = "press.toml"\nown = "my_model.py"', 'model = "fit"\nsession = "x"'
    )
    with pytest.raises(InputError, match="phantom"):
        load_plan(gate.path)
    (gate.folder / "x").mkdir()
    assert load_plan(gate.path).cases[0]["session"] == str(gate.folder / "x")
    gate.change("gate.toml", 'session = "x"', 'session = "phantom"')
    assert load_plan(gate.path).cases[0]["session"] == str(SHIPPED / "phantom")


@pytest.mark.parametrize(
    ("file", "old", "new", "same"),
    [
        ("gate.toml", 'rtol = "0.1 %"', 'rtol = "1 %"', True),
        ("gate.toml", "blocks = 2", 'blocks = 2\nmargin = "20 %"', True),
        ("my_model.py", "1e-3", "2e-3", True),
        ("gate.toml", 'references = ["dense"]', 'references = ["calls"]', False),
        ("gate.toml", 'references = ["dense"]', 'references = ["dense"]\ncalls = 3', False),
        ("gate.toml", 'references = ["dense"]', 'references = ["dense"]\nset = { "load.peak" = "2 N" }', False),
        ("press.toml", "observations = 10", "observations = 20", False),
    ],
)
def test_ratios_are_comparable_while_the_work_is_the_same(tiny_gate, file: str, old: str, new: str, same: bool) -> None:
    gate = tiny_gate(timed=True)
    before = load_plan(gate.path).fingerprint
    gate.change(file, old, new)
    assert (load_plan(gate.path).fingerprint == before) is same


def test_how_a_users_model_is_timed_is_in_its_fingerprint_alone(tiny_gate, monkeypatch) -> None:
    own, shipped = load_plan(tiny_gate(timed=True).path), load_plan(None)
    monkeypatch.setattr("benchmark.gate.plan.OWN_ALONE", "with what is read off it")
    assert load_plan(own.path).fingerprint != own.fingerprint
    assert load_plan(None).fingerprint == shipped.fingerprint


def test_another_revision_has_its_own_models_and_the_same_inputs(tiny_gate) -> None:
    gate = tiny_gate(timed=True)
    plan = load_plan(gate.path)
    moved = plan.moved(gate.folder, Path("/elsewhere"))
    assert moved.cases[0]["own"] == moved.jobs[0]["own"] == "/elsewhere/my_model.py"
    assert moved.cases[0]["scenario"] == plan.cases[0]["scenario"]
    assert moved.fingerprint == plan.fingerprint
    assert plan.moved(Path("/elsewhere"), Path("/there")) == plan


def test_a_history_is_a_file_a_folder_or_beside_the_baseline(tmp_path: Path) -> None:
    baseline = tmp_path / "b.json"
    assert CheckRequest(baseline).history_path == tmp_path / "b.history.jsonl"
    assert CheckRequest(baseline, history=tmp_path / "h").history_path == tmp_path / "h"
    assert CheckRequest(baseline, history=tmp_path).history_path == tmp_path / "history.jsonl"


def test_lines_that_decide_no_time_are_not_in_the_fingerprint() -> None:
    """Curves came into the measuring code, and no baseline's times were worth less for it."""
    code = "a\n    # no time: begin\n    b\n\n    # no time: end\nc\n# no time: begin\nd\n# no time: end\ne\n"
    assert timed_text(code) == "a\nc\ne\n"
    jobs = timed_text((MEASURING / "jobs.py").read_text(encoding="utf-8"))
    assert "def press_values" in jobs
    assert "_curves(" not in jobs
    assert "no time" not in jobs
