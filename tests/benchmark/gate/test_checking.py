"""A check from request to report, with a gate so small that nothing is left to chance."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Self

import pytest

from benchmark.errors import InputError, NotComparableError, SolverError
from benchmark.gate.accepting import accept
from benchmark.gate.baseline import read_baseline
from benchmark.gate.checking import check, remarks
from benchmark.gate.history.history_file import read_history
from benchmark.gate.measuring.costs import CostClock
from benchmark.gate.measuring.service import Service
from benchmark.gate.plan import CheckRequest, GatePlan
from benchmark.gate.processes import Measured
from benchmark.gate.timing import TimingRow
from benchmark.gate.versions import origin_of


class Said:
    """A listener that keeps what it was told."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def say(self, text: str) -> None:
        self.lines.append(text)

    @contextmanager
    def progress(self, title: str) -> Iterator[Callable[[str, int, int, str], None]]:
        self.lines.append(title)
        yield lambda *_: None


class Here:
    """A side in this process, which a test need not wait for; `test_side` has the real one."""

    def __init__(self, tree: Path, revision: str | None = None):
        self._clock = CostClock()
        self._service = Service(self._clock)

    def values(self, plan: GatePlan) -> list[dict]:
        return self._service.answer({"do": "values", "cases": plan.cases})["values"]

    def prepare(self, plan: GatePlan) -> bool:
        return self._service.answer({"do": "prepare", "timed": plan.jobs, "references": plan.references})[
            "sees_waiting"
        ]

    def block(self) -> dict[str, float]:
        return self._service.answer({"do": "block"})["seconds"]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._clock.__exit__()


@pytest.fixture(autouse=True)
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("benchmark.gate.versions.Side", Here)


@pytest.fixture
def request_of(tmp_path: Path) -> Callable[..., CheckRequest]:
    def make(gate, **options: object) -> CheckRequest:
        return CheckRequest(**{"baseline": tmp_path / "b.json", "gate": gate.path, "out": tmp_path / "out", **options})

    return make


def rewrite(path: Path, change: Callable[[dict], None]) -> None:
    table = json.loads(path.read_text())
    change(table)
    path.write_text(json.dumps(table))


def test_unchanged_passes_and_is_written_whole(tiny_gate, request_of, tmp_path: Path) -> None:
    request = request_of(tiny_gate())
    accept(request, Said())
    outcome = check(request, Said())
    assert outcome.verdict.passed
    assert outcome.document == json.loads((tmp_path / "out" / "check.json").read_text())
    assert outcome.document["accuracy"][0] == {
        "quantity": "springs.max_deformation_mm.skin", "unit": "mm", "baseline": 5.0, "now": 5.0,
        "allowed": pytest.approx(5e-3 + 1e-6), "passed": True, "reason": None, "at": None,
    }  # fmt: skip
    curve = outcome.document["accuracy"][2]
    assert (curve["quantity"], curve["at"]) == ("springs.max_deformation_mm.skin.curve", "step 5 (5 N)")
    assert outcome.verdict.headline() == "Nothing got worse: 2 values, 2 curves and 0 timings are within limits."
    names = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*") if path.is_file()}
    assert names == {
        "manifest.json",
        "check.json",
        "environment.json",
        "report.html",
        "tables/accuracy.csv",
        "tables/rounds.csv",
    }
    assert "Nothing got worse" in outcome.report.read_text()


@pytest.mark.parametrize("factor", ["1.01e-3", "0.99e-3"])
def test_one_per_cent_in_one_deflection_fails(tiny_gate, request_of, factor: str) -> None:
    gate = tiny_gate()
    accept(request_of(gate), Said())
    gate.change("my_model.py", "[1e-3", f"[{factor}")
    verdict = check(request_of(gate), Said()).verdict
    assert [row.quantity for row in verdict.accuracy if not row.passed] == ["springs.max_deformation_mm.skin"]
    assert "baseline 5 mm" in verdict.failures()[0]


SOFT_AT_FIRST = "(np.where(force < 1.7, 1.3, 1.0) * force, [1e-3"
"""A model 30 % too soft in the first third of the load, and right at the peak."""


