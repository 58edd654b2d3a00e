"""Each page's commands typed one after the other in an empty folder, as a reader would.

What a page takes for granted (trials, a model, a filled-in table) is put there first. Slow: it does what it says.
"""

import os
import shutil
import signal
import subprocess
import sys
from itertools import groupby
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tomli_w

from bench_hw.tables import TrialTable, write_trial_csv
from tests.documentation.commands import ROOT, Command, documented

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
    """The commands of each page that can be typed anywhere."""
    pages = groupby(documented(), key=lambda command: command.page)
    return [list(commands) for page, commands in pages if page not in ELSEWHERE]


@pytest.mark.parametrize("commands", typed(), ids=lambda commands: commands[0].page)
def test_what_a_page_says_can_be_typed(commands: list[Command], tmp_path: Path) -> None:
    taken_for_granted(tmp_path)
    failed = [told for command in commands if (told := run(command, tmp_path))]
    assert not failed, "\n".join(failed)


def run(command: Command, folder: Path) -> str:
    """What went wrong, or nothing."""
    make_way(command, folder)
    words = [IN_PLACE_OF.get(word, word) for word in command.arguments]
    process = subprocess.Popen(
        [sys.executable, "-m", command.program, *words],
        cwd=folder, env=_own(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
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


def taken_for_granted(folder: Path) -> None:
    """Trials of skin, two runs, models, a rig with a virtual specimen, a discovered model."""
    shutil.copy(ROOT / "examples" / "own_model.py", folder / "my_model.py")
    shutil.copytree(ROOT / "examples", folder / "examples")
    call = [sys.executable, "-m", "benchmark"]
    for words in (
        ("run", "skin-5N", "--out", "press"),
        ("run", "skin-5N", "--set", "dermis.youngs_modulus=120 kPa", "--out", "softer"),
        ("tissues", "new", "my_skin"),
    ):
        subprocess.run([*call, *words], cwd=folder, check=True, capture_output=True, env=_own())
    table = pd.read_csv(folder / "press" / "tables" / "max_deformation.csv")
    table.to_csv(folder / "my_fea.csv", index=False)
    my_session(folder / "my_session", table)
    virtual_rig(folder, table)


def _own() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def my_session(folder: Path, table: pd.DataFrame) -> None:
    """Eight presses as the table has them, in two conditions' order of speed, with noise (synthetic)."""
    folder.mkdir()
    top = table[table["layer"] == table["layer"].iloc[0]]
    rng = np.random.default_rng(5)
    for trial in range(1, 9):
        slow = 1.0 if trial % 2 else 0.5
        depth = np.concatenate([[0.0, 0.0], top["fem_mm"].to_numpy()]) * 1e-3
        force = np.concatenate([[0.0, 0.0], top["force_N"].to_numpy()]) * rng.normal(1, 0.01)
        time = np.linspace(0.0, 10.0 / slow, len(depth))
        noisy = force + rng.normal(0, 5e-3, len(force))
        write_trial_csv(folder / f"trial_{trial:03d}.csv", TrialTable(time=time, depth=depth, force=noisy))


def virtual_rig(folder: Path, table: pd.DataFrame) -> None:
    """`rig.toml` of simulated devices with a specimen that has no effect, so that a loop ends."""
    top = table[(table["layer"] == table["layer"].iloc[0]) & (table["step"] <= table["step"].max() // 2)]
    depth, force = [0.0, *top["fem_mm"].tolist()], [0.0, *top["force_N"].tolist()]
    specimen = {
        "schema": 1, "synthetic": True, "contact": "rigid_bonded", "support": {"kind": "bonded"},
        "tools": [{"radius_mm": 5.0, "depth_mm": depth, "force_N": force}], "effects": {},
    }  # fmt: skip
    (folder / "specimen.toml").write_text(tomli_w.dumps(specimen))
    rig = {
        "schema": 1, "name": "virtual", "force": {"kind": "simulated", "rate": "100 Hz"},
        "actuator": {"kind": "simulated", "stroke": "50 mm", "accuracy": 1, "contact": "5 mm"},
        "simulation": {"specimen": "specimen.toml"},
    }  # fmt: skip
    (folder / "rig.toml").write_text(tomli_w.dumps(rig))


def fill_in(folder: Path) -> None:
    """The reader's own FEA in a template that was just written."""
    template = folder / "skin-5N-fea.csv"
    if template.is_file():
        shutil.copy(folder / "my_fea.csv", template)
