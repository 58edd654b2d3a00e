"""`benchmark check` from the command line: exit codes, what is printed, what is left behind."""

import json
import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from benchmark.cli.app import main
from benchmark.gate.versions import PRODUCT

AUTHOR = ("-c", "user.name=test", "-c", "user.email=test@localhost")
MODEL = """\
import numpy as np


def deform(layers, tool, support, time, force):
    return np.outer(force, [1e-3])
"""

SCENARIO = """\
schema = 1
name = "press"
[tissue]
schema = 1
name = "one layer"
[[tissue.layers]]
name = "skin"
thickness = "10 mm"
density = "1100 kg/m^3"
youngs_modulus = "50 kPa"
poisson_ratio = 0.48
[tool]
radius = "5 mm"
[load]
peak = "5 N"
observations = 10
"""

GATE = """\
schema = 1
name = "tiny"
[timing]
rounds = [1, 1]
blocks = 2
[[tolerances]]
quantity = "*"
rtol = "0.1 %"
atol = "1 nm"
[[cases]]
name = "spring"
model = "wave"
scenario = "press.toml"
own = "my_model.py"
[[timed]]
name = "spring.history"
workload = "history"
scenario = "press.toml"
own = "my_model.py"
references = ["dense"]
"""


BASELINE = "tissuebench-baseline.json"


def write_gate(folder: Path) -> None:
    for name, text in {"gate.toml": GATE, "press.toml": SCENARIO, "my_model.py": MODEL}.items():
        (folder / name).write_text(text)


