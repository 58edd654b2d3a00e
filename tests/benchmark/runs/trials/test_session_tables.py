"""Curves of sessions whose tool the finite elements do not follow to the depth of the trials."""

from contextlib import nullcontext

import numpy as np
import pytest

from benchmark.errors import SolverError
from benchmark.files import load_session
from benchmark.models import prepare
from benchmark.models.prepare import scenario_drive
from benchmark.response.fem_table import fem_or_wave_table
from benchmark.runs.fitted_session import fit_trials
from benchmark.runs.session_run import session_scenario
from benchmark.runs.trials.session_tables import base_curves

TISSUE = """\
schema = 1
name = "pad"

[[layers]]
name = "pad"
thickness = "6 mm"
density = "1000 kg/m^3"
youngs_modulus = "50 kPa"
poisson_ratio = 0.45
"""


class Quiet:
    def say(self, text):
        pass

    def progress(self, title):
        return nullcontext(lambda *_: None)


@pytest.fixture
def pad(tmp_path):
    """A pad pressed to 3.3 mm of 6 mm by a flat tool that slides, or by another."""

    def make(tool='contact = "rigid_frictionless"'):
        (tmp_path / "pad.toml").write_text(TISSUE)
        depth = np.linspace(-0.2, 3.3, 50)
        np.savetxt(
            tmp_path / "one.csv",
            np.column_stack([np.arange(50) / 10, depth, np.maximum(depth, 0.0) ** 2]),
            delimiter=",",
            header="time_s,depth_mm,force_N",
            comments="",
        )
        (tmp_path / "session.toml").write_text(
            f'schema = 1\nname = "pad"\nspecimen = "pad.toml"\n[tool]\nradius = "5 mm"\n{tool}\n'
            '[support]\nkind = "bonded"\n[[trials]]\nfile = "one.csv"\ncondition = "slow"\n'
        )
        return load_session(tmp_path, {"fem.mesh": "coarse"})

    return make


def test_a_flat_tool_that_slides_is_followed_by_the_nearest_tools(pad) -> None:
    session = pad()
    (setup,) = session.setups
    found = base_curves(session, {setup: 3.5e-3}, Quiet())
    curve = found.curves[setup]
    assert curve.depth[-1] == pytest.approx(3.5e-3)
    force = curve(np.linspace(0.1e-3, 3.5e-3, 60))
    assert (np.diff(force) > 0.0).all()
    assert np.diff(np.log(force)).max() < 1.0  # no step where one tool takes over from another
    (said,) = found.warnings
    assert "the tool as told is followed to" in said
    assert "goes on with the growth of an edge of 1.25 mm" in said
    tools = [tool for tool, _ in found.followed[setup]]
    assert tools[0] == setup[1]
    assert len(tools) > 1


def test_a_press_through_the_specimen_is_asked_about(pad) -> None:
    """Micrometres under `depth_mm` ended in how far the elements come, without the depth that was asked for."""
    session = pad('contact = "rigid_bonded"')
    (setup,) = session.setups
    with pytest.raises(SolverError, match=r"asked for 3300 mm of a specimen 6 mm thick: is another unit meant\?"):
        base_curves(session, {setup: 3.3}, Quiet())


@pytest.mark.slow
def test_the_discovery_has_a_base_where_neither_model_covers_the_tool(pad) -> None:
    session = pad()
    (setup,) = session.setups
    curve = base_curves(session, {setup: 3.3e-3}, Quiet()).curves[setup]
    table = fem_or_wave_table(session)(*setup, 3.3e-3)
    shallow = (table.depth > 0.3e-3) & (table.depth < 1e-3)
    assert table.force[shallow] == pytest.approx(curve(table.depth[shallow]), rel=0.03)
    assert (np.diff(table.force) > 0.0).all()
    assert "the tool as told is followed to" in table.note
    assert "a tool that sticks" in table.note


def test_a_sphere_is_followed_and_differentiated(pad) -> None:
    session = pad('contact = "rigid_frictionless"\nedge_radius = "5 mm"')
    (setup,) = session.setups
    table = fem_or_wave_table(session)(*setup, 1.5e-3)
    assert not table.note
    middle = table.depth.searchsorted(0.6e-3)
    power = np.log(table.force[-1] / table.force[middle]) / np.log(table.depth[-1] / table.depth[middle])
    assert 1.4 < power < 2.6  # 1.5 by Hertz, more on a thin layer; 1 under a flat end
    rise = table.by["tool.radius"].force[0, -1] / table.force[-1]
    assert 0.3 < rise < 1.2  # 0.5 by Hertz, more on a thin layer


@pytest.mark.slow
def test_a_run_takes_the_tool_that_carries_the_trials_force(pad) -> None:
    fitted = fit_trials(pad().folder, None, {"fem.mesh": "coarse"}, Quiet())
    told, warnings = session_scenario(fitted, as_told=True)
    assert told.tool.edge_radius == pytest.approx(0.5e-3)
    assert not warnings
    scenario, (said, *_) = session_scenario(fitted, as_told=False)
    assert scenario.tool != told.tool
    assert "the finite elements do not follow the tool as told to" in said
    drive = scenario_drive(scenario)
    assert prepare("fem", scenario).run(drive).failure is None
