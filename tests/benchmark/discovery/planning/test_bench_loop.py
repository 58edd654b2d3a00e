import shutil
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery import discovery_request
from benchmark.discovery.discovery_request import DiscoverRequest, answer_session
from benchmark.discovery.planning import bench_loop
from benchmark.discovery.planning.bench_loop import Loop, judged_by_block, judged_by_trials, rigs_give
from benchmark.discovery.planning.bench_work import BenchWork
from benchmark.discovery.planning.rivals import Rival
from benchmark.errors import DeviceError, InputError
from benchmark.experiments.menu import Usual, menu, rigid_block
from benchmark.scripting import Unheard

USUAL = Usual(depth=2e-3, speed=1e-3, hold=5.0, thickness=20e-3)


def test_a_block_measures_the_rigs_own_give_and_says_who_is_out(bench, proposal) -> None:
    (trial,) = bench.record(proposal(rigid_block(3.0)), 1, 1)
    give, error = rigs_give(trial)
    assert give == pytest.approx(1.025e-4, abs=3.0 * error)
    standing = {c: _pair(c) for c in (1.1e-4, 6e-4)}
    assert judged_by_block(standing[1.1e-4], trial)[1] == {"interface_slip"}
    assert judged_by_block(standing[6e-4], trial)[1] == {"machine_compliance"}
    assert judged_by_block(_pair(2.0 * give), trial)[1] == {"interface_slip"}  # bearings lie on under a large load
    assert judged_by_block(_pair(3.0 * give), trial)[1] == frozenset()


def test_a_block_is_weighed_against_all_that_stand(bench, proposal) -> None:
    (trial,) = bench.record(proposal(rigid_block(3.0)), 1, 1)
    hole, thickness = (SimpleNamespace(slugs=(slug,), values={}) for slug in ("setup.hole", "setup.thickness"))
    giving, slipping = _pair(1.1e-4)
    assert judged_by_block((hole, thickness, slipping, giving), trial)[1] == {
        "setup.hole",
        "setup.thickness",
        "interface_slip",
    }
    with pytest.raises(InputError, match="a rigid block tells nothing of what is in question"):
        judged_by_block((hole, slipping), trial)


def _pair(compliance: float):
    giving = SimpleNamespace(slugs=("machine_compliance",), values={"machine_compliance": {"compliance": compliance}})
    return giving, SimpleNamespace(slugs=("interface_slip",), values={})


def _found(seen: dict[str, list[float]], foretold: dict[str, list[float]]) -> SimpleNamespace:
    """Fits of two rivals that say how each foretells three trials, the last two of a new condition."""
    study = SimpleNamespace(conditions=(SimpleNamespace(name="usual"), SimpleNamespace(name="new")))
    trials = [SimpleNamespace(condition=int(number > 0), name=f"t{number}") for number in range(3)]
    problem = SimpleNamespace(study=study, trials=trials)
    fits = [
        SimpleNamespace(
            model=SimpleNamespace(effects=(SimpleNamespace(slug=slug),), problem=problem),
            objective=0.0,
            seen=np.array(seen[slug]),
            foretold=np.array(foretold.get(slug, seen[slug])),
        )
        for slug in "ab"
    ]
    candidates = tuple(SimpleNamespace(fit=fit) for fit in fits)
    return SimpleNamespace(selection=SimpleNamespace(chosen=fits[0], rivals={}, candidates=candidates))


BEFORE = {("usual", "t0"): 2.0}
WORST = {"a": [0.0, -500.0, -500.0], "b": [0.0, -500.0, -500.0]}