def test_a_model_that_is_wrong_on_the_way_to_the_peak_fails(tiny_gate, request_of) -> None:
    """The largest deflection alone was gated, and such a model was green."""
    gate = tiny_gate()
    accept(request_of(gate), Said())
    gate.change("my_model.py", "(force, [1e-3", SOFT_AT_FIRST)
    verdict = check(request_of(gate), Said()).verdict
    assert not verdict.passed
    assert verdict.failures()[0] == (
        "springs.max_deformation_mm.skin.curve at step 1 (1 N): baseline 1 mm, now 1.3 mm, "
        "allowed a difference of 0.005 mm"
    )
    assert verdict.headline() == "0 of 2 values changed, 2 of 2 curves changed, 0 of 0 timings slower."
    changes = [step.words() for step in accept(request_of(gate), Said()).steps]
    assert "springs.max_deformation_mm.skin.curve at step 1 (1 N): 1 -> 1.3 mm" in changes
    assert check(request_of(gate), Said()).verdict.passed
    gate.change("my_model.py", "[1e-3", "[1.1e-3")
    changes = [step.words() for step in accept(request_of(gate), Said()).steps]
    assert changes == [
        "springs.max_deformation_mm.skin: 5 -> 5.5 mm",
        "springs.max_deformation_mm.fat: 4 -> 4 mm",
    ], "the peak of a curve is the value, told already"


def test_a_red_model_that_answers_differently_each_time_is_told_to_be_one(tiny_gate, request_of) -> None:
    gate = tiny_gate()
    accept(request_of(gate), Said())
    gate.change("my_model.py", "(force, [1e-3", "(force, [1.1e-3")
    assert check(request_of(gate), Said()).verdict.warnings == ()
    gate.change("my_model.py", "(force, [1.1e-3", "(force * np.random.default_rng().uniform(0.9, 1.1), [1.1e-3")
    verdict = check(request_of(gate), Said()).verdict
    assert not verdict.passed
    (said,) = verdict.warnings
    assert said.startswith("your model answers differently each time: measured once more, springs.max_deformation_mm.")


def test_under_depth_control_the_force_is_gated_over_the_depth(tiny_gate, request_of) -> None:
    gate, press = tiny_gate(), "def press(layers, tool, support, time, depth):\n    return 1e3 * depth\n"
    gate.change("my_model.py", "def deform", f"{press}\n\ndef deform")
    gate.change("gate.toml", 'own = "', 'set = { "load.control" = "depth", "load.peak" = "2 mm" }\nown = "')
    gate.change("gate.toml", "[[cases]]", '[[tolerances]]\nquantity = "*_N"\nrtol = 0.001\natol = "1e-6 N"\n[[cases]]')
    gate.change("gate.toml", 'quantity = "*"', 'quantity = "*_mm*"')
    accept(request_of(gate), Said())
    gate.change("my_model.py", "return 1e3 * depth", "return 1e3 * depth * np.where(depth < 1e-3, 1.01, 1.0)")
    said = check(request_of(gate), Said()).verdict.failures()[-1]
    assert said.startswith("springs.peak_force_N.curve at step 2 (0.8 mm): baseline 0.8 N, now 0.808 N")


def test_a_baseline_from_before_there_were_curves_holds_and_says_so(tiny_gate, request_of, tmp_path: Path) -> None:
    gate = tiny_gate()
    accept(request_of(gate), Said())
    rewrite(tmp_path / "b.json", lambda table: [value.pop("curve") for value in table["accuracy"].values()])
    gate.change("my_model.py", "(force, [1e-3", SOFT_AT_FIRST)
    verdict = check(request_of(gate), Said()).verdict
    assert verdict.passed
    assert len(verdict.accuracy) == 2
    (said,) = verdict.warnings
    assert "of 2 of them only the largest is gated" in said
    assert "--accept" in said
    accept(request_of(gate), Said())
    assert check(request_of(gate), Said()).verdict.warnings == ()


def test_other_load_steps_are_said_and_no_misfit(tiny_gate, request_of) -> None:
    gate = tiny_gate()
    accept(request_of(gate), Said())
    gate.change("press.toml", "observations = 10", "observations = 20")
    verdict = check(request_of(gate), Said()).verdict
    assert verdict.passed
    assert verdict.warnings[0].startswith("the load steps of springs.max_deformation_mm.skin, springs.max")


def test_the_history_has_the_largest_values_alone(tiny_gate, request_of, tmp_path: Path) -> None:
    gate = tiny_gate()
    accept(request_of(gate), Said())
    check(request_of(gate), Said())
    entries, _ = read_history(tmp_path / "b.history.jsonl")
    assert set(entries[1].accuracy) == {f"springs.max_deformation_mm.{layer}" for layer in ("skin", "fat")}


