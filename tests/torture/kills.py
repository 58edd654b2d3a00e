"""Kill -9 and Ctrl-C at random moments: the same command again gives the same result, and nothing else has changed."""

from __future__ import annotations

import random
import shutil
import signal
import sys
import tempfile
import time
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.torture.commands import COMMANDS, Command, Ended, differences, digest, run
from tests.torture.journal import Journal
from tests.torture.scene import contents, make_litter

PART = "kills"
SIGNALS = (signal.SIGKILL, signal.SIGINT)
ANEW = 4
"""Of so many moments one is of what a person starts, `python -m`, from its imports on; the others are of forks."""
STARTING = 3.0
"""Seconds in which a process of its own begins and ends, beside what a fork takes."""


@dataclass(frozen=True)
class Usual:
    """A command that nobody kills: its seconds, and what comes of it by path."""

    seconds: float
    result: dict[str, Any]


def torture(scene: Path, until: float, seed: int, most: int, verbs: list[str], journal: Journal) -> None:
    """Kill commands in turn until the time or the number of moments is over; the journal's own are counted."""
    credits: dict[str, float] = defaultdict(lambda: 1.0)
    usual: dict[str, Usual] = {}
    while len(journal.of(PART)) < most and time.monotonic() < until:
        for command in (each for each in COMMANDS if each.verb in verbs):
            credits[command.verb] += command.share
            if credits[command.verb] < 1.0 or _is_ahead(command, journal, verbs):
                continue
            credits[command.verb] -= 1.0
            if time.monotonic() < until and len(journal.of(PART)) < most:
                if command.verb not in usual:
                    usual[command.verb] = _unkilled(scene, command, journal)
                _moment(scene, command, usual[command.verb], seed, journal)


def _is_ahead(command: Command, journal: Journal, verbs: list[str]) -> bool:
    """Whether the journal has more moments of a command than of the others, by its share."""
    counts = {each.verb: _count(journal, each.verb) / each.share for each in COMMANDS if each.verb in verbs}
    return counts[command.verb] > min(counts.values()) + 1.0 / command.share


def _count(journal: Journal, verb: str) -> int:
    return sum(each["verb"] == verb for each in journal.of(PART))


def _unkilled(scene: Path, command: Command, journal: Journal) -> Usual:
    """How long a command takes, and what comes of it, where nobody kills it."""
    _begin(scene, command)
    ended = run(command, scene)
    if ended.code not in (0, 1):
        _say(command, f"unkilled it ended with {ended.code}: {ended.err[-300:]}")
        journal.add("unkilled", verb=command.verb, failures=[f"it ended with {ended.code}: {ended.err[-300:]}"])
    return Usual(ended.seconds, result(scene, command))


def _begin(scene: Path, command: Command) -> None:
    clear(scene, command)
    if command.verb == "clean":
        make_litter(scene)


def _moment(scene: Path, command: Command, usual: Usual, seed: int, journal: Journal) -> None:
    """Kill a command once, run it again, and keep what was seen."""
    index = _count(journal, command.verb)
    draw = random.Random(f"{seed} {command.verb} {index}")
    anew = index % ANEW == ANEW // 2
    how, after = SIGNALS[draw.randrange(2)], draw.uniform(0.02, 1.0) * (usual.seconds + STARTING * anew)
    clear(scene, command)
    before = {**contents(scene, command.outs), **_temporary()}
    _begin(scene, command)
    killed = run(command, scene, kill=(after, how), anew=anew)
    failures = _ending(command, killed, how, anew)
    if command.careful:  # it never writes over what is there: a person removes it
        failures += _not_whole(scene, command, usual)
        clear(scene, command)
    again = run(command, scene)
    apart: list[str] = []
    if again.code not in (0, 1):
        failures.append(f"the next run ended with {again.code}: {again.err.strip()[-300:]}")
    else:
        apart, far = differences(usual.result, result(scene, command))
        if apart:
            failures.append(f"another result, by {'more' if far else 'less'} than 1e-6, in {', '.join(apart)}")
    failures += _beside(scene, command, before)
    for text in failures:
        _say(command, f"{how.name} after {after:.2f} of {usual.seconds:.2f} s: {text}")
    journal.add(
        PART,
        verb=command.verb,
        seed=seed,
        index=index,
        signal=how.name,
        anew=anew,
        after=round(after, 3),
        usual=round(usual.seconds, 3),
        hit=killed.code in (-signal.SIGKILL, -signal.SIGINT, 130, 5),
        same=again.code in (0, 1) and not apart,
        failures=failures,
    )


