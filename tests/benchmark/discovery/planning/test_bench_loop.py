from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.planning import bench_loop
from benchmark.discovery.planning.bench_loop import Loop, judged_by_block, judged_by_prediction, rigs_give
from benchmark.discovery.planning.bench_work import BenchWork
from benchmark.discovery.planning.rivals import Rival
from benchmark.experiments.menu import rigid_block


def test_a_block_measures_the_rigs_own_give_and_says_who_is_out(bench, proposal) -> None:
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
    separation, lost = judged_by_prediction(found, tuple(Rival((slug,), None) for slug in "ab"), ["new"])
    assert lost == out
    assert separation == pytest.approx(np.sqrt(2.0 * abs(sum(first) - sum(second))))


def test_the_loop_stops_at_its_budget_or_when_nothing_is_proposed(bench, proposal, monkeypatch) -> None:
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
    assert asked == [{"ruler image"}, {"ruler image", "rigid block"}]  # nothing of a loop reads a picture
    silent = Loop(bench, 2, lambda path, without: found, lambda found, allowed: None)
    silent.run()
    assert silent.rounds == []
