"""The commands that are tortured, cheap ones of every verb; how one is run, and what of its result must be the same."""

from __future__ import annotations

import csv
import hashlib
import json
import math
import os
import re
import signal
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

COARSE = ("fem.mesh=coarse", "fem.kinematics=linear", "wave.large_press=linear", "load.observations=4")
VARIED = ("--vary", "tool.radius=4 mm,5 mm", "--workers", "1")
SETTINGS = tuple(word for setting in COARSE for word in ("--set", setting))

MAPS = tuple(
    word
    for name, unit in (("time_s", "s"), ("depth_mm", "mm"), ("force_N", "N"))
    for word in ("--map", f"{name}={name}:{unit}")
)


@dataclass(frozen=True)
class Command:
    """A command line by the name of its verb, `module` what it belongs to, and the path that it writes."""

    verb: str
    module: str
    words: tuple[str, ...]
    out: str = "p"
    exact: bool = True


COMMANDS = (
    Command("tissues new", "benchmark", ("tissues", "new", "p"), "p.toml"),
    Command("import", "bench_hw", ("import", "foreign.csv", *MAPS, "--out", "p.csv"), "p.csv"),
    Command("export", "bench_hw", ("export", "trial.mcap", "--out", "p")),
    Command("recover", "bench_hw", ("recover", "cut.mcap", "--out", "p.mcap"), "p.mcap"),
    Command("track", "bench_hw", ("track", "pictures", "--camera", "camera.toml", "--out", "p.csv"), "p.csv"),
    Command("verify", "benchmark", ("verify", "hertz", "--out", "p")),
    Command("report", "benchmark", ("report", "finished", "--out", "p")),
    Command("fit", "benchmark", ("fit", "session", "--out", "p")),
    Command("capture", "bench_hw", ("capture", "paper_press", "--rig", "simulated", "--fast", "--quiet", "--out", "p")),
    Command("sweep", "benchmark", ("sweep", "skin-5N", *SETTINGS, *VARIED, "--out", "p")),
    Command("run", "benchmark", ("run", "skin-5N", *SETTINGS, "--out", "p")),
    Command("discover", "benchmark", ("discover", "session", "--out", "p")),
)  # fmt: skip


@dataclass(frozen=True)
class Ended:
    """How a process ended: its exit code (negative for a signal), standard error, and the seconds it took."""

    code: int
    err: str
    seconds: float


def run(command: Command, folder: Path, *, kill: tuple[float, int] | None = None, before: str = "") -> Ended:
    """Run a command in a fork of this process, which has imported the libraries; `kill` is (seconds, signal).

    `before` is Python that the child runs first: faults of disk and memory are put in by it. A child that takes five
    minutes counts as hanging.
    """
    err = folder.parent / f"{folder.name}.stderr"
    started = time.monotonic()
    child = os.fork()
    if child == 0:
        _child(command, folder, err, before)
    code = _wait(child, started, kill)
    return Ended(code, err.read_text(encoding="utf-8", errors="replace"), time.monotonic() - started)


def _wait(child: int, started: float, kill: tuple[float, int] | None) -> int:
    while time.monotonic() - started < 300.0:
        found, status = os.waitpid(child, os.WNOHANG)
        if found:
            return os.waitstatus_to_exitcode(status)
        if kill is not None and time.monotonic() - started >= kill[0]:
            os.killpg(child, kill[1]) if kill[1] == signal.SIGINT else os.kill(child, kill[1])
            kill = None
        time.sleep(0.002)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return 999


def _child(command: Command, folder: Path, err: Path, before: str) -> None:
    """Never returns."""
    os.setpgid(0, 0)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.chdir(folder)
    os.dup2(os.open(err, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 2)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    code = 70
    try:
        if before:
            exec(before, {})
        code = _main(command)
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 1
    except KeyboardInterrupt:
        code = 130
    finally:
        sys.stderr.flush()
        os._exit(code)


def _main(command: Command) -> int:
    sys.argv = ["torture", *command.words]
    if command.module == "benchmark":
        from benchmark.cli.app import main

        return main(list(command.words))
    from bench_hw.cli import main as bench

    bench()
    return 0


VOLATILE = re.compile(
    r"second|wall|cpu|setup|time|speedup|memory|made|date|started|duration|out$|file$|machine|processor|resumed|path",
    re.I,
)
"""Keys whose values are of the clock or the machine."""
CLOCKED = ("seconds", "setup_s", "wall_s", "cpu_s")
SKIPPED = ("environment.json", "manifest.json", "timing.csv", "report.html", "capture.json", "journal.jsonl")
"""Files that hold little else, or pages that show it; they must be there."""


def digest(path: Path) -> dict[str, Any]:
    """What must be the same of a result, by file: numbers of JSON, and bytes of the rest, times apart."""
    if path.is_file():
        return {path.name: _of_file(path)}
    return {
        file.relative_to(path).as_posix(): _of_file(file)
        for file in sorted(path.rglob("*"))
        if file.is_file() and not file.name.endswith((".parquet", ".mcap"))
    }


def _of_file(path: Path) -> Any:
    if path.name in SKIPPED:
        return "there"
    if path.suffix == ".json":
        return _steady(json.loads(path.read_text(encoding="utf-8")))
    if path.suffix == ".csv":
        rows = list(csv.reader(path.read_text(encoding="utf-8").splitlines()))
        return [[cell for name, cell in zip(rows[0], row, strict=True) if name not in CLOCKED] for row in rows]
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _steady(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _steady(each) for key, each in value.items() if not VOLATILE.search(key)}
    if isinstance(value, list):
        return [_steady(each) for each in value]
    return value


def differences(first: dict[str, Any], second: dict[str, Any]) -> tuple[list[str], list[str]]:
    """Files that differ at all, and those that differ by more than 1e-6 in a number."""
    names = sorted({*first, *second})
    apart = [name for name in names if first.get(name) != second.get(name)]
    return apart, [name for name in apart if not _near(first.get(name), second.get(name))]


def _near(first: Any, second: Any) -> bool:
    if isinstance(first, dict) and isinstance(second, dict):
        return first.keys() == second.keys() and all(_near(first[key], second[key]) for key in first)
    if isinstance(first, list) and isinstance(second, list):
        return len(first) == len(second) and all(map(_near, first, second))
    if isinstance(first, float) and isinstance(second, float):
        return math.isclose(first, second, rel_tol=1e-6, abs_tol=1e-9)
    return bool(first == second)
