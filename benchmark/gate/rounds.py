"""Measured processes one after the other, until the answer is clear."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass

from benchmark.gate.plan import Plan
from benchmark.gate.side import Side
from benchmark.gate.statistics import log_ratio

Blocks = list[dict[str, float]]
Start = Callable[[], Side]
OnRound = Callable[[int, int], None]


@dataclass(frozen=True)
class Party:
    """One side of a comparison: how its processes are started, and what they are told."""

    start: Start
    plan: Plan


@dataclass(frozen=True)
class Measured:
    """What was measured.

    Attributes
    ----------
    ratios
        For each party, the log ratios of its processes by timed quantity.
    rounds
        Processes of each party.
    sees_waiting
        Whether sleeping and waiting counted (see `measuring.clock`).
    """

    ratios: tuple[dict[str, list[float]], ...]
    rounds: int
    sees_waiting: bool


def measure(parties: tuple[Party, ...], clear: Callable[[Measured], bool], on_round: OnRound) -> Measured:
    """Run rounds of fresh processes, one a party, blocks of the parties in turn.

    Parameters
    ----------
    parties
        This version, and another revision where there is one; A B, then B A, so that none is always first.
    clear
        Asked after the fewest rounds, and each further one, whether that is enough.
    on_round
        Told the rounds done and the most there can be; never where nothing is timed.
    """
    timing = parties[0].plan.file.timing
    fewest, most = timing.rounds
    found = Measured(tuple({job["name"]: [] for job in each.plan.jobs} for each in parties), 0, True)
    while parties[0].plan.jobs and found.rounds < most and not (found.rounds >= fewest and clear(found)):
        found = _with_round(found, parties, timing.blocks)
        on_round(found.rounds, most)
    return found


def _with_round(found: Measured, parties: tuple[Party, ...], blocks: int) -> Measured:
    """One more process of each party."""
    with ExitStack() as stack:
        sides = [stack.enter_context(party.start()) for party in parties]
        seen = [side.prepare(party.plan) for side, party in zip(sides, parties, strict=True)]
        taken: list[Blocks] = [[] for _ in sides]
        for number in range(blocks):
            order = range(len(sides)) if (number + found.rounds) % 2 == 0 else reversed(range(len(sides)))
            for index in order:
                taken[index].append(sides[index].block())
    ratios = tuple(
        _extended(before, party.plan, rows) for before, party, rows in zip(found.ratios, parties, taken, strict=True)
    )
    return Measured(ratios, found.rounds + 1, found.sees_waiting and all(seen))


def _extended(ratios: Mapping[str, list[float]], plan: Plan, blocks: Blocks) -> dict[str, list[float]]:
    """The log ratios with those of one more process."""
    extended = {}
    for timed in plan.file.timed:
        seconds = [block[timed.name] for block in blocks]
        references = [[block[name] for block in blocks] for name in timed.references]
        extended[timed.name] = [*ratios[timed.name], log_ratio(seconds, references)]
    return extended
