"""Kill -9 and Ctrl-C at random moments: the same command again gives the same result, and nothing else has changed."""

from __future__ import annotations

import random
import shutil
import signal
import sys
import time
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.torture.commands import COMMANDS, Command, differences, digest, run
from tests.torture.scene import contents, make_litter


@dataclass
class Tally:
    """What was seen of a verb: moments, how many came before its end, and each kind of failure in words."""

    moments: int = 0
    hit: int = 0
    to_the_bit: int = 0
    credit: float = 0.0
    failures: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Usual:
    """A command that nobody kills: its seconds, and what comes of it by path."""

    seconds: float
    result: dict[str, Any]


def torture(scene: Path, until: float, seed: int, most: int, verbs: list[str]) -> dict[str, Tally]:
    """Kill commands in turn until the time or the number of moments is over; what was seen by verb."""
    tallies = defaultdict(Tally)
    draws = {verb: random.Random(f"{seed} {verb}") for verb in verbs}  # each verb's moments are its own
    usual: dict[str, Usual] = {}
    commands = [each for each in COMMANDS if each.verb in verbs]
    while sum(each.moments for each in tallies.values()) < most and time.monotonic() < until:
        for command in commands:
            tally = tallies[command.verb]
            tally.credit += command.share
            if tally.credit < 1.0 and tally.moments:
                continue
            tally.credit -= 1.0
            if time.monotonic() < until:
                if command.verb not in usual:
                    usual[command.verb] = _unkilled(scene, command, tally)
                known = len(tally.failures)
                _moment(scene, command, usual[command.verb], draws[command.verb], tally)
                for text in tally.failures[known:]:
                    print(f"{command.verb}: {text}", file=sys.stderr, flush=True)
    return dict(tallies)


def _unkilled(scene: Path, command: Command, tally: Tally) -> Usual:
    """How long a command takes, and what comes of it, where nobody kills it."""
    clear(scene, command)
    ended = run(command, scene)
    if ended.code not in (0, 1):
        tally.failures.append(f"unkilled it ended with {ended.code}: {ended.err[-200:]}")
    return Usual(ended.seconds, result(scene, command))


def _moment(scene: Path, command: Command, usual: Usual, draw: random.Random, tally: Tally) -> None:
    clear(scene, command)
    before = contents(scene, command.outs)
    if command.verb == "clean":
        make_litter(scene)
    how = draw.choice((signal.SIGKILL, signal.SIGINT))
    after = draw.uniform(0.02, 1.0) * usual.seconds
    killed = run(command, scene, kill=(after, how))
    tally.moments += 1
    tally.hit += killed.code in (-signal.SIGKILL, -signal.SIGINT, 130, 5)
    where = f"{how.name} after {after:.2f} of {usual.seconds:.2f} s"
    allowed = (0, 1, -how, 130, 5) if command.verb == "capture" else (0, 1, -how, 130)
    if killed.code not in allowed or not killed.is_plain:
        tally.failures.append(f"{where}: it ended with {killed.code}: {killed.err.strip()[-400:]}")
    if command.careful:  # it never writes over what is there: a person removes it
        clear(scene, command)
    again = run(command, scene)
    if again.code not in (0, 1):
        tally.failures.append(f"{where}: the next run ended with {again.code}: {again.err.strip()[-200:]}")
        return
    apart, far = differences(usual.result, result(scene, command))
    tally.to_the_bit += not apart
    if apart:
        how_far = "by more than 1e-6" if far else "by less than 1e-6"
        tally.failures.append(f"{where}: another result, {how_far}, in {', '.join(apart)}")
    left = contents(scene, command.outs)
    changed = sorted(name for name in {*before, *left} if before.get(name) != left.get(name))
    if changed:
        tally.failures.append(f"{where}: changed or left beside it: {', '.join(changed)}")


def result(scene: Path, command: Command) -> dict[str, Any]:
    """What must be the same of all that a command wrote."""
    there = [scene / name for name in command.outs if (scene / name).exists()]
    return {f"{place.name}/{name}": each for place in there for name, each in digest(place).items()}


def clear(scene: Path, command: Command) -> None:
    """Remove what a command wrote."""
    for place in (scene / name for name in command.outs):
        shutil.rmtree(place, ignore_errors=True) if place.is_dir() else place.unlink(missing_ok=True)


def rows(tallies: dict[str, Tally]) -> list[tuple[str, ...]]:
    """The table by verb."""
    head = ("verb", "moments", "before its end", "same to the bit", "failures")
    body = [(verb, str(t.moments), str(t.hit), str(t.to_the_bit), str(len(t.failures))) for verb, t in tallies.items()]
    total = [sum(int(row[k]) for row in body) for k in range(1, 5)]
    return [head, *body, ("all", *map(str, total))]
