"""Experiments on a blind case's true body: what is added to its session, and what the loop's cases are judged by."""

import tomllib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.blind import closed_loop
from benchmark.blind.body.presses import DEEPEST
from benchmark.blind.cases import BlindCase, CaseName, make_case
from benchmark.blind.closed_loop import HiddenBench, under_tool
from benchmark.blind.scoring.judging import judge, looped, table
from benchmark.blind.session_files import case
from benchmark.discovery.planning.bench_loop import rigs_give
from benchmark.discovery.planning.bench_work import session_copy
from benchmark.discovery.report.discovery_record import NextExperiment
from benchmark.experiments.menu import Experiment, Usual, menu, protocol_toml, rigid_block, second_tools
from benchmark.files.sessions.session_loading import load_session
from benchmark.files.units import LENGTH, parse_quantity

USUAL = Usual(depth=2e-3, speed=2e-3, hold=2.0, thickness=20e-3)


def proposed(experiment: Experiment) -> NextExperiment:
    return NextExperiment(("a", "b"), experiment.name, "", 1.0, 9.0, 5.0, {}, protocol_toml(experiment))


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> HiddenBench:
    folder, made = case(CaseName("effect", "poroelastic_drainage", 0), tmp_path_factory.mktemp("loop"))
    return HiddenBench(made, session_copy(folder, folder.with_name("grown")))


def test_a_wider_tool_presses_the_same_specimen(bench: HiddenBench) -> None:
    wider = proposed(second_tools(USUAL, bench.made.scene.body.specimen.tool_radius)[0])
    bench.add(wider, bench.record(wider, 2, 1))
    grown = load_session(bench.folder)
    added = [trial for trial in grown.trials if trial.condition == "wider tool"]
    assert len(added) == 2
    told = tomllib.loads((bench.folder / "session.toml").read_text())["conditions"]["wider tool"]["tool"]["radius"]
    assert parse_quantity(told, LENGTH) > 1.4 * bench.made.scene.body.specimen.tool_radius
    assert all(trial.markers is not None for trial in added)
    usual = next(trial for trial in grown.trials if trial.condition != "wider tool")
    shallow = [float(np.interp(1.5e-3, *_loading(trial.table.depth, trial.table.force))) for trial in (usual, added[0])]
    assert shallow[1] > 1.1 * shallow[0]


def test_under_another_tool_a_body_is_pressed_as_deep_as_is_asked_and_answers_the_same(bench: HiddenBench) -> None:
    radius = 1.6 * bench.made.scene.body.specimen.tool_radius
    whole, short = (under_tool(bench.made, radius, deepest).scene.body for deepest in (DEEPEST, 3e-3))
    assert (whole.table.depth[-1], short.table.depth[-1]) == pytest.approx((5e-3, 3e-3))
    depth = np.array([1e-3, 2e-3, 2.9e-3])
    np.testing.assert_allclose(short.force(depth), whole.force(depth), rtol=2e-3)


def _loading(depth, force):
    peak = int(np.argmax(depth))
    rising = np.maximum.accumulate(depth[:peak])
    return rising, force[:peak]


def test_fluid_has_farther_to_go_under_a_wider_tool(bench: HiddenBench) -> None:
    radius = bench.made.scene.body.specimen.tool_radius
    (drainage,) = bench.made.effects
    (wider,) = under_tool(bench.made, 2.0 * radius).effects
    assert wider.time == pytest.approx(4.0 * drainage.time)
    memory = make_case(CaseName("effect", "viscoelastic_relaxation", 0))
    (before,), (after,) = memory.effects, under_tool(memory, 8e-3).effects
    time, force = np.linspace(0.0, 5.0, 200), np.ones(200)
    assert after.push(time, force, force) == pytest.approx(before.push(time, force, force))


def test_the_same_experiment_gives_the_same_trials(bench: HiddenBench, tmp_path: Path) -> None:
    slower = proposed(next(each for each in menu(USUAL) if each.name == "slower"))
    texts = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (file,) = HiddenBench(bench.made, tmp_path / name).record(slower, 1, 2)
        texts.append(file.read_bytes())
    assert texts[0] == texts[1]


@pytest.mark.parametrize(("slug", "gives"), [("machine_compliance", True), ("interface_slip", False)])
def test_a_block_shows_what_the_rig_gives_way_by(slug: str, gives: bool, tmp_path: Path) -> None:
    made = make_case(CaseName("effect", slug, 0))
    made = replace(made, effects=tuple(effect.of_size(20.0 * effect.amplitude) for effect in made.effects))
    (file,) = HiddenBench(made, tmp_path).record(proposed(rigid_block(made.scene.scale.force)), 1, 1)
    give, error = rigs_give(file)
    assert (give > 3.0 * error) is gives


def test_rivals_count_as_separated_where_the_truth_stands_alone(saturation: BlindCase, answer) -> None:
    truth = saturation.name.slug
    alike = answer("lookalikes", {truth: ("machine_compliance",)})
    alone, other = answer("named", {truth: ()}), answer("named", {"machine_compliance": ()})
    judged = [looped(saturation, (alike, last), 1, 2.0) for last in (alone, other, alike)]
    assert [(one.experiments, one.set_before) for one in judged] == [(1, f"{truth}+machine_compliance")] * 3
    rows = {row.measure: row for row in table([*judged, replace(judge(saturation, alone, 1.0), seed=9)])}
    row = rows["rivals separated by experiments"]
    assert (row.n, row.value) == (3, pytest.approx(1.0 / 3.0))


def test_the_answer_of_a_loop_is_its_last_also_where_no_trial_was_searched_anew(tmp_path, monkeypatch):
    """A block rules causes out of an answer without a new search; the answer before it was judged."""
    last = SimpleNamespace(discovery="after the block")
    monkeypatch.setattr(closed_loop, "session_copy", lambda session, folder: folder)
    monkeypatch.setattr(closed_loop, "Loop", lambda *_: SimpleNamespace(run=lambda: last, rounds=["block"]))
    found = closed_loop.closed_loop(SimpleNamespace(name=SimpleNamespace(seed=1)), tmp_path, 3)
    assert (found.answers, found.experiments) == (["after the block"], 1)
