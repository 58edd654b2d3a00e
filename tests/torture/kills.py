"""Kill -9 and Ctrl-C at random moments: the same command again gives the same result, and nothing else has changed."""

from __future__ import annotations

import random
import shutil
import signal
import time
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.torture.commands import COMMANDS, Command, differences, digest, run
from tests.torture.scene import contents

LONG, SELDOM = 10.0, 4
"""A command of more seconds than this gets its turn every fourth time."""


@dataclass
class Tally:
    """What was seen of a verb: moments, how many came before its end, and each kind of failure in words."""

    moments: int = 0
    hit: int = 0
    to_the_bit: int = 0
    within: int = 0
    failures: list[str] = field(default_factory=list)


def torture(scene: Path, until: float, seed: int, most: int, verbs: list[str]) -> dict[str, Tally]:
    """Kill commands in turn until the time or the number of moments is over; what was seen by verb."""
    draw, tallies = random.Random(seed), defaultdict(Tally)
    usual: dict[str, tuple[float, dict[str, Any]]] = {}
    done = turn = 0
    while done < most and time.monotonic() < until:
        for number, command in enumerate(each for each in COMMANDS if each.verb in verbs):
            if done >= most or time.monotonic() > until:
                break
            if command.verb not in usual:
                usual[command.verb] = _unkilled(scene, command, tallies[command.verb])
            elif usual[command.verb][0] > LONG and (turn + number) % SELDOM:
                continue
            _moment(scene, command, usual[command.verb], draw, tallies[command.verb])
            done += 1
        turn += 1
    return dict(tallies)


def _unkilled(scene: Path, command: Command, tally: Tally) -> tuple[float, dict[str, Any]]:
    """How long a command takes, and what comes of it, where nobody kills it."""
    _clear(scene, command)
    ended = run(command, scene)
    if ended.code not in (0, 1):
        tally.failures.append(f"unkilled it ended with {ended.code}: {ended.err[-200:]}")
    place = scene / command.out
    return ended.seconds, digest(place) if place.exists() else {}


def _moment(
    scene: Path, command: Command, usual: tuple[float, dict[str, Any]], draw: random.Random, tally: Tally
) -> None:
    _clear(scene, command)
    before = contents(scene, (command.out,))
    how = draw.choice((signal.SIGKILL, signal.SIGINT))
    after = draw.uniform(0.02, 1.0) * usual[0]
    killed = run(command, scene, kill=(after, how))
    tally.moments += 1
    tally.hit += killed.code in (-signal.SIGKILL, -signal.SIGINT, 130, 5)
    where = f"{how.name} after {after:.2f} s"
    if command.verb in ("tissues new", "capture") and (scene / command.out).exists():
        _clear(scene, command)  # these never write over what is there: a person gives another name, or removes it
    again = run(command, scene)
    if again.code not in (0, 1):
        tally.failures.append(f"{where}: the next run ended with {again.code}: {again.err.strip()[-200:]}")
        return
    apart, far = differences(usual[1], digest(scene / command.out))
    tally.to_the_bit += not apart
    tally.within += not far
    if far:
        tally.failures.append(f"{where}: another result in {', '.join(far)}")
    left = contents(scene, (command.out,))
    changed = sorted(name for name in {*before, *left} if before.get(name) != left.get(name))
    if changed:
        tally.failures.append(f"{where}: changed or left beside it: {', '.join(changed)}")


def _clear(scene: Path, command: Command) -> None:
    place = scene / command.out
    shutil.rmtree(place, ignore_errors=True) if place.is_dir() else place.unlink(missing_ok=True)


def rows(tallies: dict[str, Tally]) -> list[tuple[str, ...]]:
    """The table by verb."""
    head = ("verb", "moments", "before its end", "same to the bit", "same within 1e-6", "failures")
    body = [
        (verb, str(t.moments), str(t.hit), str(t.to_the_bit), str(t.within), str(len(t.failures)))
        for verb, t in tallies.items()
    ]
    total = [sum(int(row[k]) for row in body) for k in range(1, 6)]
    return [head, *body, ("all", *map(str, total))]