@pytest.mark.parametrize(
    ("first", "second", "foretold", "total", "out"),
    [
        ([5.0, 8.0, 7.0], [3.0, 4.0, 3.0], {}, 8.0, {"b"}),
        ([3.0, 4.0, 3.0], [3.0, 8.0, 7.0], {}, -10.0, {"a"}),
        ([9.0, 0.0, 0.0], [1.0, 0.0, 0.0], {}, 6.0, set()),
        ([5.0, 4.0, 3.0], [3.0, 3.0, 2.0], {}, 2.0, set()),
        ([5.0, 8.0, 7.0], [3.0, 4.0, 3.0], WORST, 8.0, set()),
        ([5.0, 8.0, 7.0], [3.0, 4.0, 3.0], {"a": [0.0, -2.0, -3.0], "b": [0.0, -50.0, -50.0]}, 8.0, {"b"}),
        ([5.0, 8.0, 7.0], [3.0, 4.0, 3.0], {"a": [0.0, -50.0, -50.0], "b": [0.0, -2.0, -3.0]}, 8.0, set()),
    ],
    ids=["second", "first", "one trial alone", "not decisive", "both fail", "the loser far more", "the winner"],
)
def test_whom_trials_speak_against_more_than_before_is_out(monkeypatch, first, second, foretold, total, out) -> None:
    monkeypatch.setattr(bench_loop, "held_out_conditions", lambda fit: fit.foretold)
    monkeypatch.setattr(bench_loop, "held_out", lambda fit: fit.seen)
    found = _found({"a": first, "b": second}, foretold)
    separation, lost = judged_by_trials(found, tuple(Rival((slug,), None) for slug in "ab"), ["new"], BEFORE)
    assert lost == out
    assert separation == pytest.approx(np.sqrt(2.0 * abs(total)))


def test_rivals_are_judged_without_what_both_shared_once_that_is_gone(monkeypatch) -> None:
    """A contact that is another stood beside both, and is none by the new trials."""
    monkeypatch.setattr(bench_loop, "held_out_conditions", lambda fit: fit.foretold)
    monkeypatch.setattr(bench_loop, "held_out", lambda fit: fit.seen)
    found = _found({"a": [5.0, 8.0, 7.0], "b": [3.0, 4.0, 3.0]}, {})
    standing = (Rival(("a", "setup.tool.contact"), None), Rival(("setup.tool.contact", "b"), None))
    assert judged_by_trials(found, standing, ["new"], BEFORE)[1] == {"b"}
    other = (Rival(("a", "setup.tool.contact"), None), Rival(("a", "b"), None))
    assert judged_by_trials(found, other, ["new"], BEFORE) == (None, frozenset())


@pytest.mark.parametrize(("size", "out"), [(4.5, frozenset()), (10.0, {"b"})], ids=["too little", "enough"])
def test_what_promised_little_rules_nobody_out_until_more_adds_up(bench, proposal, monkeypatch, size, out) -> None:
    found = SimpleNamespace(discovery=SimpleNamespace(verdict="lookalikes", effects=()))
    standing = tuple(Rival((slug,), None) for slug in "ab")
    monkeypatch.setattr(bench_loop, "rivals", lambda found: standing)
    monkeypatch.setattr(bench_loop, "leads", lambda found, standing: {})
    monkeypatch.setattr(bench_loop, "judged_by_trials", lambda *told: (4.0, frozenset({"b"})))
    monkeypatch.setattr(BenchWork, "record", lambda bench, proposal, trials, number: ())
    monkeypatch.setattr(BenchWork, "add", lambda bench, proposal, files: None)
    longer = replace(proposal(menu(USUAL)[0]), separation=size)
    loop = Loop(bench, 1, lambda path, without: found, lambda found, allowed: longer)
    loop.run()
    assert loop.out == out
    more = Loop(bench, 5, lambda path, without: found, lambda found, allowed: longer)
    more.run()
    assert more.out == {"b"}  # five times 4.5 are 10.1


