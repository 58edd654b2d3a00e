"""A long run that is killed or interrupted, and started again with the same scenario and folder."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from benchmark.files import load_scenario
from benchmark.models import prepare, scenario_drive

STEPS = 120
"""So many that the first ones are kept long before the end."""
BLOCK = {"fem.geometry": "block", "fem.mesh": "coarse", "tool.contact": "rigid_bonded", "load.observations": str(STEPS)}
PATIENCE = 120.0


def start(folder: Path, **changed: str) -> subprocess.Popen[str]:
    given = [word for key, value in {**BLOCK, **changed}.items() for word in ("--set", f"{key}={value}")]
    command = [sys.executable, "-m", "benchmark", "run", "skin-5N", *given, "--out", "press"]
    return subprocess.Popen(command, cwd=folder, text=True, stderr=subprocess.PIPE, start_new_session=True)


def kill_once_kept(process: subprocess.Popen[str], kept: Path) -> None:
    """Kill a run that has kept its first steps."""
    until = time.monotonic() + PATIENCE
    while not kept.exists() and time.monotonic() < until:
        assert process.poll() is None
        time.sleep(0.05)
    process.kill()
    process.communicate(timeout=PATIENCE)
    assert process.returncode == -signal.SIGKILL


def interrupt_once_resumed(process: subprocess.Popen[str]) -> str:
    """Press Ctrl-C in a run that has taken up kept steps; what it said."""
    assert process.stderr is not None
    while not (line := process.stderr.readline()).startswith("the FEM goes on after step "):
        assert line
    os.killpg(process.pid, signal.SIGINT)
    said = process.communicate(timeout=PATIENCE)[1]
    assert process.returncode == 130
    return " ".join(said.split())


@pytest.mark.slow
def test_a_killed_run_goes_on_to_the_same_results(tmp_path: Path) -> None:
    kept = tmp_path / ".press.unfinished" / "fem_steps.kept"
    kill_once_kept(start(tmp_path), kept)
    assert not (tmp_path / "press").exists()
    said = interrupt_once_resumed(start(tmp_path))
    assert "Traceback" not in said
    assert "error: interrupted; what was computed is in .press.unfinished; " in said
    assert "the same command with --out press goes on from there" in said
    third = start(tmp_path)
    said = " ".join(third.communicate(timeout=PATIENCE)[1].split())
    assert third.returncode == 0
    assert "the FEM goes on after step " in said
    assert [each.name for each in tmp_path.iterdir()] == ["press"]
    document = json.loads((tmp_path / "press" / "results.json").read_text())
    resumed = document["models"]["fem"]["resumed"]
    assert 0 < resumed["steps"] <= resumed["total"] == STEPS
    assert resumed["seconds"] > 0.0
    assert any(text.startswith("FEM resumed after step") for text in document["warnings"])
    scenario = load_scenario("skin-5N", BLOCK)
    whole = prepare("fem", scenario).run(scenario_drive(scenario))
    table = pd.read_csv(tmp_path / "press" / "tables" / "max_deformation.csv")
    np.testing.assert_allclose(table.fem_mm, 1e3 * whole.top_deflection.ravel(), rtol=1e-7)
    timing = pd.read_csv(tmp_path / "press" / "tables" / "timing.csv").query("model == 'fem'")
    assert len(timing) == 3
    assert timing.cpu_s.min() > 0.5 * timing.cpu_s.max()
