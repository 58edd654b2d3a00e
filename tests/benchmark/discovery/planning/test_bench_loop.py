import tomllib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import tomli_w

from bench_hw.rig.rig_file import load_rig
from benchmark.discovery.planning import bench_loop
from benchmark.discovery.planning.bench_loop import (
    BenchWork,
    Loop,
    judged_by_block,
    judged_by_prediction,
    rigs_give,
    session_copy,
    unattended,
)
from benchmark.discovery.planning.rivals import Rival
from benchmark.discovery.report.discovery_record import NextExperiment
from benchmark.errors import InputError
from benchmark.experiments.menu import Usual, protocol_toml, rigid_block, second_tools
from benchmark.files import load_session

USUAL = Usual(depth=1e-3, speed=2e-3, hold=0.5, thickness=20e-3)


@pytest.fixture
def folder(tmp_path) -> Path:
    """A rig with a virtual specimen on a rig that gives way, and a session to copy."""
    tools = [{"radius_mm": r, "depth_mm": [0.0, 1.0, 2.0, 4.0], "force_N": [0.0, 1.0, 2.0, 4.0]} for r in (5, 8)]
    specimen = {"schema": 1, "synthetic": True, "tools": tools, "effects": {"compliance_mm_per_N": 0.1}}
    (tmp_path / "specimen.toml").write_text(tomli_w.dumps(specimen))
    rig = {
        "schema": 1, "name": "virtual",
        "force": {"kind": "simulated", "rate": "100 Hz"},
        "actuator": {"kind": "simulated", "stroke": "50 mm", "accuracy": 1, "contact": "5 mm"},
        "simulation": {"specimen": "specimen.toml"},
    }  # fmt: skip
    (tmp_path / "rig.toml").write_text(tomli_w.dumps(rig))
    session = tmp_path / "session"
    session.mkdir()
    time = np.arange(60) / 20.0
    rows = [f"{t:.3f},{d:.4f},{d:.4f}" for t, d in zip(time, np.clip(time - 1.0, 0.0, 1.0), strict=True)]
    (session / "a.csv").write_text("\n".join(["time_s,depth_mm,force_N", *rows]) + "\n")
    table = {
        "schema": 1, "name": "s", "specimen": "skin_forearm", "synthetic": True,
        "tool": {"radius": "5 mm", "contact": "rigid_bonded"}, "trials": [{"file": "a.csv", "condition": "usual"}],
    }  # fmt: skip
    (session / "session.toml").write_text(tomli_w.dumps(table))
    return tmp_path


@pytest.fixture
def bench(folder) -> BenchWork:
    copy = session_copy(folder / "session", folder / "copy")
    return BenchWork(load_rig(folder / "rig.toml"), copy, unattended, seed=3)


def proposal(experiment) -> NextExperiment:
    return NextExperiment(
        ("a", "b"),
        experiment.name,
        experiment.words,
        1.0,
        9.0,
        5.0,
        {experiment.name: (9.0, 5.0)},
        protocol_toml(experiment),
    )


def test_an_experiment_with_another_tool_joins_the_copy_with_that_tool_alone(bench, folder) -> None:
    wider = proposal(second_tools(USUAL, 5e-3)[0])
    files = bench.record(wider, 2, 1)
    bench.add(wider, files)
    grown = load_session(bench.folder)
    assert [trial.condition for trial in grown.trials] == ["usual", "wider tool", "wider tool"]
    assert (
        tomllib.loads((bench.folder / "session.toml").read_text())["conditions"]["wider tool"]["tool"]["radius"]
        == "8 mm"
    )
    assert max(float(trial.table.force.max()) for trial in grown.trials[1:]) > 0.5
    assert [trial.condition for trial in load_session(folder / "session").trials] == ["usual"]


