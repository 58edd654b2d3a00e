"""Small disks: each command on one that is full after a tenth, two tenths... of what it writes."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections import Counter
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from tests.torture.commands import COMMANDS, CONTRACT, Command, differences, is_plain, run
from tests.torture.kills import clear, result
from tests.torture.scene import contents

PAGE = 4096
ROOM = "import shutil; plenty = shutil._ntuple_diskusage(1 << 40, 0, 1 << 40); shutil.disk_usage = lambda _: plenty\n"
"""The disk tells that it has room, so that it is full in the midst of writing instead of before computing."""
HERE = "import os, tempfile; tempfile.tempdir = os.environ['HOME'] = os.path.abspath({place!r})\n"
FULL = """
import errno, os
left = [{at}]
real_sync, real_open = os.fsync, os.open
def full():
    left[0] -= 1
    if left[0] < 0:
        raise OSError(28, os.strerror(28))
def fsync(handle):
    full()
    return real_sync(handle)
def opened(path, flags, *rest, **more):
    if flags & (os.O_WRONLY | os.O_RDWR) and "stderr" not in str(path):
        full()
    return real_open(path, flags, *rest, **more)
os.fsync, os.open = fsync, opened
"""
"""In the place of a small disk, where none can be mounted or the result has no ten pages: full from one synchronised
write to the next."""


@dataclass
class Environment:
    """What was tried in one surrounding: how each verb ended, by exit code and times, and failures in words."""

    codes: dict[str, Counter[int]] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)

    @property
    def tries(self) -> int:
        """How many commands were run."""
        return sum(sum(each.values()) for each in self.codes.values())

    def note(self, code: int, allowed: tuple[int, ...], err: str, what: str) -> None:
        """Count an ending; a code that is not allowed, a traceback or several paragraphs are failures."""
        self.codes.setdefault(what.split(", point")[0], Counter())[code] += 1
        if code not in allowed:
            self.fail(f"{what}: exit {code}: {err.strip()[-300:]}")
        elif not is_plain(err):
            self.fail(f"{what}: no single paragraph: {err.strip()[-300:]}")

    def fail(self, text: str) -> None:
        """Keep a failure and say it."""
        self.failures.append(text)
        print(f"  {text}", file=sys.stderr, flush=True)


def usual_result(scene: Path, command: Command) -> dict[str, Any]:
    """What comes of a command that nothing disturbs."""
    clear(scene, command)
    run(command, scene)
    return result(scene, command)


def torture(scene: Path, until: float, verbs: list[str], points: int) -> dict[str, Environment]:
    """Each command on disks that are full after so many equal parts of what it writes, from none on.

    Every command has its first point before any has its second, so that those which the time cuts off are points.
    """
    found: dict[str, Environment] = {}
    filled: dict[str, _Disk] = {}
    for point in sorted(range(points), key=lambda each: (each * 7 % points, each)):  # far from one another
        for command in (each for each in COMMANDS if each.verb in verbs and each.verb != "clean"):
            if time.monotonic() > until:
                return found
            if command.verb not in filled:
                filled[command.verb], found[command.verb] = _disk(scene, command), Environment()
            _at(scene, filled[command.verb], points, point, found[command.verb])
            print(f"  {command.verb}, {point}: {found[command.verb].codes}", file=sys.stderr, flush=True)
    return found


@dataclass(frozen=True)
class _Disk:
    """A command that writes into the folder of the disk, what comes of it otherwise, and the pages that it needs."""

    verb: str
    inside: Command
    usual: dict[str, Any]
    need: int


def _disk(scene: Path, command: Command) -> _Disk:
    small = scene / "small"
    moved = {out: f"small/{out}" for out in command.outs}
    words = tuple(moved.get(word, "small/p" if word == "p" else word) for word in command.words)
    inside = replace(command, words=words, out=moved[command.out], more=tuple(moved[out] for out in command.more))
    small.mkdir()
    usual = usual_result(scene, inside)
    need = sum(_pages(scene / out) for out in inside.outs)
    shutil.rmtree(small)
    return _Disk(command.verb, inside, usual, need)


def _at(scene: Path, disk: _Disk, points: int, point: int, found: Environment) -> None:
    """One point."""
    small, kept, what = scene / "small", scene / "kept", f"{disk.verb}, point {point}"
    small.mkdir()
    kept.mkdir()
    before = contents(scene, ("small", "kept"))
    mounted = disk.need >= points and _mount(small, max(1, point * disk.need // points) * PAGE)
    fault = ROOM + HERE.format(place=str(kept)) + ("" if mounted else FULL.format(at=point))
    ended = run(disk.inside, scene, before=fault)
    _judge_full(found, disk.inside, scene, disk.usual, ended.code, ended.err, what)
    if mounted:
        subprocess.run(["umount", str(small)], check=True)
    if contents(scene, ("small", "kept")) != before:
        found.fail(f"{what}: something beside it changed")
    for place in (small, kept):
        shutil.rmtree(place)


def rows(found: dict[str, Environment]) -> list[tuple[str, ...]]:
    """The table by verb."""
    body = [
        (verb, str(each.tries), *(str(sum(c[code] for c in each.codes.values())) for code in (0, 2)),
         str(sum(n for c in each.codes.values() for code, n in c.items() if code not in (0, 2))),
         str(len(each.failures)))
        for verb, each in found.items()
    ]  # fmt: skip
    totals = [str(sum(int(row[k]) for row in body)) for k in range(1, 6)]
    return [("verb", "points", "exit 0", "exit 2", "other", "failures"), *body, ("all", *totals)]


def _judge_full(
    found: Environment,
    command: Command,
    scene: Path,
    usual: dict[str, Any],
    code: int,
    err: str,
    what: str,
) -> None:
    """It ended well and whole, or was refused and left nothing, or only what goes on from there or is kept and said."""
    found.note(code, CONTRACT, err, what)
    written = contents(scene / "small", ("lost+found",))
    if code in (0, 1) and differences(usual, result(scene, command))[1]:
        found.fail(f"{what}: it ended well with another result")
    elif code not in (0, 1):
        goes_on = "the same command" in " ".join(err.split())  # finished points, cases and steps stay, and it says so
        left = [name for name in written if not name.endswith((".lock", ".part"))]
        recording = command.verb == "capture"  # what was recorded stays
        if left and not (recording or goes_on):
            found.fail(f"{what}: it left {', '.join(left)}: {err.strip()[-200:]}")
        if any(not name.startswith(".") for name in contents(scene / "kept")) and "kept" not in err:
            found.fail(f"{what}: it kept a result without a word")


def _pages(path: Path) -> int:
    files = [path] if path.is_file() else [each for each in path.rglob("*") if each.is_file()]
    return sum(-(-file.stat().st_size // PAGE) + 1 for file in files) if path.exists() else 1


def _mount(place: Path, size: int) -> bool:
    """Mount a disk of so many bytes, where that is allowed."""
    command = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(place)]
    if os.getuid() != 0 or shutil.which("mount") is None:
        return False
    return subprocess.run(command, capture_output=True, check=False).returncode == 0