@pytest.fixture
def call(benchmark_cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """`check` with a tiny gate, in a folder of its own."""
    write_gate(tmp_path)
    monkeypatch.chdir(tmp_path)
    return lambda *arguments: benchmark_cli("check", "--gate", "gate.toml", *arguments)


@pytest.fixture(scope="module")
def accepted(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The baseline that `check --accept` writes, measured once."""
    folder = tmp_path_factory.mktemp("accepted")
    write_gate(folder)
    files = ("--gate", str(folder / "gate.toml"), "--baseline", str(folder / BASELINE))
    assert main(["check", *files, "--accept", "--quiet"]) == 0
    return (folder / BASELINE).read_text()


@pytest.fixture
def baseline(accepted: str, call) -> None:
    """It stands in the folder."""
    Path(BASELINE).write_text(accepted)


def change(path: str, table_change: Callable[[dict], None]) -> None:
    table = json.loads(Path(path).read_text())
    table_change(table)
    Path(path).write_text(json.dumps(table))


def paragraph(called) -> str:
    assert "Traceback" not in called.err
    return " ".join(called.err.split())


def test_the_first_run_says_how_to_make_a_baseline(call) -> None:
    called = call()
    assert called.code == 3
    assert called.out == ""
    typed = "python -m benchmark check --gate gate.toml --baseline tissuebench-baseline.json --accept"
    assert typed in paragraph(called)
    assert not [path for path in Path("results").glob("*") if not path.name.endswith(".lock")]  # until the process ends


def test_accept_then_check(call) -> None:
    accepted = call("--accept")
    assert accepted.code == 0
    assert "spring.max_deformation_mm.skin: none -> 5 mm" in accepted.out
    assert Path("tissuebench-baseline.json").is_file()
    change("tissuebench-baseline.json", lambda table: table["timing"]["spring.history"].update(ratios=[1e9]))
    checked = call()
    assert checked.code == 0, checked.err
    assert "Nothing got worse" in checked.out
    report = checked.out.split("report: ")[1].strip()
    assert Path(report).is_file()
    assert "checks" not in checked.err


def test_accepting_other_values_prints_that_nothing_was_checked(call, baseline) -> None:
    Path("my_model.py").write_text(MODEL.replace("1e-3", "1.01e-3"))
    again = call("--accept")
    assert again.code == 0, again.err
    assert "accepted, not checked: 1 gated value (spring.max_deformation_mm.skin) differs" in again.out


@pytest.mark.parametrize("option", ["--junit", "--markdown", "--out"])
def test_a_report_is_not_made_where_a_baseline_is(call, option: str) -> None:
    """It was passed over without a word."""
    called = call("--accept", option, "x")
    assert called.code == 2
    assert f"--accept makes a baseline and no report: leave out {option}, or check afterwards" in paragraph(called)
    assert not Path(BASELINE).exists()


def test_a_deflection_off_by_one_per_cent_is_exit_one(call, baseline) -> None:
    change("tissuebench-baseline.json", lambda table: table["timing"]["spring.history"].update(ratios=[1e9]))
    Path("my_model.py").write_text(MODEL.replace("1e-3", "1.01e-3"))
    called = call("--json", "--quiet", "--out", "out", "--junit", "ci/check.xml", "--markdown", "ci/check.md")
    assert called.code == 1
    assert 'failures="1"' in Path("ci/check.xml").read_text()
    assert Path("ci/check.md").read_text().startswith("### ❌ Regression check")
    document = json.loads(called.out)
    assert document["passed"] is False
    assert document["accuracy"][0]["passed"] is False
    assert document.pop("out") == "out"
    assert document == json.loads(Path("out/check.json").read_text())
    text = paragraph(called)
    assert "spring.max_deformation_mm.skin: baseline 5 mm, now 5.05 mm, allowed a difference of 0.005" in text


def test_slower_is_exit_one(call, baseline) -> None:
    change("tissuebench-baseline.json", lambda table: table["timing"]["spring.history"].update(ratios=[1e-9]))
    change("tissuebench-baseline.json", lambda table: table["machine"].update(processor="another"))
    called = call()
    assert called.code == 1
    assert "warning: the baseline's times come from another machine" in paragraph(called)
    assert "spring.history: baseline 1e-09 x the reference workload" in paragraph(called)
    assert "slower" in called.out


def test_a_folder_in_the_place_of_a_ci_file_is_found_before_measuring(call) -> None:
    Path("here").mkdir()
    called = call("--junit", "here")
    assert called.code == 2
    assert "--junit here is a folder" in paragraph(called)


def test_files_of_somebody_elses_are_not_replaced(call) -> None:
    for words in (
        ("--junit", "mine"), ("--markdown", "mine"), ("--history", "mine"), ("--accept", "--baseline", "mine"),
        ("--accept", "--history", "mine"),
    ):  # fmt: skip
        Path("mine").write_text('{"a": 1}\n')
        called = call("--quiet", *words)
        assert called.code == 2, words
        assert "mine is there and is not" in paragraph(called)
        assert Path("mine").read_text() == '{"a": 1}\n'


def test_another_schema_is_exit_three_and_a_broken_file_exit_two(call, baseline) -> None:
    change("tissuebench-baseline.json", lambda table: table.update(schema=2))
    assert call("--quiet").code == 3
    Path("tissuebench-baseline.json").write_text("{")
    broken = call("--quiet")
    assert broken.code == 2
    assert "tissuebench-baseline.json" in paragraph(broken)


def test_usage(call) -> None:
    assert call("--accept", "--against", "HEAD").code == 2
    assert call("--baseline", "b.json", "--gate", "nowhere.toml").code == 2


CODES = dict(re.findall(r"^\| (\d) \| (.*) \|$", (PRODUCT / "docs" / "gate.md").read_text(), re.MULTILINE))
"""What the gate's page says of each exit code."""


@pytest.mark.parametrize(
    ("model", "words", "code", "said", "documented"),
    [
        ("1 / 0\n", ("--accept",), 2, "line 1: ZeroDivisionError", "a model of your own (`own`) that fails"),
        (MODEL, ("--against", "nowhere"), 2, "--against nowhere: the repo", "a revision that git does not know"),
        ("1 / 0\n", ("--against", "HEAD"), 3, "revision HEAD cannot be measured", "its code or its model fails"),
        (MODEL, (), 3, "no baseline", "no baseline yet"),
    ],
)
def test_an_end_without_a_verdict_is_told_on_stderr_alone(call, model, words, code, said, documented) -> None:
    Path("my_model.py").write_text(model)
    for arguments in (("init", "--quiet"), ("add", "."), (*AUTHOR, "commit", "--quiet", "-m", "first")):
        subprocess.run(["git", *arguments], check=True)
    Path("my_model.py").write_text(MODEL if "HEAD" in words else model)
    called = call("--json", "--quiet", *words)
    assert (called.code, called.out) == (code, "")
    assert said in paragraph(called)
    assert documented in CODES[str(code)]


def test_accept_prints_one_object_as_json(call) -> None:
    called = call("--accept", "--json", "--quiet", "--baseline", "ci/b.json")
    assert called.code == 0
    assert called.err == ""
    document = json.loads(called.out)
    assert document["accepted"] == "ci/b.json"
    assert document["changes"][0] == {
        "quantity": "spring.max_deformation_mm.skin",
        "unit": "mm",
        "old": None,
        "new": 5.0,
    }
    assert Path("ci/b.history.jsonl").is_file()
