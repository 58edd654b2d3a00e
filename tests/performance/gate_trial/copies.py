"""Copies of the product, each in a repository of its own, and checks run in them."""

from __future__ import annotations

import json
import os
import re
import resource
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.performance.gate_trial.faults import Fault

PRODUCT = Path(__file__).resolve().parents[3]
GATE = Path("benchmark/gate/default.toml")
PACKAGES = ("benchmark", "fem", "wavemodel", "bench_hw", "reports")
AUTHOR = ("-c", "user.name=gate trial", "-c", "user.email=gate-trial@localhost")


@dataclass(frozen=True)
class Check:
    """One check of a copy.

    Attributes
    ----------
    copy
        Its name.
    code
        Exit code.
    seconds, cpu_seconds
        Wall time, and CPU time of all its processes.
    load
        Load average of the last minute at its end, its own processes included.
    document
        What `check --json` printed; None where it failed.
    message
        What it said.
    """

    copy: str
    code: int
    seconds: float
    cpu_seconds: float
    load: float
    document: dict[str, Any] | None
    message: str

    def to_dict(self) -> dict[str, Any]:
        """As plain types, the document without what a trial does not need."""
        kept = ("passed", "accuracy", "timing", "rounds", "warnings")
        document = None if self.document is None else {key: self.document[key] for key in kept}
        return {**vars(self), "document": document}


def make_copy(folder: Path, source: Path = PRODUCT) -> Path:
    """Copy the product's packages into `folder` and commit them there."""
    for package in PACKAGES:
        shutil.copytree(source / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    for arguments in (("init", "--quiet"), ("add", "."), (*AUTHOR, "commit", "--quiet", "-m", "as it is")):
        subprocess.run(["git", "-C", str(folder), *arguments], check=True, capture_output=True)
    return folder


def make_faulty(folder: Path, good: Path, faults: Sequence[Fault]) -> Path:
    """Copy a copy and put faults into it, uncommitted."""
    shutil.copytree(good, folder)
    for fault in faults:
        fault.put_into(folder)
    return folder


def values_gate(tree: Path) -> Path:
    """Write the gate of the product in `tree` without what it times, and return its path."""
    text = (tree / GATE).read_text(encoding="utf-8")
    kept = [part for part in re.split(r"(?m)^(?=\[)", text) if not part.startswith("[[timed]]")]
    path = (tree / GATE).with_name("values.toml")
    path.write_text("".join(kept), encoding="utf-8")
    return path


def times_gate(tree: Path) -> Path:
    """Write the gate of the product in `tree` with its first case alone and all that it times; return its path."""
    text = (tree / GATE).read_text(encoding="utf-8")
    parts = re.split(r"(?m)^(?=\[)", text)
    first = next(part for part in parts if part.startswith("[[cases]]"))
    kept = [part for part in parts if part is first or not part.startswith("[[cases]]")]
    path = (tree / GATE).with_name("times.toml")
    path.write_text("".join(kept), encoding="utf-8")
    return path


def run_check(name: str, tree: Path, work: Path, *options: str) -> Check:
    """Run `python -m benchmark check` of the product in `tree`, in the folder `work`; its code is compiled once."""
    command = [sys.executable, "-m", "benchmark", "check", "--json", "--quiet", *options]
    environment = {**os.environ, "PYTHONPATH": str(tree)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    begun, spent = time.perf_counter(), _spent()
    done = subprocess.run(command, cwd=work, env=environment, capture_output=True, text=True, check=False)
    return Check(
        copy=name,
        code=done.returncode,
        seconds=time.perf_counter() - begun,
        cpu_seconds=_spent() - spent,
        load=os.getloadavg()[0],
        document=json.loads(done.stdout) if done.stdout.strip() else None,
        message=done.stderr.strip(),
    )


def _spent() -> float:
    """CPU time of all processes that were started from here and have ended, in s."""
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    return ended.ru_utime + ended.ru_stime
