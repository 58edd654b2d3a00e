"""Copies of the product, each in a repository of its own, and checks run in them."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.gate_trial.faults import Fault

PRODUCT = Path(__file__).resolve().parents[2]
GATE = Path("benchmark/gate/default.toml")
PACKAGES = ("benchmark", "fem", "wavemodel", "bench_hw", "reports")
AUTHOR = ("-c", "user.name=gate trial", "-c", "user.email=gate-trial@localhost")


@dataclass(frozen=True)
class Check:
    """One check: which copy, exit code, wall seconds, and what `check --json` printed (None where it failed)."""

    copy: str
    code: int
    seconds: float
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


def make_faulty(folder: Path, good: Path, fault: Fault) -> Path:
    """Copy a copy and put a fault into it, uncommitted."""
    shutil.copytree(good, folder)
    fault.put_into(folder)
    return folder


def values_gate(tree: Path) -> Path:
    """Write the gate of the product in `tree` without what it times, and return its path."""
    text = (tree / GATE).read_text(encoding="utf-8")
    kept = [part for part in re.split(r"(?m)^(?=\[)", text) if not part.startswith("[[timed]]")]
    path = (tree / GATE).with_name("values.toml")
    path.write_text("".join(kept), encoding="utf-8")
    return path


def run_check(name: str, tree: Path, work: Path, *options: str) -> Check:
    """Run `python -m benchmark check` of the product in `tree`, in the folder `work`."""
    command = [sys.executable, "-m", "benchmark", "check", "--json", "--quiet", *options]
    environment = {**os.environ, "PYTHONPATH": str(tree)}
    begun = time.perf_counter()
    done = subprocess.run(command, cwd=work, env=environment, capture_output=True, text=True, check=False)
    seconds = time.perf_counter() - begun
    document = json.loads(done.stdout) if done.stdout.strip() else None
    return Check(name, done.returncode, seconds, document, done.stderr.strip())
