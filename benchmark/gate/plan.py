"""What a check was asked for, and what is to be measured: a gate file with its scenarios, sessions and own models."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.files.loading import read_file
from benchmark.files.schema import validated
from benchmark.files.shipped import find
from benchmark.gate.baseline import DEFAULT
from benchmark.gate.gate_file import GatedWork, GateFile, Timed, gate_path
from benchmark.gate.history.history_file import IN_FOLDER, history_path
from benchmark.sessions import SHIPPED


@dataclass(frozen=True)
class CheckRequest:
    """See `python -m benchmark check --help`.

    Attributes
    ----------
    baseline
        The baseline file; None for `tissuebench-baseline.json` in the current folder.
    against
        Another revision to measure beside this version.
    gate
        The gate file; None for the shipped one.
    history
        The history file, or a folder for it; None for the one beside the baseline.
    out
        Folder of the report; None for `results/check-DATE-TIME`.
    seed
        Of the bootstrap.
    junit, markdown
        Files for a CI service; None for none.
    """

    baseline: Path | None = None
    against: str | None = None
    gate: Path | None = None
    history: Path | None = None
    out: Path | None = None
    seed: int = 0
    junit: Path | None = None
    markdown: Path | None = None

    @property
    def baseline_path(self) -> Path:
        """Where the baseline is."""
        return DEFAULT if self.baseline is None else self.baseline

    @property
    def history_path(self) -> Path:
        """Where the history is."""
        if self.history is None:
            return history_path(self.baseline_path)
        return self.history / IN_FOLDER if self.history.is_dir() else self.history


MEASURING = Path(__file__).parent / "measuring"
NO_TIME = re.compile(r"^ *# no time: begin\n.*?^ *# no time: end\n", re.DOTALL | re.MULTILINE)


@dataclass(frozen=True)
class GatePlan:
    """A gate ready to be measured.

    Attributes
    ----------
    file
        As read.
    path
        Where it stands.
    cases, jobs
        What measured processes are told, as plain tables with absolute paths.
    references
        Names of the references that any timed quantity needs.
    fingerprint
        SHA-256 over everything that decides a time apart from the product: timed quantities, their scenarios and the
        measuring code. Ratios of another fingerprint cannot be compared.
    """

    file: GateFile
    path: Path
    cases: tuple[Mapping[str, Any], ...]
    jobs: tuple[Mapping[str, Any], ...]
    references: tuple[str, ...]
    fingerprint: str

    @property
    def shipped(self) -> bool:
        """Whether it is the product's own gate."""
        return self.path == gate_path(None)

    def moved(self, source: Path, target: Path) -> GatePlan:
        """Return the plan with users' models taken from `target` where they stand in `source`; inputs stay."""

        def move(table: Mapping[str, Any]) -> Mapping[str, Any]:
            own = table["own"]
            inside = own is not None and Path(own).is_relative_to(source)
            return {**table, "own": str(target / Path(own).relative_to(source))} if inside else table

        cases, jobs = (tuple(map(move, tables)) for tables in (self.cases, self.jobs))
        return GatePlan(self.file, self.path, cases, jobs, self.references, self.fingerprint)


def load_plan(path: Path | None) -> GatePlan:
    """Read a gate file, the shipped one by default, and find what it names.

    Raises
    ------
    InputError
        A file that is missing or cannot be used, with file, key and what is allowed.
    """
    found = gate_path(path).resolve()
    table, source = read_file(found, "gate")
    file = validated(GateFile, table, source)
    cases = tuple({**_job(case, found), "model": case.model, "expected": case.expected} for case in file.cases)
    jobs = tuple(_timed_job(timed, found) for timed in file.timed)
    references = tuple(dict.fromkeys(name for timed in file.timed for name in timed.references))
    return GatePlan(file, found, cases, jobs, references, _fingerprint(jobs, references))


def _timed_job(timed: Timed, gate: Path) -> dict[str, Any]:
    return {**_job(timed, gate), "model": timed.model, "workload": timed.workload, "calls": timed.calls}


def _job(work: GatedWork, gate: Path) -> dict[str, Any]:
    """Name and absolute paths; every file is looked at, so that a mistake shows before anything long begins."""
    return {
        "name": work.name,
        "scenario": None if work.scenario is None else _scenario(work, work.scenario, gate),
        "set": dict(work.set),
        "session": None if work.session is None else _session(work.session, gate),
        "own": None if work.own is None else _own(work.own, gate),
    }


def _scenario(work: GatedWork, name: str, gate: Path) -> str:
    path = find(name, "scenario", gate.parent).resolve()
    try:
        load_scenario(path, work.set)
    except InputError as error:
        raise InputError(f"{gate}, {work.name}: {str(error).replace('--set ', 'set ', 1)}") from None
    return str(path)


def _session(name: str, gate: Path) -> str:
    shipped = SHIPPED / name
    path = shipped if "/" not in name and (shipped / "session.toml").is_file() else gate.parent / name
    if not path.exists():
        raise InputError(f"{gate}: there is no session {name!r}; give a folder or a shipped session, such as phantom")
    return str(path.resolve())


def _own(name: str, gate: Path) -> str:
    path = (gate.parent / name).resolve()
    if not path.is_file():
        raise InputError(f"{gate}: there is no model file {str(path)!r}; give a Python file for own")
    return str(path)


OWN_ALONE = "its functions alone, each time under another load"
"""How a user's own model is timed; baselines that timed the reading of its results, or its memory, are others."""


def _fingerprint(jobs: tuple[Mapping[str, Any], ...], references: tuple[str, ...]) -> str:
    described = [{**job, "scenario": _text(job["scenario"]), "session": _text(job["session"])} for job in jobs]
    for job, table in zip(jobs, described, strict=True):
        table["own"] = job["own"] is not None and OWN_ALONE
    code = {path.name: timed_text(path.read_text(encoding="utf-8")) for path in sorted(MEASURING.glob("*.py"))}
    whole = json.dumps([described, references, code], sort_keys=True)
    return hashlib.sha256(whole.encode()).hexdigest()


def timed_text(code: str) -> str:
    """Measuring code without the lines that decide no time, from `# no time: begin` to `# no time: end`.

    They may change without making the times of every baseline worthless.
    """
    return NO_TIME.sub("", code)


def _text(path: str | None) -> str:
    """The content of a scenario, or of a session's own file; nothing for a bare folder of trials."""
    if path is None:
        return ""
    file = Path(path) / "session.toml" if Path(path).is_dir() else Path(path)
    return file.read_text(encoding="utf-8") if file.is_file() else ""