def test_slower_than_the_baseline_fails_and_faster_does_not(tiny_gate, request_of, tmp_path: Path) -> None:
    request = request_of(tiny_gate(timed=True))
    accept(request, Said())
    rewrite(tmp_path / "b.json", lambda table: table["timing"]["springs.history"].update(ratios=[1e9]))
    assert check(request, Said()).verdict.passed
    rewrite(tmp_path / "b.json", lambda table: table["timing"]["springs.history"].update(ratios=[1e-9]))
    outcome = check(request, Said())
    assert not outcome.verdict.passed
    row = outcome.document["timing"][0]
    assert row["quantity"] == "springs.history"
    assert row["now_ratio"] > row["allowed"] == pytest.approx(1.12e-9)
    assert "springs.history: baseline 1e-09 x the reference workload" in outcome.verdict.failures()[0]


def test_without_a_baseline_nothing_is_measured_or_written(tiny_gate, request_of, tmp_path: Path) -> None:
    with pytest.raises(NotComparableError, match="--accept"):
        check(request_of(tiny_gate()), Said())
    assert {path.name for path in tmp_path.iterdir()} == {"gate"}


def test_a_check_that_fails_leaves_no_earlier_files_for_a_ci_service(tiny_gate, request_of, tmp_path: Path) -> None:
    """CI showed the verdict of the check before as this one's."""
    gate, files = tiny_gate(), {"junit": tmp_path / "gate.xml", "markdown": tmp_path / "gate.md"}
    accept(request_of(gate), Said())
    refused = (
        (NotComparableError, {"baseline": tmp_path / "none.json"}),
        (InputError, {"gate": tmp_path / "none.toml"}),
        (InputError, {"out": gate.folder}),
    )
    for error, options in refused:
        check(request_of(gate, **files), Said())
        assert all(path.is_file() for path in files.values())
        with pytest.raises(error):
            check(replace(request_of(gate, **files), **options), Said())
        assert not any(path.exists() for path in files.values())
    files["junit"].write_text("<testsuites name='mine'/>")
    files["markdown"].write_text("# mine")
    with pytest.raises(InputError, match="nothing else is replaced"):
        check(request_of(gate, **files), Said())
    assert [path.read_text() for path in files.values()] == ["<testsuites name='mine'/>", "# mine"]


def test_a_baseline_of_another_gate_cannot_be_compared_with(tiny_gate, request_of) -> None:
    gate = tiny_gate(timed=True)
    accept(request_of(gate), Said())
    gate.change("gate.toml", 'references = ["dense"]', 'references = ["calls"]')
    with pytest.raises(NotComparableError, match=r"another gate(?s:.)*--gate .*gate\.toml --baseline"):
        check(request_of(gate), Said())


@pytest.mark.parametrize("against", [None, "HEAD"])
def test_a_baseline_with_another_gates_name_is_told_by_both(tiny_gate, request_of, against) -> None:
    """Gates of the same quantities and scenarios have the same fingerprint, whatever they are called."""
    gate = tiny_gate()
    accept(request_of(gate), Said())
    gate.change("gate.toml", 'name = "tiny"', 'name = "mine"')
    with pytest.raises(NotComparableError, match="another gate: 'tiny', and this one is 'mine'") as refused:
        check(request_of(gate, against=against), Said())
    assert refused.value.exit_code == 3
    accepted = accept(request_of(gate), Said())
    assert accepted.warnings == ("the baseline of another gate, 'tiny', is replaced by one of 'mine'",)
    assert check(request_of(gate), Said()).verdict.passed


def test_one_case_is_one_case(tiny_gate, request_of) -> None:
    request, said = request_of(tiny_gate(timed=True)), Said()
    accept(request, said)
    check(request, said)
    assert said.lines[:2] == ["gate tiny: values of 1 case", "gate tiny: 1 time"]
    assert said.lines[3].startswith("gate tiny: 1 time against")


def test_a_wide_tolerance_is_obeyed_and_said(tiny_gate, request_of) -> None:
    gate = tiny_gate()
    gate.change("gate.toml", 'rtol = "0.1 %"', "rtol = 0.5")
    (said,) = accept(request_of(gate), Said()).warnings
    assert "gate little: springs.max_deformation_mm.skin (50 %), springs.max_deformation_mm.fat (50 %)" in said
    gate.change("my_model.py", "[1e-3", "[1.4e-3")
    verdict = check(request_of(gate), Said()).verdict
    assert verdict.passed
    assert verdict.warnings == (said,)