def test_trials_that_show_what_was_not_looked_for_rule_nothing_out(bench, proposal, monkeypatch) -> None:
    """Though one name stands, and is judged with them later."""
    found = SimpleNamespace(discovery=SimpleNamespace(verdict="named", effects=()))
    monkeypatch.setattr(bench_loop, "rivals", lambda found: (Rival(("a",), None),))
    monkeypatch.setattr(BenchWork, "record", lambda bench, proposal, trials, number: ())
    added = []
    monkeypatch.setattr(BenchWork, "add", lambda bench, proposal, files: added.append(proposal.choice))
    shows = replace(proposal(menu(USUAL)[0]), separation=np.nan, separation_now=np.nan, opens=("c",))
    loop = Loop(bench, 1, lambda path, without: found, lambda found, allowed: shows)
    loop.run()
    assert (added, loop.measured, loop.promised) == (["longer hold"], ["longer hold"], {})
    assert (loop.out, loop.rounds[0].found, loop.rounds[0].ruled_out) == (frozenset(), None, ())


def test_what_a_pair_said_before_stays_when_the_other_comes_first(bench, proposal, monkeypatch) -> None:
    found = SimpleNamespace(discovery=SimpleNamespace(verdict="lookalikes", effects=()))
    first, second = (Rival((slug,), None) for slug in "ab")
    turns, judged = [], []

    def turned(found):
        turns.append(None)
        return (first, second) if len(turns) % 2 else (second, first)

    monkeypatch.setattr(bench_loop, "rivals", turned)
    monkeypatch.setattr(bench_loop, "leads", lambda found, standing: {("usual", f"{len(judged)}"): 1.0})
    monkeypatch.setattr(bench_loop, "judged_by_trials", lambda *told: (judged.append(told[1:]) or 4.0, frozenset()))
    monkeypatch.setattr(BenchWork, "record", lambda bench, proposal, trials, number: ())
    monkeypatch.setattr(BenchWork, "add", lambda bench, proposal, files: None)
    longer = proposal(menu(USUAL)[0])
    Loop(bench, 3, lambda path, without: found, lambda found, allowed: longer).run()
    assert [[rival.slugs for rival in told[0]] for told in judged] == [[("a",), ("b",)]] * 3
    assert [told[2] for told in judged] == [{("usual", "0"): 1.0}] * 3


def test_the_loop_stops_at_its_budget_or_when_nothing_is_proposed(bench, proposal, monkeypatch) -> None:
    found = SimpleNamespace(discovery=SimpleNamespace(verdict="lookalikes", effects=()), calibrated=None)
    monkeypatch.setattr(bench_loop, "rivals", lambda found: _pair(1e-3))
    monkeypatch.setattr(bench_loop, "leads", lambda found, standing: {})
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


def test_what_a_block_rules_out_leaves_the_answer_without_a_new_search(bench, proposal, monkeypatch) -> None:
    first, left = (
        SimpleNamespace(discovery=SimpleNamespace(verdict=word, effects=()), stood=word)
        for word in ("lookalikes", "named")
    )
    decided: list[Path] = []
    monkeypatch.setattr(bench_loop, "rivals", lambda found: _pair(1e-3) if found is first else _pair(1e-3)[:1])
    monkeypatch.setattr(bench_loop, "judged_by_block", lambda standing, file: (9.0, frozenset({"interface_slip"})))
    monkeypatch.setattr(
        bench_loop, "without_ruled_out", lambda found, lost: left if lost == {"interface_slip"} else None
    )
    monkeypatch.setattr(BenchWork, "record", lambda bench, proposal, trials, number: (bench.folder / "block.mcap",))
    block = proposal(rigid_block(2.0))
    loop = Loop(
        bench,
        2,
        lambda path, without: decided.append(path) or first,
        lambda found, allowed: block if found is first else None,
    )
    assert loop.run() is left
    assert len(decided) == 1
    assert (loop.out, loop.rounds[0].verdict, loop.rounds[0].remaining) == ({"interface_slip"}, "named", 1)