def _ending(command: Command, killed: Ended, how: signal.Signals, anew: bool) -> list[str]:
    """What is wrong with how a killed command ended."""
    allowed = (0, 1, -how, 130, 5) if command.words[0] in ("capture", "simulate") else (0, 1, -how, 130)
    ours = any(text in killed.err for text in ("__main__.py", "multiprocessing", "concurrent"))
    before_us = anew and not ours  # Python itself was not ready yet: its words are its own
    if killed.code in allowed and (killed.is_plain or before_us):
        return []
    return [f"it ended with {killed.code}: {killed.err.strip()[-400:]}"]


def _not_whole(scene: Path, command: Command, usual: Usual) -> list[str]:
    """What a command that writes over nothing left in its place when it was killed, if it is not whole."""
    if command.words[0] in ("capture", "simulate"):  # what was recorded stays, as far as it got
        return []
    there = result(scene, command)
    torn = [name for name in there if there[name] != usual.result.get(name)]
    return [f"not whole in its place: {', '.join(torn)}"] if torn else []


def _temporary() -> dict[str, str]:
    """What lies where the system has temporary files, by its whole path."""
    return {str(path): "temporary" for path in Path(tempfile.gettempdir()).iterdir()}


def _beside(scene: Path, command: Command, before: dict[str, str]) -> list[str]:
    """What changed or was left beside the result; it is taken away, so that the next moment begins clean."""
    left = {**contents(scene, command.outs), **_temporary()}
    changed = sorted(name for name in {*before, *left} if before.get(name) != left.get(name))
    for name in set(left) - set(before):
        place = scene / name
        shutil.rmtree(place) if place.is_dir() else place.unlink()
    return [f"changed or left beside it: {', '.join(changed)}"] if changed else []


def _say(command: Command, text: str) -> None:
    print(f"{command.verb}: {text}", file=sys.stderr, flush=True)


def result(scene: Path, command: Command) -> dict[str, Any]:
    """What must be the same of all that a command wrote."""
    there = [scene / name for name in command.outs if (scene / name).exists()]
    return {f"{place.name}/{name}": each for place in there for name, each in digest(place).items()}


def clear(scene: Path, command: Command) -> None:
    """Remove what a command wrote."""
    for place in (scene / name for name in command.outs):
        shutil.rmtree(place, ignore_errors=True) if place.is_dir() else place.unlink(missing_ok=True)


def failures(journal: Journal) -> list[str]:
    """All of them, in words."""
    tried = [*journal.of("unkilled"), *journal.of(PART)]
    return [f"{each['verb']}: {text}" for each in tried for text in each["failures"]]


def rows(journal: Journal) -> list[tuple[str, ...]]:
    """The table by verb."""
    moments = journal.of(PART)
    verbs = [each.verb for each in COMMANDS if any(moment["verb"] == each.verb for moment in moments)]
    body = [_row(verb, [each for each in moments if each["verb"] == verb]) for verb in verbs]
    head = ("verb", "moments", "of them SIGKILL", "python -m", "before its end", "same to the bit", "failures")
    return [head, *body, _row("all", moments)]


def _row(verb: str, moments: list[dict[str, Any]]) -> tuple[str, ...]:
    killed = sum(each["signal"] == "SIGKILL" for each in moments)
    counts = [sum(bool(each[key]) for each in moments) for key in ("hit", "same", "failures")]
    anew = sum(each["anew"] for each in moments)
    return (verb, *map(str, (len(moments), killed, anew, *counts)))