def test_a_layer_more_cannot_be_compared(tiny_gate, request_of) -> None:
    gate = tiny_gate()
    accept(request_of(gate), Said())
    gate.change("press.toml", 'name = "fat"', 'name = "muscle"')
    with pytest.raises(NotComparableError, match=r"fat.*muscle|muscle.*fat"):
        check(request_of(gate), Said())


def test_every_check_is_added_to_the_history(tiny_gate, request_of, tmp_path: Path) -> None:
    gate = tiny_gate()
    accept(request_of(gate), Said())
    check(request_of(gate), Said())
    gate.change("my_model.py", "[1e-3", "[1.02e-3")
    check(request_of(gate), Said())
    entries, unread = read_history(tmp_path / "b.history.jsonl")
    assert [entry.passed for entry in entries] == [None, True, False]
    assert entries[2].accuracy["springs.max_deformation_mm.skin"] == pytest.approx(5.1)
    assert unread == 0


def test_the_trend_is_in_the_report_from_the_second_check(tiny_gate, request_of) -> None:
    request = request_of(tiny_gate(timed=True))
    accept(request, Said())
    assert "<svg" in check(request, Said()).report.read_text()


def test_a_history_that_cannot_be_written_any_more_is_a_warning(
    tiny_gate, request_of, monkeypatch: pytest.MonkeyPatch
) -> None:
    gate = tiny_gate()
    accept(request_of(gate), Said())

    def full(*_: object) -> None:
        raise OSError(28, "no space left on device")

    monkeypatch.setattr("benchmark.gate.checking.append", full)
    outcome = check(request_of(gate), Said())
    assert outcome.verdict.passed
    assert any("cannot be written" in warning for warning in outcome.document["warnings"])


def test_a_baseline_of_another_machine_is_judged_widely_and_said(tiny_gate, request_of, tmp_path: Path) -> None:
    request = request_of(tiny_gate(timed=True))
    accept(request, Said())
    rewrite(tmp_path / "b.json", lambda table: table["machine"].update(processor="another", packages={"numpy": "1.0"}))
    document = check(request, Said()).document
    row = document["timing"][0]
    assert row["allowed"] == pytest.approx(1.5 * row["baseline_ratio"])
    assert any("another machine" in warning and "--against" in warning for warning in document["warnings"])
    assert any("numpy 1.0 (here" in warning for warning in document["warnings"])


def test_out_must_be_new_or_an_earlier_check(tiny_gate, request_of, tmp_path: Path) -> None:
    gate = tiny_gate()
    accept(request_of(gate), Said())
    check(request_of(gate), Said())
    check(request_of(gate), Said())
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.tex").touch()
    with pytest.raises(InputError, match="--out"):
        check(request_of(gate, out=tmp_path / "mine"), Said())


def test_accepting_says_old_and_new(tiny_gate, request_of, tmp_path: Path) -> None:
    gate = tiny_gate()
    first = accept(request_of(gate), Said())
    assert next(step.words() for step in first.steps) == "springs.max_deformation_mm.skin: none -> 5 mm"
    gate.change("my_model.py", "[1e-3", "[1.02e-3")
    gate.change("press.toml", 'name = "fat"', 'name = "muscle"')
    words = [step.words() for step in accept(request_of(gate), Said()).steps]
    assert words[0] == "springs.max_deformation_mm.skin: 5 -> 5.1 mm"
    assert "springs.max_deformation_mm.muscle: none -> 4 mm" in words
    assert "springs.max_deformation_mm.fat: 4 -> none mm" in words
    assert read_baseline(tmp_path / "b.json").accuracy["springs.max_deformation_mm.skin"].value == pytest.approx(5.1)


