"""Measured processes: the parent's handle on one, and one after the other until the answer is clear."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

from benchmark.child_processes import THREAD_VARIABLES
from benchmark.errors import InputError, NotComparableError, SolverError, TissuebenchError
from benchmark.gate.measuring.costs import KEPT_MEMORY
from benchmark.gate.plan import MEASURING, GatePlan
from benchmark.gate.statistics import log_ratio
from benchmark.models.user_file import NOT_FROM

PATIENCE = 5.0
LAST_LINES = 3
AMONG_ITS_OWN = "a relative path means the revision's own files there, and what git does not keep is not among them"
Blocks = list[dict[str, float]]
OnRound = Callable[[int, int], None]


class Side:
    """A process that measures the product in a tree; use as a context manager.

    Parameters
    ----------
    tree
        Folder with the packages to measure.
    revision
        What the tree is of, for messages; None for the version that runs this check.
    moved
        For a user's own models of another revision: their repository, and the folder with that revision's files. The
        process then runs in the place there of the current folder, so that a relative path means that revision's file.

    Raises
    ------
    InputError, SolverError
        From any command: the input, or the code of this version, is at fault.
    NotComparableError
        The same of another revision.
    """

    def __init__(self, tree: Path, revision: str | None = None, moved: tuple[Path, Path] | None = None):
        self._revision, self._moved = revision, moved
        place = None if moved is None else self._place(*moved)
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 (closed on leaving)
        command = [sys.executable, "-P", str(MEASURING / "child.py"), str(MEASURING.parent), str(tree)]
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            env=_environment(tree, temporary=revision is not None, moved=moved),
            cwd=place,
            text=True,
        )

    def _place(self, source: Path, target: Path) -> Path | None:
        """The current folder's place in `target`, made where the revision has none; None outside of `source`."""
        here = Path.cwd()
        if not here.is_relative_to(source):
            return None
        place = target / here.relative_to(source)
        try:
            if place.resolve().is_relative_to(target):  # a link of the revision's may lead out
                place.mkdir(parents=True, exist_ok=True)
                return place
        except (OSError, RuntimeError):  # a file, or a ring of links
            pass
        raise self._error(f"the current folder, {here}, is no folder there", fault=False)

    def values(self, plan: GatePlan) -> list[dict[str, Any]]:
        """The gated values: name, value, unit, reason."""
        return list(self._ask({"do": "values", "cases": plan.cases})["values"])

    def prepare(self, plan: GatePlan) -> bool:
        """Set the workloads up and warm them; whether waiting will be seen (see `measuring.costs`)."""
        return bool(self._ask({"do": "prepare", "timed": plan.jobs, "references": plan.references})["sees_waiting"])

    def block(self) -> dict[str, float]:
        """Seconds of one call of each workload and reference, all done in turn."""
        return dict(self._ask({"do": "block"})["seconds"])

    def _ask(self, command: Mapping[str, Any]) -> dict[str, Any]:
        assert self._process.stdin is not None, "it is a pipe"
        assert self._process.stdout is not None, "it is a pipe"
        try:
            self._process.stdin.write(json.dumps(command) + "\n")
            self._process.stdin.flush()
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            raise self._error(f"its process ended: {self._last_words()}", fault=True)
        answer: dict[str, Any] = json.loads(line)
        if "error" in answer:
            error = self._error(answer["error"], fault=answer["fault"])
            error.add_note(answer["trace"])
            raise error
        return answer

    def _error(self, text: str, *, fault: bool) -> TissuebenchError:
        """The error that a failure is: another revision cannot be compared with, this one is at fault itself."""
        if self._revision is not None:
            lost = f"; {AMONG_ITS_OWN}" if self._moved is not None and FileNotFoundError.__name__ in text else ""
            return NotComparableError(f"revision {self._revision} cannot be measured with this gate: {text}{lost}")
        return SolverError(f"the gate could not be measured: {text}") if fault else InputError(text)

    def _last_words(self) -> str:
        """The end of what the process wrote to stderr."""
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            return "it closed its output"
        self._errors.seek(0)
        lines = self._errors.read().decode("utf-8", "replace").strip().splitlines()
        return " | ".join(lines[-LAST_LINES:]) or f"exit code {self._process.returncode}"

    def __enter__(self) -> Side:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                stream.close()
        try:
            self._process.wait(PATIENCE if kind is None else 0.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._errors.close()


def _environment(tree: Path, *, temporary: bool, moved: tuple[Path, Path] | None = None) -> dict[str, str]:
    """One thread in every library, kept memory, no film kept from before, and the packages of `tree` first.

    A tree that is where packages are installed is found anyway, and must not go before the standard library.
    Code of a temporary tree is compiled once for all its processes, whatever the caller wants for other folders.
    What `moved` models import from folders of their repository comes from the other revision, too. Folders stay where
    they are though the process may run in another one; an empty entry is the current folder, wherever that is.
    """
    first = [] if str(tree) == sysconfig.get_path("purelib") else [str(tree)]
    moved_paths = [] if moved is None else _moved_paths(*moved, apart=tree)
    told = os.environ.get("PYTHONPATH")
    stated = [entry and str(Path(entry).absolute()) for entry in told.split(os.pathsep)] if told else []
    paths = os.pathsep.join([*first, *moved_paths, *stated])
    fixed = {
        "PYTHONPATH": paths,
        "PYTHONHASHSEED": "0",
        "TISSUEBENCH_CACHE": "",
        NOT_FROM: "" if moved is None else str(moved[0]),
        **KEPT_MEMORY,
        **dict.fromkeys(THREAD_VARIABLES, "1"),
    }
    left_out = {"PYTHONDONTWRITEBYTECODE"} if temporary else set()
    return {**{name: value for name, value in os.environ.items() if name not in left_out}, **fixed}


def _moved_paths(source: Path, target: Path, *, apart: Path) -> list[str]:
    """Folders in `target` in the place of those in `source` that modules are imported from; `apart` stays."""
    told = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    here = [entry for entry in sys.path if entry and Path(entry).resolve() != Path.cwd()]
    folders = [Path(entry).resolve() for entry in (*filter(None, told), *here)]
    inside = [each for each in folders if each.is_relative_to(source) and each != apart.resolve()]
    moved = dict.fromkeys(target / each.relative_to(source) for each in inside)
    return [str(each) for each in moved if each.is_dir()]


@dataclass(frozen=True)
class Party:
    """One side of a comparison: how its processes are started, and what they are told."""

    start: Callable[[], Side]
    plan: GatePlan


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
        Whether sleeping and waiting counted (see `measuring.costs`).
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


def _extended(ratios: Mapping[str, list[float]], plan: GatePlan, blocks: Blocks) -> dict[str, list[float]]:
    """The log ratios with those of one more process."""
    extended = {}
    for timed in plan.file.timed:
        seconds = [block[timed.name] for block in blocks]
        references = [[block[name] for block in blocks] for name in timed.references]
        extended[timed.name] = [*ratios[timed.name], log_ratio(seconds, references)]
    return extended
