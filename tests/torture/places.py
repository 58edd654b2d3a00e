"""Odd places and bad surroundings: disks full at one point or another, folders that cannot be written, names."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from tests.torture.commands import COMMANDS, Command, differences, digest, run
from tests.torture.kills import clear
from tests.torture.scene import contents, make_scene

FULL = """
import builtins, errno, io, os
left = [{at}]
def full(*_):
    left[0] -= 1
    if left[0] < 0:
        raise OSError({error}, os.strerror({error}))
real_sync, real_open = os.fsync, os.open
def fsync(handle):
    full()
    return real_sync(handle)
os.fsync = fsync
def opened(path, flags, *rest, **more):
    if flags & (os.O_WRONLY | os.O_RDWR) and "stderr" not in str(path):
        full()
    return real_open(path, flags, *rest, **more)
os.open = opened
"""
"""A disk that is full (or a process that may open no more files) from one write to the next."""
MEMORY = "import resource; resource.setrlimit(resource.RLIMIT_AS, ({most}, {most}))"
SIZE = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, ({most}, {most}))"
CHEAP = ("fit", "verify", "report", "tissues new", "export", "import", "recover", "track", "sweep")


@dataclass
class Environment:
    """What was tried in one surrounding: how often, how it ended by exit code, and failures in words."""

    tries: int = 0
    codes: dict[int, int] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)

    def note(self, code: int, allowed: tuple[int, ...], err: str, what: str) -> None:
        """Count an ending; a code that is not allowed, a traceback or several paragraphs are failures."""
        self.tries += 1
        self.codes[code] = self.codes.get(code, 0) + 1
        errors = [line for line in err.splitlines() if line.startswith(("error:", "unexpected error:"))]
        if code not in allowed:
            self.failures.append(f"{what}: exit {code}: {err.strip()[-200:]}")
        elif "Traceback" in err or len(errors) > 1:
            self.failures.append(f"{what}: no single paragraph: {err.strip()[-200:]}")


def torture(scene: Path, until: float, verbs: list[str]) -> dict[str, Environment]:
    """Try the cheap commands in every surrounding, until the time is over."""
    found: dict[str, Environment] = {}
    commands = [each for each in COMMANDS if each.verb in CHEAP and each.verb in verbs]
    usual = {each.verb: _usual(scene, each) for each in commands}
    for at in range(10):
        found[f"disk full from write {at} on"] = _faulty(scene, commands, FULL.format(at=at, error=28), usual, until)
    found["no more files can be opened"] = _faulty(scene, commands, FULL.format(at=3, error=24), usual, until)
    for most in (0, 1000, 100_000):
        found[f"no file above {most} bytes"] = _faulty(scene, commands, SIZE.format(most=most), usual, until)
    found["1.5 GB of address space"] = _faulty(scene, commands, MEMORY.format(most=1_500_000_000), usual, until)
    found["two at once"] = _together(scene, next(each for each in COMMANDS if each.verb == "fit"), until)
    for name, trial in _outside(scene).items():
        if time.monotonic() < until:
            found[name] = trial()
    return {name: each for name, each in found.items() if each.tries}


def _usual(scene: Path, command: Command) -> dict[str, object]:
    clear(scene, command)
    run(command, scene)
    return digest(scene / command.out)


def _faulty(scene: Path, commands: list[Command], fault: str, usual: dict, until: float) -> Environment:  # type: ignore[type-arg]
    """Each command with a fault put in: it ends well or is refused, leaves nothing, and works again without."""
    found = Environment()
    for command in commands:
        if time.monotonic() > until:
            break
        clear(scene, command)
        before = contents(scene)
        ended = run(command, scene, before=fault)
        found.note(ended.code, (0, 2, 4, 5), ended.err, command.verb)
        whole = (scene / command.out).exists()
        if whole and differences(usual[command.verb], digest(scene / command.out))[1] and command.verb != "sweep":
            found.failures.append(f"{command.verb}: it left a result that is not whole")
        if command.verb != "sweep":
            clear(scene, command)
            left = contents(scene)
            odd = sorted(name for name in {*before, *left} if before.get(name) != left.get(name))
            if odd:
                found.failures.append(f"{command.verb}: changed or left: {', '.join(odd)}")
    return found


def _together(scene: Path, command: Command, until: float) -> Environment:
    """The same command twice at the same time: one is refused by name, the other ends well."""
    found = Environment()
    for pause in (0.0, 0.1, 0.5):
        if time.monotonic() > until:
            break
        clear(scene, command)
        second = Path(f"{scene}-2")
        second.unlink(missing_ok=True)
        second.symlink_to(scene)
        with ThreadPoolExecutor(1) as pool:
            first = pool.submit(run, command, scene)
            time.sleep(pause)
            ended = [run(command, second), first.result()]
        second.unlink()
        for each in ended:
            found.note(each.code, (0, 2), each.err, f"after {pause} s")
        if sorted(each.code for each in ended) != [0, 2] or not any("in use" in each.err for each in ended):
            found.failures.append(f"after {pause} s they ended with {[each.code for each in ended]}")
    return found


def _outside(scene: Path):  # type: ignore[no-untyped-def]
    """Surroundings that take a process of their own, by name."""
    ascii_locale = {"PYTHONUTF8": "0", "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0"}
    root = scene.parent
    return {
        "ASCII locale, umlauts everywhere": lambda: _fit_in(root / "Mü ller" / "Größe", {**ascii_locale}),
        "Latin-1 bytes in a name": lambda: _fit_in(root / os.fsdecode(b"caf\xe9"), {}),
        "blanks, quotes and brackets": lambda: _fit_in(root / "a 'b\" [c] $(d) ;e", {}),
        "a name of 200 letters": lambda: _fit_in(root / ("n" * 200), {}),
        "a line end in a name": lambda: _fit_in(root / "a\nb", {}),
        "a leading dash": lambda: _fit_in(root / "-rf", {}),
        "a folder by a link": lambda: _by_link(root),
        "shadowing names": lambda: _fit_in(root / "shadow", {}, ("fem.py", "numpy.py", "reports/__init__.py")),
        "no home, no terminal": lambda: _fit_in(root / "bare", {"HOME": "/nonexistent", "TERM": "", "COLUMNS": "1"}),
        "no temporary folder": lambda: _fit_in(root / "notmp", {"TMPDIR": "/nonexistent"}),
        "an output that cannot be written": lambda: _refused(root / "ro", "/proc/here"),
        "an output on a device": lambda: _refused(root / "dev", "/dev/null/x"),
        "an output that is a file": lambda: _refused(root / "file", "foreign.csv"),
        "an output that is the input": lambda: _refused(root / "same", "session"),
        "an output that is a link to nothing": lambda: _refused(root / "dangling", "nowhere"),
    }


def _fit_in(folder: Path, changes: dict[str, str], shadow: tuple[str, ...] = ()) -> Environment:
    make_scene(folder)
    for name in shadow:
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text('raise SystemExit("theirs was imported")\n')
    found = Environment()
    for words in (["benchmark", "fit", "session", "--out", folder.name], ["bench_hw", "track", "pictures", "--camera",
                  "camera.toml", "--out", f"{folder.name}.csv"]):  # fmt: skip
        if folder.name.startswith("-"):
            words[-1] = f"./{words[-1]}"
        ended = _process(folder, words, changes)
        found.note(ended.returncode, (0,), ended.stderr.decode("utf-8", "replace"), " ".join(words[:2]))
    return found


def _by_link(root: Path) -> Environment:
    found = _fit_in(root / "target", {})
    (root / "link").symlink_to(root / "target")
    ended = _process(root, ["benchmark", "fit", "link/session", "--out", "link/target"], {})
    found.note(ended.returncode, (0,), ended.stderr.decode(), "fit over its own result through a link")
    return found


def _refused(folder: Path, out: str) -> Environment:
    make_scene(folder)
    if out == "nowhere":
        (folder / out).symlink_to("not there")
    before, found = contents(folder), Environment()
    for verb in (["fit", "session"], ["run", "skin-5N"], ["discover", "session"], ["verify"]):
        ended = _process(folder, ["benchmark", *verb, "--out", out], {})
        allowed = (0, 2) if out == "nowhere" else (2,)
        found.note(ended.returncode, allowed, ended.stderr.decode("utf-8", "replace"), f"{verb[0]} --out {out}")
        if out == "nowhere":
            break
    left = contents(folder, ("not there",))
    if out != "nowhere" and left != before:
        found.failures.append("something in the folder changed")
    return found


def _process(folder: Path, words: list[str], changes: dict[str, str]) -> subprocess.CompletedProcess[bytes]:
    environment = {**os.environ, **changes}
    command = [sys.executable, "-m", *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, timeout=600, check=False)


def rows(found: dict[str, Environment]) -> list[tuple[str, ...]]:
    """The table by surrounding."""
    head = ("surrounding", "commands", "exit codes", "failures")
    return [
        head,
        *(
            (name, str(e.tries), ", ".join(f"{code}: {n}" for code, n in sorted(e.codes.items())), str(len(e.failures)))
            for name, e in found.items()
        ),
    ]
