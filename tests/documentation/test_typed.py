"""Each page's commands typed one after the other in an empty folder, as a reader would.

What a page takes for granted (trials, a model, a filled-in table) is put there first. Slow: it does what it says.
"""

import shutil
import signal
import subprocess
import sys
from itertools import groupby
from pathlib import Path

import pytest

from tests.documentation.commands import Command, documented
from tests.documentation.given import environment, readers_files

pytestmark = pytest.mark.slow
LONGEST_S = 900
IN_PLACE_OF = {"SESSION": "gel_pad", "FOLDER": "made", "RUN_A": "press", "RUN_B": "softer", "results/latest": "press"}
"""Words that a reader replaces."""
ELSEWHERE = {
    "blind.md": "hours of synthetic sessions: `make bench-discovery`, tests/benchmark/blind",
    "gate.md": "minutes of timing on a quiet machine: `make bench-gate`, tests/benchmark/gate",
    "video.md": "needs pictures of a chessboard: tests/bench_hw/vision",
    "sweeps.md": "needs a cluster, or hundreds of points: tests/benchmark/sweeps",
}
FOUND_WORSE = {"check": 1}
"""Exit codes other than 0 that a verb may end with on a machine without a baseline of its own."""


def typed() -> list[list[Command]]:
    """The commands of each page that can be typed here: what reads CalculiX's answer needs CalculiX."""
    here = [each for each in documented() if shutil.which("ccx") or not reads_calculix(each)]
    pages = groupby(here, key=lambda command: command.page)
    return [list(commands) for page, commands in pages if page not in ELSEWHERE]


def reads_calculix(command: Command) -> bool:
    """Whether a command takes what `ccx` leaves beside its deck."""
    return any(word.endswith(".dat") for word in command.arguments)


@pytest.fixture(scope="session")
def given(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with what every page takes for granted."""
    folder = tmp_path_factory.mktemp("given")
    readers_files(folder)
    return folder


@pytest.mark.parametrize("commands", typed(), ids=lambda commands: commands[0].page)
def test_what_a_page_says_can_be_typed(commands: list[Command], given: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(given, tmp_path / "own")
    failed = [told for command in commands if (told := run(command, folder))]
    assert not failed, "\n".join(failed)


def run(command: Command, folder: Path) -> str:
    """What went wrong, or nothing."""
    make_way(command, folder)
    words = [IN_PLACE_OF.get(word, word) for word in command.arguments]
    process = subprocess.Popen(
        [sys.executable, "-m", command.program, *words],
        cwd=folder, env=environment(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True,
    )  # fmt: skip
    said = _end_where_it_serves(process) if words[0] == "press" and "--save" not in words else ""
    said += process.communicate(timeout=LONGEST_S)[0]
    fill_in(folder)
    allowed = {0, FOUND_WORSE.get(words[0], 0)}
    return "" if process.returncode in allowed else f"{command}\n  exit {process.returncode}: {said[-600:]}"


def _end_where_it_serves(process: subprocess.Popen[str]) -> str:
    """Press Ctrl-C once a page is served, as its reader does at last; what was said until then."""
    assert process.stdout is not None, "it is a pipe"
    said = ""
    for line in process.stdout:
        said += line
        if "http://" in line:
            process.send_signal(signal.SIGINT)
            break
    return said


def make_way(command: Command, folder: Path) -> None:
    """What the page is about to make itself was not there for its reader."""
    if command.arguments[0] == "capture" and "my_session" in command.arguments:
        shutil.rmtree(folder / "my_session")
    if command.arguments == ("tissues", "new", "my_skin"):
        (folder / "my_skin.toml").unlink()
    if reads_calculix(command):
        subprocess.run(["ccx", "press/skin-5N"], cwd=folder, check=True, capture_output=True)


def fill_in(folder: Path) -> None:
    """The reader's own FEA in a template that was just written."""
    template = folder / "skin-5N-fea.csv"
    if template.is_file():
        shutil.copy(folder / "my_fea.csv", template)
