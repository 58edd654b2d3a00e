"""Odd places and bad surroundings: folders that cannot be written, names, limits, clocks, streams, two at once."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import zip_longest
from pathlib import Path
from typing import Any

from tests.torture.commands import COMMANDS, CONTRACT, Command, differences, run
from tests.torture.disks import Environment, usual_result
from tests.torture.kills import clear, result
from tests.torture.scene import contents, make_scene

LIMIT = "import resource; resource.setrlimit(resource.{which}, ({most}, {most}))"
BACKWARDS = """
import time
began, really = time.time(), time.time
time.time = lambda: 2 * began - really() - 86400.0
"""
NOBODY = """
import ctypes, os
libc = ctypes.CDLL(None)
libc.prctl(8, 1, 0, 0, 0)  # PR_SET_KEEPCAPS
os.setgroups([])
os.setgid(65534)
os.setuid(65534)
words = ctypes.c_uint32 * 6
if libc.capset(ctypes.byref((ctypes.c_uint32 * 2)(0x20080522, 0)), ctypes.byref(words(4, 4, 0, 0, 0, 0))):
    raise RuntimeError("no capability can be kept here")
"""
"""Another user, who may read everything (CAP_DAC_READ_SEARCH, for a Python that lies in somebody's home) but write in
none of the folders."""
CLOSED = "import os; os.close(1)"
BROKEN = "import os, signal; reader, writer = os.pipe(); os.close(reader); os.dup2(writer, 1)"
UNKNOWN = "import os; os.environ.pop('HOME', None); os.environ.update(TMPDIR='/nonexistent', TERM='', COLUMNS='1')"
FAR = "import os, time; os.environ['TZ'] = 'Pacific/Kiritimati'; time.tzset()"
CLOCK = "import time; really = time.time; time.time = lambda: really() - {seconds}"
NO_ROOM = "import shutil; shutil.disk_usage = lambda _: shutil._ntuple_diskusage(1 << 40, 1 << 40, 0)"
ALONE = """
import _posixsubprocess, errno, os
def none(*_, **__):
    raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))
os.fork = os.posix_spawn = _posixsubprocess.fork_exec = none
import multiprocessing.util, subprocess
subprocess._fork_exec = multiprocessing.util.spawnv_passfds = none
"""
NO_THREADS = """
import _thread, threading
def none(*_, **__):
    raise RuntimeError("can't start new thread")
