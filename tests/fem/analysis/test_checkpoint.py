"""A run that is stopped in the middle goes on from its checkpoint as if nothing had happened."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fem

ROOT = Path(__file__).parents[2]
FORCE = np.array([0.3, 0.6, 1.5, 2.5, 1.0, 0.2])
LOAD = fem.Load("force", np.arange(1.0, 7.0), FORCE)
ARRAYS = ("time", "force", "reaction", "depth", "top_deflection", "max_strain", "displacement", "pressure")


class StoppedError(Exception):
    """What ends a run from outside."""


def skin(geometry="axisymmetric", tilt=0.0, modulus=2e4):
    layers = (
        fem.Layer("dermis", 2e-3, 1000.0, fem.NeoHookean(1e5, 0.48)),
        fem.Layer("fat", 8e-3, 1000.0, fem.NeoHookean(modulus, 0.48)),
    )
    tool = fem.Tool(5e-3, "rigid_bonded", tilt=tilt)
    return fem.Problem(
        layers, tool, fem.Support("bonded"), discretisation=fem.Discretisation("coarse"), geometry=geometry
    )


def stop_at(step):
    def on_step(report):
        if report.step == step:
            raise StoppedError

    return on_step


def assert_equal(resumed, whole):
    for name in ARRAYS:
        one, other = getattr(resumed, name), getattr(whole, name)
        np.testing.assert_array_equal(one, other, err_msg=name)


@pytest.mark.parametrize("step", [1, 3, 5])
def test_a_stopped_run_goes_on(tmp_path, step):
    whole = fem.prepare(skin()).run(LOAD)
    path = tmp_path / "run.npz"
    with pytest.raises(StoppedError):
        fem.prepare(skin()).run(LOAD, stop_at(step), path)
    steps = []
    resumed = fem.prepare(skin()).run(LOAD, lambda report: steps.append(report.step), path)
    assert steps == list(range(step + 1, 7))
    assert whole.resumed is None
    assert resumed.resumed.steps == step
    assert resumed.resumed.seconds > 0.0
    assert_equal(resumed, whole)
    assert [p.name for p in tmp_path.iterdir()] == ["run.npz"]


def test_depth_control_and_a_finished_run(tmp_path):
    load = fem.Load("depth", [1.0, 2.0, 3.0], [1e-3, 2e-3, 1e-3])
    whole = fem.prepare(skin()).run(load)
    with pytest.raises(StoppedError):
        fem.prepare(skin()).run(load, stop_at(2), tmp_path / "run.npz")
    seconds = []
    for _ in range(2):
        resumed = fem.prepare(skin()).run(load, checkpoint=tmp_path / "run.npz")
        assert_equal(resumed, whole)
        seconds.append(resumed.resumed.seconds)
    assert 0.0 < seconds[0] < seconds[1]


@pytest.mark.slow
def test_a_tilted_tool_in_the_block_goes_on(tmp_path):
    load = fem.Load("force", [1.0, 2.0], [0.1, 0.2])
    model = fem.prepare(skin("block", np.radians(3.0)))
    with pytest.raises(StoppedError):
        model.run(load, stop_at(1), tmp_path / "run.npz")
    assert_equal(model.run(load, checkpoint=tmp_path / "run.npz"), model.run(load))


KILLED = """
import os, sys
import fem
from tests_of_checkpoint import LOAD, skin
fem.prepare(skin()).run(LOAD, lambda report: report.step == 4 and os.kill(os.getpid(), 9), sys.argv[1])
"""


def test_a_killed_process_leaves_a_whole_file(tmp_path):
    script = KILLED.replace("tests_of_checkpoint", "test_checkpoint")
    command = [
        sys.executable,
        "-c",
        f"import sys; sys.path[:0] = [{str(ROOT)!r}, {str(Path(__file__).parent)!r}]\n{script}",
    ]
    done = subprocess.run([*command, tmp_path / "run.npz"], check=False)
    assert done.returncode == -9
    assert_equal(fem.prepare(skin()).run(LOAD, checkpoint=tmp_path / "run.npz"), fem.prepare(skin()).run(LOAD))


@pytest.mark.parametrize("change", ["tissue", "load", "mesh"])
def test_the_file_of_another_run_is_refused(tmp_path, change):
    short = fem.Load("force", [1.0], [0.3])
    fem.prepare(skin()).run(short, checkpoint=tmp_path / "run.npz")
    problem, load = skin(), short
    if change == "tissue":
        problem = skin(modulus=3e4)
    elif change == "mesh":
        problem = replace(problem, discretisation=fem.Discretisation("default"))
    else:
        load = fem.Load("force", [1.0], [0.4])
    with pytest.raises(fem.FemError, match="is of another problem, mesh or load history"):
        fem.prepare(problem).run(load, checkpoint=tmp_path / "run.npz")


def test_a_damaged_file_and_a_missing_folder_are_refused(tmp_path):
    path = tmp_path / "run.npz"
    fem.prepare(skin()).run(fem.Load("force", [1.0], [0.3]), checkpoint=path)
    path.write_bytes(path.read_bytes()[:2000])
    with pytest.raises(fem.FemError, match="is damaged or no checkpoint"):
        fem.prepare(skin()).run(LOAD, checkpoint=path)
    with pytest.raises(fem.FemError, match="cannot be written"):
        fem.prepare(skin()).run(LOAD, checkpoint=tmp_path / "none" / "run.npz")


def test_a_linear_run_needs_none(tmp_path):
    solution = fem.prepare(replace(skin(), kinematics="linear")).run(LOAD, checkpoint=tmp_path / "run.npz")
    assert solution.complete
    assert not (tmp_path / "run.npz").exists()


@pytest.mark.parametrize("contact", ["rigid_bonded", "rigid_frictional"])
def test_a_body_with_a_memory_goes_on(tmp_path, contact):
    """Relaxation and friction remember; so do the friction limits, which a state tells to a tolerance only."""
    plain = skin()
    layers = tuple(replace(layer, relaxation=(fem.PronyTerm(0.4, 2.0),)) for layer in plain.layers)
    touches = contact == "rigid_frictional"
    tool = fem.Tool(5e-3, contact, 1e-3 if touches else None, friction_coefficient=0.3 if touches else None)
    problem = replace(plain, layers=layers, tool=tool)
    whole, path = fem.prepare(problem).run(LOAD), tmp_path / "run.npz"
    assert whole.complete
    with pytest.raises(StoppedError):
        fem.prepare(problem).run(LOAD, stop_at(4), path)
    assert_equal(fem.prepare(problem).run(LOAD, None, path), whole)
