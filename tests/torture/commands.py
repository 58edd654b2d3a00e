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
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bench_hw.starting import end, keep_interruptions, open_streams
from reports.manifest import MANIFEST

LONGEST = 900.0
"""A command that takes longer hangs, s: machines may be busy."""
CONTRACT = (0, 1, 2, 3, 4, 5)
"""Exit codes."""
COARSE = ("fem.mesh=coarse", "fem.kinematics=linear", "wave.large_press=linear", "load.observations=4")
QUICK = ("fem.mesh=coarse", "fem.kinematics=linear", "wave.large_press=linear")
LONG = ("fem.mesh=coarse", "tool.contact=rigid_frictional", "tool.edge_radius=1 mm", "physics.friction_coefficient=0.3",
        "load.peak=2 N", "load.observations=120")  # fmt: skip
"""A press with friction in finite strain, long enough that steps of it are kept."""
VARIED = ("--vary", "tool.radius=4 mm,5 mm", "--workers", "1")

MAPS = tuple(
    word
    for name, unit in (("time_s", "s"), ("depth_mm", "mm"), ("force_N", "N"))
    for word in ("--map", f"{name}={name}:{unit}")
)


def _set(settings: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(word for setting in settings for word in ("--set", setting))


@dataclass(frozen=True)
class Command:
    """A command line under a name, `module` what it belongs to, and the paths that it writes, the result first.

    One that is `careful` never writes over what is there; the `share` of the moments is 1 for a cheap one.
    """

    verb: str
    module: str
    words: tuple[str, ...]
    out: str = "p"
    more: tuple[str, ...] = ()
    careful: bool = False
    share: float = 1.0

    @property
    def outs(self) -> tuple[str, ...]:
        """All that it writes."""
        return (self.out, *self.more)


OUT = ("--out", "p")
CHECK = ("check", "--gate", "gate.toml")
BENCH = ("--bench", "simulated", "--budget", "1")
CAPTURE = ("capture", "paper_press", "--rig", "simulated", "--fast", "--quiet")

COMMANDS = (
    Command("tissues new", "benchmark", ("tissues", "new", "p"), "p.toml", careful=True),
    Command("reference new", "benchmark", ("reference", "new", "skin-5N", "--out", "p.csv"), "p.csv", careful=True),
    Command("clean", "benchmark", ("clean", "."), "p"),
    Command("import", "bench_hw", ("import", "foreign.csv", *MAPS, "--out", "p.csv"), "p.csv", careful=True),
    Command("export", "bench_hw", ("export", "trial.mcap", *OUT), careful=True),
    Command("recover", "bench_hw", ("recover", "cut.mcap", "--out", "p.mcap"), "p.mcap",
            careful=True),
    Command("simulate session", "bench_hw", ("simulate", "session", "--trials", "1", "--no-camera", "--quiet", *OUT),
            careful=True),
    Command("session new", "benchmark", ("session", "new", "fresh"), "fresh/session.toml", ("fresh/specimen.toml",),
            careful=True),
    Command("assess", "benchmark", ("assess", "experts", "novices", *OUT)),
    Command("dossier", "benchmark", ("dossier", "finished", "--context", "context.toml", *OUT)),
    Command("press --save", "benchmark", ("press", "skin-5N", *_set(QUICK), "--save", "p.html"), "p.html"),
    Command("track", "bench_hw", ("track", "pictures", "--camera", "camera.toml", "--out", "p.csv"), "p.csv"),
    Command("calibrate", "bench_hw", ("calibrate", "boards/*.png", "--corners", "9x6", "--square-mm", "8", "--out",
                                      "p.toml"), "p.toml"),
    Command("verify", "benchmark", ("verify", "hertz", *OUT)),
    Command("report", "benchmark", ("report", "finished", *OUT), share=0.7),
    Command("report, two", "benchmark", ("report", "finished", "other", *OUT), share=0.5),
    Command("fit", "benchmark", ("fit", "session", *OUT)),
    Command("capture", "bench_hw", (*CAPTURE, *OUT), careful=True, share=0.7),
    Command("sweep", "benchmark", ("sweep", "skin-5N", *_set(COARSE), *VARIED, *OUT), share=0.7),
    Command("discover", "benchmark", ("discover", "session", *OUT), share=0.7),
    Command("run", "benchmark", ("run", "skin-5N", *_set(COARSE), "--export", "inp", *OUT), share=0.5),
    Command("run, steps kept", "benchmark", ("run", "skin-5N", *_set(LONG), *OUT), share=0.5),
    Command("run --trials", "benchmark", ("run", "--trials", "session", *OUT), share=0.5),
    Command("fit --free", "benchmark", ("fit", "pads", "--free", "pad.youngs_modulus", "--exact", "all", *OUT),
            share=0.5),
    Command("discover --refit", "benchmark", ("discover", "pads", "--refit", "strain_stiffening", *OUT), share=0.5),
    Command("discover --bench", "benchmark", ("discover", "sheet", *BENCH, *OUT), share=0.5),
    Command("check", "benchmark", (*CHECK, "--baseline", "base.json", "--history", "p.jsonl", "--junit", "p.xml",
                                   "--markdown", "p.md", *OUT), "p", ("p.xml", "p.md", "p.jsonl"), share=0.5),
    Command("check --accept", "benchmark", (*CHECK, "--baseline", "p.json", "--accept"), "p.json",
            ("p.history.jsonl",), share=0.5),
    Command("blind", "benchmark", ("blind", "--cases", "null", "--most", "1", *OUT),
            share=0.5),
    Command("reproduce", "benchmark", ("reproduce", *OUT), share=0.5),
)  # fmt: skip


@dataclass(frozen=True)
class Ended:
    """How a process ended: its exit code (negative for a signal), standard error, and the seconds it took."""

    code: int
    err: str
    seconds: float

    @property
    def is_plain(self) -> bool:
        """Whether what went wrong was said in one paragraph at most."""
        return is_plain(self.err)


def is_plain(text: str) -> bool:
    """Whether a text has one paragraph of error at most, and none of Python's own."""
    errors = [line for line in text.splitlines() if line.startswith(("error:", "unexpected error:"))]
    return "Traceback" not in text and len(errors) <= 1


def run(
    command: Command, folder: Path, *, kill: tuple[float, int] | None = None, before: str = "", anew: bool = False
) -> Ended:
    """Run a command in a fork of this process, which has imported the libraries; `kill` is (seconds, signal).

    `before` is Python that the child runs first: faults of disk and memory are put in by it. With `anew` the child is
    what a person starts, `python -m`. A child that takes longer than `LONGEST` counts as hanging.
    """
    err = folder.parent / f"{folder.name}.stderr"
    err.write_text("")
    started = time.monotonic()
    heard = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # until the child can say what it met
    child = os.fork()
    if child == 0:
        _child(command, folder, err, before, anew)
    signal.pthread_sigmask(signal.SIG_SETMASK, heard)
    with suppress(OSError):  # the child does the same: whoever comes first
        os.setpgid(child, child)
    code = _wait(child, started, kill)
    return Ended(code, err.read_text(encoding="utf-8", errors="replace"), time.monotonic() - started)


def _wait(child: int, started: float, kill: tuple[float, int] | None) -> int:
    while time.monotonic() - started < LONGEST:
        found, status = os.waitpid(child, os.WNOHANG)
        if found:
            return os.waitstatus_to_exitcode(status)
        if kill is not None and time.monotonic() - started >= kill[0]:
            with suppress(ProcessLookupError):
                os.killpg(child, kill[1]) if kill[1] == signal.SIGINT else os.kill(child, kill[1])
            kill = None
        time.sleep(0.002)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return 999


def _child(command: Command, folder: Path, err: Path, before: str, anew: bool) -> None:
    """Never returns."""
    os.setpgid(0, 0)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.chdir(folder)
    os.dup2(os.open(err, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 2)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    code = 70
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        if anew:
            os.execv(sys.executable, [sys.executable, "-m", command.module, *_words(command)])
        if before:
            exec(before, {})
        keep_interruptions()
        open_streams()
        code = end(_main(command))
    except SystemExit as asked:
        code = asked.code if isinstance(asked.code, int) else 1
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

    sys.argv = ["torture", *_words(command)]
    return bench()


def _words(command: Command) -> list[str]:
    return [word for each in command.words for word in _expanded(each)]


def _expanded(word: str) -> list[str]:
    return sorted(str(path) for path in Path().glob(word)) if "*" in word else [word]


VOLATILE = re.compile(
    r"second|wall|cpu|^setup(_s)?$|_time$|^time$|timing|speedup|memory|^made|date|started|duration|^out$|machine|processor"
    r"|resumed|^path$|_us$",
    re.I,
)
"""Keys and columns whose values are of the clock or the machine."""
CLOCKED = re.compile(r'"(setup|wall|cpu)_s": ?[0-9.e-]+')
"""Times in a page of press."""
SKIPPED = ("environment.json", "manifest.json", "timing.csv", "report.html", "capture.json", "journal.jsonl",
           "check.json", "rounds.csv", "p.xml", "p.md", "p.jsonl", "p.history.jsonl")  # fmt: skip
"""Files that hold little else, or pages that show it; they must be there. So must recordings, whose rows follow the
clock of simulated devices."""


def digest(path: Path) -> dict[str, Any]:
    """What must be the same of a result, by file: numbers of JSON and tables, and bytes of the rest, times apart."""
    if path.is_file():
        return {path.name: _of_file(path)}
    return {
        file.relative_to(path).as_posix(): _of_file(file)
        for file in sorted(path.rglob("*"))
        if file.is_file() and file.name != MANIFEST
    }


def _of_file(path: Path) -> Any:
    if path.name in SKIPPED or (path.suffix == ".mcap" and path.parent.name == "p"):
        return "there"
    if path.suffix == ".parquet":
        import pandas as pd

        table = pd.read_parquet(path)
        return {name: table[name].astype(str).to_list() for name in table if not VOLATILE.search(name)}
    if path.suffix == ".json":
        return _steady(json.loads(path.read_text(encoding="utf-8")))
    if path.suffix == ".csv":
        rows = list(csv.reader(path.read_text(encoding="utf-8").splitlines()))
        steady = [k for k, name in enumerate(rows[0]) if not VOLATILE.search(name) or name == "time_s"]
        return [[row[k] for k in steady] for row in rows]
    if path.suffix == ".html":
        return hashlib.sha256(CLOCKED.sub("", path.read_text(encoding="utf-8")).encode()).hexdigest()
    if path.suffix == ".md":
        return [line for line in path.read_text(encoding="utf-8").splitlines() if "seconds" not in line]
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _steady(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _steady(each) for key, each in value.items() if not VOLATILE.search(key)}
    if isinstance(value, list):
        return [_steady(each) for each in value if not _is_of_time(each)]
    return value


def _is_of_time(row: Any) -> bool:
    """Whether a row of a table tells of seconds, as one of blind trials does, or a warning of an interruption."""
    if isinstance(row, str):
        return "FEM resumed after step" in row
    return isinstance(row, dict) and "seconds" in str(row.get("measure", ""))


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