@pytest.mark.parametrize("where", ["record", "decide"])
def test_a_bench_that_fails_ends_the_loop_with_the_answer_before(bench, proposal, monkeypatch, where) -> None:
    """What the failed experiment entered is taken out again, so that the session can be read."""
    answers = [SimpleNamespace(discovery=SimpleNamespace(verdict="lookalikes", effects=()), calibrated=None)]
    entered = (bench.folder / "session.toml").read_text()
    monkeypatch.setattr(bench_loop, "rivals", lambda found: _pair(1e-3))
    monkeypatch.setattr(bench_loop, "leads", lambda found, standing: {})

    def record(bench, proposal, trials, number):
        if where == "record":
            raise DeviceError("--bench: the actuator is gone")
        return ()

    def decide(path, without):
        if not answers:
            raise InputError("the new trials cannot be read")
        return answers.pop()

    monkeypatch.setattr(BenchWork, "record", record)
    monkeypatch.setattr(BenchWork, "add", lambda bench, proposal, files: (bench.folder / "session.toml").write_text(""))
    first, longer = answers[0], proposal(menu(USUAL)[0])
    loop = Loop(bench, 3, decide, lambda found, allowed: longer)
    assert loop.run() is first
    assert isinstance(loop.stopped, DeviceError if where == "record" else InputError)
    assert (loop.rounds, (bench.folder / "session.toml").read_text()) == ([], entered)


class Heard(Unheard):
    """Keeps what is said."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def say(self, line: str) -> None:
        self.lines.append(line)


def test_a_discovery_whose_bench_fails_has_the_error_and_keeps_what_an_earlier_one_recorded(
    folder, proposal, record, monkeypatch
) -> None:
    def gone(*_):
        raise DeviceError("--bench: the actuator is gone")

    found = SimpleNamespace(discovery=record.found, chosen=None, known=(), calibrated=None)
    monkeypatch.setattr(discovery_request, "_found", lambda *_: found)
    monkeypatch.setattr(discovery_request, "propose", lambda *_: proposal(menu(USUAL)[0]))
    monkeypatch.setattr(discovery_request, "fem_or_wave_table", lambda *_: None)
    monkeypatch.setattr(bench_loop, "rivals", lambda found: _pair(1e-3))
    monkeypatch.setattr(BenchWork, "record", gone)
    left, kept = (folder / name for name in (".found-wave.unfinished/session", "found-wave-experiments-1"))
    shutil.copytree(folder / "session", left)
    (left / "experiment_1_1.mcap").write_bytes(b"measured")
    request = DiscoverRequest([folder / "session"], out=folder / "found", bench=folder / "rig.toml")
    heard = Heard()
    told = answer_session(request, (), heard)
    assert not any("the same command moves it" in line for line in heard.lines)  # nothing was recorded
    assert isinstance(told.stopped, DeviceError)
    assert "--bench: the actuator is gone: the answer is that of the trials before" in told.found.warnings
    assert (kept / "experiment_1_1.mcap").read_bytes() == b"measured"
    assert any(line.startswith(str(kept)) for line in heard.lines)
    assert not (told.grown / "experiment_1_1.mcap").exists()


@pytest.mark.parametrize("rounds", [0, 1])
def test_an_interrupted_loop_says_where_its_recordings_are(folder, proposal, record, monkeypatch, rounds) -> None:
    answers = [SimpleNamespace(discovery=record.found, chosen=None, known=(), calibrated=None)] * rounds

    def decided(*_):
        if not answers:
            raise KeyboardInterrupt
        return answers.pop()

    monkeypatch.setattr(discovery_request, "_found", decided)
    monkeypatch.setattr(discovery_request, "propose", lambda *_: proposal(menu(USUAL)[-1]))
    monkeypatch.setattr(discovery_request, "fem_or_wave_table", lambda *_: None)
    monkeypatch.setattr(bench_loop, "rivals", lambda found: _pair(1e-3))
    monkeypatch.setattr(bench_loop, "leads", lambda found, standing: {})
    heard = Heard()
    request = DiscoverRequest([folder / "session"], out=folder / "found", bench=folder / "rig.toml")
    with pytest.raises(KeyboardInterrupt):
        answer_session(request, (), heard)
    grown = folder / ".found-wave.unfinished" / "session"
    assert bool(list(grown.glob("experiment_1_*.mcap"))) == bool(rounds)
    assert any(line.startswith(f"{grown}: what the bench has recorded") for line in heard.lines) == bool(rounds)