def test_a_block_measures_the_rigs_own_give_and_says_who_is_out(bench) -> None:
    (trial,) = bench.record(proposal(rigid_block(3.0)), 1, 1)
    give, error = rigs_give(trial)
    assert give == pytest.approx(1.025e-4, abs=3.0 * error)
    standing = {c: _pair(c) for c in (1.1e-4, 6e-4)}
    assert judged_by_block(standing[1.1e-4], trial)[1] == {"interface_slip"}
    assert judged_by_block(standing[6e-4], trial)[1] == {"machine_compliance"}
    assert judged_by_block(_pair(2.0 * give), trial)[1] == frozenset()


def _pair(compliance: float):
    giving = SimpleNamespace(slugs=("machine_compliance",), values={"machine_compliance": {"compliance": compliance}})
    return giving, SimpleNamespace(slugs=("interface_slip",), values={})


def _fit(slug: str, predicted, seen):
    """A fit that says what it predicts of each of three trials, the last two of the new condition."""
    study = SimpleNamespace(conditions=(SimpleNamespace(name="usual"), SimpleNamespace(name="new")))
    trials = [SimpleNamespace(condition=number) for number in (0, 1, 1)]
    model = SimpleNamespace(effects=(SimpleNamespace(slug=slug),), problem=SimpleNamespace(study=study, trials=trials))
    return SimpleNamespace(model=model, objective=0.0, predicted=np.array(predicted), seen=np.array(seen))


@pytest.mark.parametrize(
    ("first", "second", "out"),
    [
        ([0.0, -5.0, -5.0], [0.0, -40.0, -30.0], {"b"}),
        ([0.0, -40.0, -30.0], [0.0, -5.0, -5.0], {"a"}),
        ([0.0, -5.0, -30.0], [0.0, -40.0, -5.0], set()),
        ([0.0, -5.0, -5.0], [0.0, -6.0, -6.0], set()),
        ([0.0, -500.0, -500.0], [0.0, -540.0, -530.0], set()),
    ],
    ids=["second", "first", "trials disagree", "not decisive", "both fail"],
)
def test_who_predicts_the_new_condition_worse_is_out(monkeypatch, first, second, out) -> None:
    monkeypatch.setattr(bench_loop, "held_out_conditions", lambda fit: fit.predicted)
    monkeypatch.setattr(bench_loop, "held_out", lambda fit: fit.seen)
    fits = [_fit("a", first, [0.0, 0.0, 0.0]), _fit("b", second, [0.0, 0.0, 0.0])]
    candidates = tuple(SimpleNamespace(fit=fit) for fit in fits)
    found = SimpleNamespace(selection=SimpleNamespace(chosen=fits[0], rivals={}, candidates=candidates))
    separation, lost = judged_by_prediction(found, tuple(Rival((slug,), None) for slug in "ab"), "new")
    assert lost == out
    assert separation == pytest.approx(np.sqrt(2.0 * abs(sum(first) - sum(second))))


def test_the_loop_stops_at_its_budget_or_when_nothing_is_proposed(bench, monkeypatch) -> None:
    found = SimpleNamespace(discovery=SimpleNamespace(verdict="lookalikes", effects=()), calibrated=None)
    monkeypatch.setattr(bench_loop, "rivals", lambda found: _pair(1e-3))
    monkeypatch.setattr(bench_loop, "judged_by_block", lambda standing, file: (4.0, frozenset()))
    monkeypatch.setattr(BenchWork, "record", lambda bench, proposal, trials, number: (bench.folder / "block.mcap",))
    block = proposal(rigid_block(2.0))
    asked: list[set[str]] = []

    def proposed(found, allowed):
        asked.append(set(allowed.done))
        return block

    loop = Loop(bench, 2, lambda path, without: found, proposed)
    assert loop.run() is found
    assert [each.found for each in loop.rounds] == [4.0, 4.0]
    assert asked == [set(), {"rigid block"}]
    silent = Loop(bench, 2, lambda path, without: found, lambda found, allowed: None)
    silent.run()
    assert silent.rounds == []


def test_a_folder_without_a_session_file_is_refused(tmp_path) -> None:
    with pytest.raises(InputError, match=r"--bench needs a session\.toml"):
        session_copy(tmp_path, tmp_path / "copy")
