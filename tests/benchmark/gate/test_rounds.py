"""Rounds of measured processes, with processes that only count."""

import math
from typing import Self

import pytest

from benchmark.gate.plan import Plan, load_plan
from benchmark.gate.rounds import Measured, Party, measure


class Counter:
    """A side that takes `seconds` for its workload and writes down who was asked when."""

    def __init__(self, name: str, seconds: float, log: list[str], *, sees_waiting: bool = True):
        self.name, self.seconds, self.log, self.sees_waiting = name, seconds, log, sees_waiting

    def prepare(self, plan: Plan) -> bool:
        self.log.append(f"prepare {self.name}")
        return self.sees_waiting

    def block(self) -> dict[str, float]:
        self.log.append(self.name)
        return {"springs.history": self.seconds, "dense": 0.5}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.log.append(f"end {self.name}")


@pytest.fixture
def plan(tiny_gate) -> Plan:
    gate = tiny_gate(timed=True)
    gate.change("gate.toml", "rounds = [1, 1]\nblocks = 2", "rounds = [2, 4]\nblocks = 3")
    return load_plan(gate.path)


def party(plan: Plan, name: str, seconds: float, log: list[str], **options: bool) -> Party:
    return Party(lambda: Counter(name, seconds, log, **options), plan)


def test_each_round_is_a_fresh_process_with_its_ratio(plan: Plan) -> None:
    log: list[str] = []
    told: list[tuple[int, int]] = []
    found = measure((party(plan, "A", 2.0, log),), lambda _: False, lambda *round_: told.append(round_))
    assert log == ["prepare A", "A", "A", "A", "end A"] * 4
    assert told == [(1, 4), (2, 4), (3, 4), (4, 4)]
    assert found.ratios[0]["springs.history"] == pytest.approx([math.log(4.0)] * 4)
    assert found.rounds == 4


def test_measuring_ends_where_it_is_clear_but_never_before_the_fewest(plan: Plan) -> None:
    asked: list[int] = []

    def clear(found: Measured) -> bool:
        asked.append(found.rounds)
        return found.rounds == 3

    assert measure((party(plan, "A", 2.0, []),), clear, lambda *_: None).rounds == 3
    assert asked == [2, 3]


def test_two_sides_take_turns_and_none_is_always_first(plan: Plan) -> None:
    log: list[str] = []
    parties = (party(plan, "A", 2.0, log), party(plan, "B", 1.0, log))
    found = measure(parties, lambda _: True, lambda *_: None)
    blocks = [each for each in log if len(each) == 1]
    assert "".join(blocks) == "ABBAAB" + "BAABBA"
    assert found.ratios[0]["springs.history"] == pytest.approx([math.log(4.0)] * 2)
    assert found.ratios[1]["springs.history"] == pytest.approx([math.log(2.0)] * 2)


def test_one_blind_side_makes_the_whole_blind(plan: Plan) -> None:
    parties = (party(plan, "A", 1.0, []), party(plan, "B", 1.0, [], sees_waiting=False))
    assert not measure(parties, lambda _: True, lambda *_: None).sees_waiting


def test_nothing_timed_starts_no_process(tiny_gate) -> None:
    log: list[str] = []
    found = measure((party(load_plan(tiny_gate().path), "A", 1.0, log),), lambda _: False, lambda *_: None)
    assert (log, found.rounds, found.ratios) == ([], 0, ({},))
