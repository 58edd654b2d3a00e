"""The gate file: what it must say, and what is refused."""

import tomllib
from pathlib import Path

import pytest
from pydantic import ValidationError

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.gate.gate_file import GateFile, Timing, Tolerance, gate_path
from benchmark.gate.plan import load_plan


def test_the_shipped_gate_covers_every_model_and_the_three_speeds() -> None:
    file = load_plan(None).file
    assert {case.model for case in file.cases} == {"fem", "wave", "fit", "track", "discover"}
    assert {"wave_frame", "fem_assembly", "history", "fit"} == {timed.workload for timed in file.timed}
    assert {timed.model for timed in file.timed if timed.workload == "history"} == {"fem", "wave"}


def test_the_shipped_gate_covers_what_a_run_does() -> None:
    pressed = [case for case in load_plan(None).cases if case["scenario"]]
    scenarios = {(case["model"], case["name"]): load_scenario(case["scenario"], case["set"]) for case in pressed}
    for model in ("fem", "wave"):
        mine = [scenario for (one, _), scenario in scenarios.items() if one == model]
        assert {"linear", "finite"} == {scenario.fem.kinematics for scenario in mine}
        assert {"bonded", "hole"} == {scenario.support.kind for scenario in mine}
        assert {"uniform_pressure", "rigid_bonded", "rigid_frictionless"} <= {each.tool.contact for each in mine}
    assert {"axisymmetric", "block"} == {scenario.fem.geometry for scenario in scenarios.values()}


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('model = "wave"', 'model = "discover"', "needs an expected effect"),
        ('model = "wave"', 'model = "wave"\nexpected = "adhesion"', "no use for an expected effect"),
    ],
)
def test_a_discovery_and_nothing_else_has_an_expected_effect(tiny_gate, old: str, new: str, words: str) -> None:
    gate = tiny_gate()
    gate.change("gate.toml", old, new)
    with pytest.raises(InputError, match=words):
        load_plan(gate.path)


def test_its_margins_are_half_of_a_quarter_and_of_a_tenth() -> None:
    timing = load_plan(None).file.timing
    assert 0.10 <= timing.margin <= 0.125
    assert 0.045 <= timing.margin_against <= 0.05
    assert timing.rounds[0] >= 3


def test_the_example_in_the_docstring_is_a_gate_file() -> None:
    from benchmark.gate import gate_file

    lines = [line[4:] for line in str(gate_file.__doc__).splitlines() if line.startswith("    ")]
    table = tomllib.loads("\n".join(lines))
    assert GateFile.model_validate(table, context={"from_file": True, "folder": Path()}).timed[0].calls == 2


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("rounds = [1, 1]", "rounds = [3, 2]", "rounds"),
        ("blocks = 2", "blocks = 0", "blocks"),
        ("blocks = 2", "block = 2", "block"),
        ('rtol = "0.1 %"', 'rtol = "1 mm"', "rtol"),
        ('model = "wave"', 'model = "fem"', "wave's place"),
        ('model = "wave"', 'model = "fit"', "session"),
        ('scenario = "press.toml"', 'session = "phantom"', "scenario"),
        ('scenario = "press.toml"', 'scenario = "pres.toml"', "pres.toml"),
        ('own = "my_model.py"', 'own = "no_model.py"', "no_model.py"),
        ('scenario = "press.toml"', 'scenario = "press.toml"\nset = { "load.peek" = "1 N" }', "load.peek"),
        ("schema = 1", "schema = 2", "schema"),
        ('name = "springs"', 'name = "springs"\nseconds = 3', "seconds"),
    ],
)
def test_mistakes_are_named(tiny_gate, old: str, new: str, words: str) -> None:
    gate = tiny_gate()
    gate.change("gate.toml", old, new)
    with pytest.raises(InputError, match=words):
        load_plan(gate.path)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('references = ["dense"]', "references = []", "references"),
        ('references = ["dense"]', 'references = ["sparse"]', "references"),
        ('workload = "history"', 'workload = "fit"', "session"),
        ('name = "springs.history"', 'name = "springs.history"\nmodel = "fem"', "wave's place"),
    ],
)
def test_mistakes_in_what_is_timed_are_named(tiny_gate, old: str, new: str, words: str) -> None:
    gate = tiny_gate(timed=True)
    gate.change("gate.toml", old, new)
    with pytest.raises(InputError, match=words):
        load_plan(gate.path)


def test_a_name_must_not_be_there_twice(tiny_gate) -> None:
    gate = tiny_gate()
    text = gate.path.read_text()
    gate.path.write_text(text + text[text.index("[[cases]]") :])
    with pytest.raises(InputError, match="springs"):
        load_plan(gate.path)


def test_missing_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.toml"):
        load_plan(tmp_path / "nowhere.toml")


def test_defaults_are_those_of_the_shipped_gate() -> None:
    shipped = load_plan(gate_path(None)).file.timing
    assert shipped == Timing()


@pytest.mark.parametrize("atol", ["abc", "1 parsec_", "-1 nm", "nan mm", ""])
def test_a_tolerance_is_a_quantity(atol):
    with pytest.raises(ValidationError, match=r"tolerance|name"):
        Tolerance.model_validate({"quantity": "*", "rtol": "1 %", "atol": atol}, context={"from_file": True})
