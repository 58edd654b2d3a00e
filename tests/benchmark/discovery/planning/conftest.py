"""A simulated bench on a rig that gives way, a session to copy, and proposals for it."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import tomli_w

from bench_hw.rig.rig_file import load_rig
from benchmark.discovery.planning.bench_work import BenchWork, session_copy, unattended
from benchmark.discovery.report.discovery_record import NextExperiment
from benchmark.experiments.menu import Experiment, protocol_toml


@pytest.fixture
def folder(tmp_path) -> Path:
    """A rig with a virtual specimen on a rig that gives way, and a session to copy."""
    tools = [{"radius_mm": r, "depth_mm": [0.0, 1.0, 2.0, 4.0], "force_N": [0.0, 1.0, 2.0, 4.0]} for r in (5, 8)]
    specimen = {"schema": 1, "synthetic": True, "tools": tools, "effects": {"compliance_mm_per_N": 0.1}}
    (tmp_path / "specimen.toml").write_text(tomli_w.dumps(specimen))
    rig = {
        "schema": 1, "name": "virtual",
        "force": {"kind": "simulated", "rate": "100 Hz"},
        "actuator": {"kind": "simulated", "stroke": "50 mm", "accuracy": 1, "contact": "5 mm"},
        "simulation": {"specimen": "specimen.toml"},
    }  # fmt: skip
    (tmp_path / "rig.toml").write_text(tomli_w.dumps(rig))
    session = tmp_path / "session"
    session.mkdir()
    time = np.arange(60) / 20.0
    rows = [f"{t:.3f},{d:.4f},{d:.4f}" for t, d in zip(time, np.clip(time - 1.0, 0.0, 1.0), strict=True)]
    (session / "a.csv").write_text("\n".join(["time_s,depth_mm,force_N", *rows]) + "\n")
    table = {
        "schema": 1, "name": "s", "specimen": "skin_forearm", "synthetic": True,
        "tool": {"radius": "5 mm", "contact": "rigid_bonded"}, "trials": [{"file": "a.csv", "condition": "usual"}],
    }  # fmt: skip
    (session / "session.toml").write_text(tomli_w.dumps(table))
    return tmp_path


@pytest.fixture
def bench(folder) -> BenchWork:
    copy = session_copy(folder / "session", folder / "copy")
    return BenchWork(load_rig(folder / "rig.toml"), copy, unattended, seed=3)


@pytest.fixture
def proposal() -> Callable[[Experiment], NextExperiment]:
    return _proposal


def _proposal(experiment: Experiment) -> NextExperiment:
    return NextExperiment(
        ("a", "b"),
        experiment.name,
        experiment.words,
        1.0,
        9.0,
        5.0,
        {experiment.name: (9.0, 5.0)},
        protocol_toml(experiment),
    )