threading._start_new_thread = threading._start_joinable_thread = none
"""
CHEAP = ("tissues new", "reference new", "import", "export", "recover", "session new", "assess", "dossier", "track",
         "fit")  # fmt: skip
"""Verbs that are put into the surroundings."""


def torture(scene: Path, until: float, verbs: list[str], parts: list[str]) -> tuple[dict[str, Environment], list[str]]:
    """Try the commands in surroundings until the time is over; `parts` are faults and outside. What was tried, and all.

    The kinds take turns, so that the time cuts off some of each.
    """
    found: dict[str, Environment] = {}
    commands = [each for each in COMMANDS if each.verb in verbs and each.verb in CHEAP]
    trials: list[dict[str, Callable[[], Environment]]] = []
    if "faults" in parts:
        usual: dict[str, dict[str, Any]] = {}
        trials.append({
            name: lambda fault=fault: _faulty(scene, commands, fault, usual)  # type: ignore[misc]
            for name, fault in _faults().items()
        })  # fmt: skip
    if "outside" in parts:
        trials.append({**_together(scene), **_outside(scene)})
    pairs = [pair for turn in zip_longest(*(each.items() for each in trials)) for pair in turn if pair is not None]
    for name, trial in pairs:
        if time.monotonic() < until:
            print(name, file=sys.stderr, flush=True)
            found[name] = trial()
            print("  " + " | ".join(_row(name, found[name])), file=sys.stderr, flush=True)
    return {name: each for name, each in found.items() if each.tries}, [name for name, _ in pairs]


def _faults() -> dict[str, str]:
    """What is put into a child by name of the surrounding."""
    sizes = {
        f"no file above {most} bytes": LIMIT.format(which="RLIMIT_FSIZE", most=most)
        for most in (1000, 30_000, 1_000_000)
    }
    faults = {
        **sizes,
        "a disk without room": NO_ROOM,
        "24 open files": LIMIT.format(which="RLIMIT_NOFILE", most=24),
        "1.5 GB of address space": LIMIT.format(which="RLIMIT_AS", most=1_500_000_000),
        "no further process": ALONE,
        "no further thread": NO_THREADS,
        "a clock that goes back": BACKWARDS,
        "a clock of 1970": CLOCK.format(seconds="really() + 3600.0"),
        "a clock of 2126": CLOCK.format(seconds="-3.16e9"),
        "a time zone 14 hours off": FAR,
        "standard input closed": "import os; os.close(0)",
        "standard output closed": CLOSED,
        "standard output a broken pipe": BROKEN,
        "standard output full": "import os; os.dup2(os.open('/dev/full', os.O_WRONLY), 1)",
        "standard error closed": "import os; os.close(2)",
        "no home, no temporary folder, no terminal": UNKNOWN,
        "files that only the owner reads": "import os; os.umask(0o077)",
        "Ctrl-C ignored": "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)",
    }
    return {**faults, "a folder of somebody else's": NOBODY} if os.getuid() == 0 else faults


def _faulty(scene: Path, commands: list[Command], fault: str, usual: dict[str, dict[str, Any]]) -> Environment:
    """Each command with a fault put in: it ends well or is refused, and leaves nothing that is not whole."""
    found = Environment()
    for command in commands:
        if command.verb not in usual:
            usual[command.verb] = usual_result(scene, command)
        clear(scene, command)
        before = contents(scene)
        ended = run(command, scene, before=fault)
        found.note(ended.code, CONTRACT, ended.err, command.verb)
        there = result(scene, command)
        if there and differences(usual[command.verb], there)[1]:
            found.fail(f"{command.verb}: it left a result that is not whole: {ended.err.strip()[-200:]}")
        if not there and ended.code in (0, 1):
            found.fail(f"{command.verb}: it ended with {ended.code} without a result")
        clear(scene, command)
        left = contents(scene)
        odd = sorted(name for name in {*before, *left} if before.get(name) != left.get(name))
        if odd:
            found.fail(f"{command.verb}: changed or left: {', '.join(odd)}: {ended.err.strip()[-200:]}")
            for name in odd:
                (scene / name).unlink(missing_ok=True)
    return found


def _together(scene: Path) -> dict[str, Callable[[], Environment]]:
    """Two at the same time."""
    fit = next(each for each in COMMANDS if each.verb == "fit")
    return {
        f"two into one folder, {pause} s apart": lambda pause=pause: _two(scene, fit, pause)  # type: ignore[misc]
        for pause in (0.0, 0.5)
    } | {"two in one second, default folders": lambda: _two_by_default(scene)}


def _two(scene: Path, command: Command, pause: float) -> Environment:
    """The same command twice: one is refused by name, the other ends well."""
    found = Environment()
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
        found.note(each.code, (0, 2), each.err, command.verb)
    if sorted(each.code for each in ended) != [0, 2] or not any("in use" in each.err for each in ended):
        found.fail(f"they ended with {[each.code for each in ended]}")
    clear(scene, command)
    return found


def _two_by_default(scene: Path) -> Environment:
    """Two without --out: each has a folder of its own."""
    found = Environment()
    command = [sys.executable, "-m", "benchmark", "fit", "session", "--quiet"]
    both = [subprocess.Popen(command, cwd=scene, stderr=subprocess.PIPE, text=True) for _ in range(2)]
    for each in both:
        err = each.communicate(timeout=600)[1]
        found.note(each.returncode, (0,), err, "fit")
    names = sorted(path.name for path in (scene / "results").iterdir())
    if len(names) != 2:
        found.fail(f"two fits left {', '.join(names)} in results")
    shutil.rmtree(scene / "results")
    return found


def _outside(scene: Path) -> dict[str, Callable[[], Environment]]:
    """Surroundings that take a process of their own, by name."""
    ascii_locale = {"PYTHONUTF8": "0", "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0"}
    root = scene.parent
    shadows = ("fem.py", "numpy.py", "random.py", "typing.py", "reports/__init__.py", "wavemodel/__init__.py")
    return {
        "ASCII locale, umlauts everywhere": lambda: _fit_in(root / "Mü ller" / "Größe", ascii_locale),
        "Latin-1 bytes in a name": lambda: _fit_in(root / os.fsdecode(b"caf\xe9"), {}),
        "blanks, quotes and brackets": lambda: _fit_in(root / "a 'b\" [c] $(d) ;e", {}),
        "a name of 200 letters": lambda: _fit_in(root / ("n" * 200), {}),
        "a line end in a name": lambda: _fit_in(root / "a\nb", {}),
        "a leading dash": lambda: _fit_in(root / "-rf", {}),
        "a folder by a link": lambda: _by_link(root),
        "shadowing names": lambda: _fit_in(root / "shadow", {}, shadows),
        "benchmark.py in the way": lambda: _benchmark_py(root / "own"),
        "no home, no terminal": lambda: _fit_in(root / "bare", {"HOME": "/nonexistent", "TERM": "", "COLUMNS": "1"}),
        "no temporary folder": lambda: _fit_in(root / "notmp", {"TMPDIR": "/nonexistent"}),
        "the folder is removed meanwhile": lambda: _removed(root / "gone"),
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
    before = contents(folder)
    for words in (["benchmark", "fit", "session", "--out", folder.name], ["bench_hw", "track", "pictures", "--camera",
                  "camera.toml", "--out", f"{folder.name}.csv"]):  # fmt: skip
        if folder.name.startswith("-"):
            words[-1] = f"./{words[-1]}"
        ended = _process(folder, words, changes)
        found.note(ended.returncode, (0,), ended.stderr.decode("utf-8", "replace"), " ".join(words[:2]))
    left = contents(folder, (folder.name, f"{folder.name}.csv"))
    if left != before:
        found.fail(f"changed or left: {sorted(set(left) ^ set(before))}")
    return found


def _benchmark_py(folder: Path) -> Environment:
    """Python itself runs a `benchmark.py` for `python -m benchmark`; the installed command and `python -P` do not."""
    make_scene(folder)
    (folder / "benchmark.py").write_text('raise SystemExit("theirs was run")\n')
    found, script = Environment(), Path(sys.executable).with_name("tissuebench")
    commands = [[sys.executable, "-P", "-m", "benchmark", "fit"], *([[str(script), "fit"]] if script.exists() else [])]
    for command in commands:
        ended = subprocess.run([*command, "session", "--out", "p"], cwd=folder, capture_output=True, check=False)
        found.note(ended.returncode, (0,), ended.stderr.decode(), Path(command[0]).name)
    return found


def _removed(folder: Path) -> Environment:
    """Somebody removes the current folder while a fit is at work in it."""
    make_scene(folder)
    found = Environment()
    command = [sys.executable, "-m", "benchmark", "fit", "session", "--out", "p"]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    time.sleep(1.0)
    shutil.rmtree(folder)
    try:
        err = process.communicate(timeout=300)[1]
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGKILL)
        err = process.communicate()[1]
    found.note(process.returncode, (0, 2), err, "fit")
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
    for verb in (["fit", "session"], ["run", "skin-5N"], ["discover", "session"], ["verify"], ["blind"], ["reproduce"]):
        ended = _process(folder, ["benchmark", *verb, "--out", out], {})
        allowed = (0, 2) if out == "nowhere" else (2,)
        found.note(ended.returncode, allowed, ended.stderr.decode("utf-8", "replace"), f"{verb[0]} --out {out}")
        if out == "nowhere":
            break
    left = contents(folder, ("not there",))
    if out != "nowhere" and left != before:
        found.fail("something in the folder changed")
    return found


def _process(folder: Path, words: list[str], changes: dict[str, str]) -> subprocess.CompletedProcess[bytes]:
    environment = {**os.environ, **changes}
    command = [sys.executable, "-m", *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, timeout=600, check=False)


def rows(found: dict[str, Environment]) -> list[tuple[str, ...]]:
    """The table by surrounding."""
    return [("surrounding", "commands", "how they ended", "failures"), *(_row(*each) for each in found.items())]


def _row(name: str, found: Environment) -> tuple[str, ...]:
    """A surrounding: the verbs by their exit codes, with how often where it was more than once."""
    codes = sorted({code for each in found.codes.values() for code in each})
    ends = [
        f"{code}: {', '.join(_times(verb, each[code]) for verb, each in found.codes.items() if each[code])}"
        for code in codes
    ]
    return name, str(found.tries), "; ".join(ends), str(len(found.failures))


def _times(verb: str, often: int) -> str:
    return verb if often == 1 else f"{verb} ({often})"