def test_a_baseline_that_is_accepted_from_other_values_is_told_of_in_the_check_beside_it(
    tiny_gate, request_of, tmp_path: Path, monkeypatch
) -> None:
    """A job that accepts and then checks is green whatever happens."""
    gate, skin = tiny_gate(), "springs.max_deformation_mm.skin"
    first = accept(request_of(gate), Said())
    assert (first.differed, first.unseen) == ((), None)
    gate.change("my_model.py", "[1e-3", "[1.02e-3")
    at = {"revision": "abc"}
    for module in ("accepting", "checking"):
        monkeypatch.setattr(
            f"benchmark.gate.{module}.origin_of", lambda plan, seed: replace(origin_of(plan, seed), **at)
        )
    second = accept(request_of(gate), Said())
    assert second.differed == (skin,)
    assert second.to_dict()["differed"] == [skin]
    assert f"1 gated value ({skin}) differs from the baseline that was here" in second.unseen
    at["revision"] = "abc+"  # the baseline itself is a changed file now
    outcome = check(request_of(gate), Said())
    assert outcome.verdict.passed
    assert outcome.document["accepted_here"] == [skin]
    assert outcome.document["warnings"][0].startswith(
        "the baseline was accepted at this same revision, and 1 gated value"
    )
    at["revision"] = "def"
    outcome = check(request_of(gate), Said())
    assert outcome.document["accepted_here"] == []
    assert not any("same revision" in warning for warning in outcome.document["warnings"])


def test_a_folder_in_the_place_of_the_history_is_refused_before_anything(tiny_gate, request_of, tmp_path: Path) -> None:
    (tmp_path / "history.jsonl").mkdir()
    with pytest.raises(InputError, match="folder"):
        check(request_of(tiny_gate(), history=tmp_path), Said())


def test_accepting_replaces_a_baseline_of_another_schema_and_says_so(tiny_gate, request_of, tmp_path: Path) -> None:
    gate = tiny_gate()
    accept(request_of(gate), Said())
    rewrite(tmp_path / "b.json", lambda table: table.update(schema=99))
    accepted = accept(request_of(gate), Said())
    assert "schema 99" in accepted.warnings[0]
    assert read_baseline(tmp_path / "b.json").gate == "tiny"


def test_a_baseline_needs_every_value(tiny_gate, request_of, tmp_path: Path) -> None:
    gate = tiny_gate()
    gate.change("gate.toml", 'model = "wave"', 'model = "fem"')
    gate.change("gate.toml", 'own = "my_model.py"', 'set = { "load.peak" = "10 kN", "load.observations" = "2" }')
    with pytest.raises(SolverError, match=r"max_deformation_mm\.skin.*stopped early"):
        accept(request_of(gate), Said())
    assert not (tmp_path / "b.json").exists()


def test_a_check_writes_over_no_file_of_another_kind(tiny_gate, request_of, tmp_path: Path) -> None:
    """A JSON file with a key "gate" was replaced by --accept, a baseline that was given as history had a line added."""
    gate, foreign = tiny_gate(), tmp_path / "package.json"
    foreign.write_text('{"name": "mine", "gate": 3, "revision": "abc"}')
    accept(request_of(gate), Said())
    check(request_of(gate), Said())
    for kept in (foreign, tmp_path / "out" / "check.json"):
        before = kept.read_bytes()
        for options in ({"baseline": kept}, {"history": kept}):
            with pytest.raises(InputError, match="nothing else is replaced"):
                accept(request_of(gate, **options), Said())
        assert kept.read_bytes() == before
    before = (tmp_path / "b.json").read_bytes()
    with pytest.raises(InputError, match="is not a history of checks"):
        check(request_of(gate, history=tmp_path / "b.json"), Said())
    with pytest.raises(InputError, match="is not a baseline"):
        accept(request_of(gate, baseline=tmp_path / "b.history.jsonl"), Said())
    assert (tmp_path / "b.json").read_bytes() == before


def test_accept_and_against_exclude_each_other(tiny_gate, request_of) -> None:
    with pytest.raises(InputError, match="--against"):
        accept(request_of(tiny_gate(), against="HEAD"), Said())


def test_what_a_reader_must_know_of_the_measurement() -> None:
    quiet = TimingRow("frame", 2.0, 2.0, 2.24, (1.9, 2.1), 0.14, 0.01, True)
    loud = TimingRow("fit", 2.0, 2.0, 2.24, (1.5, 2.5), 0.31, 0.1, True)
    assert remarks(Measured(({},), 4, True), [quiet]) == []
    said = remarks(Measured(({},), 4, False), [quiet, loud])
    assert "CPU times" in said[0]
    assert "fit (31 % instead of 25 %)" in said[1]
    assert "frame" not in said[1]
    slow = TimingRow("frame", 2.0, 2.5, 2.24, (2.4, 2.6), 0.14, 0.01, False)
    (few,) = remarks(Measured(({},), 4, True), [quiet, slow])
    assert few.startswith("slower by 4 rounds of processes, of which the gate file allows no more: only from 5 on")
    assert remarks(Measured(({},), 5, True), [quiet, slow]) == []
