"""What a run says of the wave beside the finite elements: small strain, a flat end."""

import re

import pytest

from benchmark.cli.console import Console
from benchmark.files import Tool, load_scenario
from benchmark.models import NOTHING, scenario_drive
from benchmark.runs.options import RunOptions
from benchmark.runs.report.run_page import run_verdict
from benchmark.runs.scenario_run import SMALL_STRAIN, beside_small_strain, flat_wave, run_scenario

QUICK = {"fem.mesh": "coarse", "load.observations": "10"}
OPTIONS = RunOptions(repeats=0)
QUIET = Console(quiet=True)
pytestmark = pytest.mark.usefixtures("in_threads")


def test_a_deep_press_says_how_far_small_strain_is_off():
    record = run_scenario(load_scenario("skin-5N", QUICK), OPTIONS, QUIET)
    assert record.pair.wave.result is not None
    note = record.pair.wave.result.notes[SMALL_STRAIN]
    errors = [float(value) for value in re.findall(r"([+-][0-9.]+) %", note)]
    assert len(errors) == 3
    assert all(15.0 < error < 40.0 for error in errors)
    assert note in run_verdict(record).points
    linear = run_scenario(load_scenario("skin-5N", QUICK | {"wave.large_press": "linear"}), OPTIONS, QUIET)
    fem, wave = linear.pair.fem.result, linear.pair.wave.result
    assert fem is not None
    assert wave is not None
    assert errors[0] == pytest.approx(100 * (wave.top_deflection[4, 0] / fem.top_deflection[4, 0] - 1), abs=0.06)
    assert beside_small_strain(linear.scenario, linear.pair, scenario_drive(linear.scenario)) is linear.pair


def test_small_strain_finite_elements_need_no_note():
    scenario = load_scenario("skin-5N", QUICK | {"fem.kinematics": "linear"})
    record = run_scenario(scenario, OPTIONS, QUIET, own=NOTHING)
    assert record.pair.wave.result is not None
    assert SMALL_STRAIN not in record.pair.wave.result.notes


def test_under_friction_there_is_none_and_the_run_goes_on():
    rough = {"tool.contact": "rigid_frictional", "physics.friction_coefficient": "0.3", "tool.edge_radius": "2 mm"}
    record = run_scenario(load_scenario("skin-5N", QUICK | rough), OPTIONS, QUIET)
    assert record.pair.wave.result is not None
    assert SMALL_STRAIN not in record.pair.wave.result.notes
    assert any("the way back" in one for one in record.pair.wave.result.warnings)


def test_a_mesh_that_is_farther_off_than_the_models_may_be_apart_is_said():
    def said(margin, **more):
        settings = QUICK | {"comparison.equivalence_margin": str(margin)} | more
        record = run_scenario(load_scenario("skin-5N", settings), OPTIONS, QUIET)
        found = [each for each in record.warnings if "the FEM's own mesh is estimated" in each]
        return abs(record.pair.fem.result.mesh_error.percent), found

    off, (text,) = said(1e-6)
    assert f"estimated {off:.2g} % off, more than the 0.0001 % within which" in text
    assert text.endswith("--set fem.mesh=fine")
    assert said(0.01 * off * 1.01) == (off, [])


def test_a_wave_with_a_flat_end_is_said_under_a_round_tool() -> None:
    assert "flat end" in flat_wave(Tool(radius=5e-3, contact="rigid_frictionless", edge_radius=5e-3))[0]
    ball = Tool(radius=5e-3, contact="rigid_frictionless", edge_radius=5e-3)
    assert "39 to 114 %" in flat_wave(ball, hole=True)[0]
    assert "%" not in flat_wave(ball)[0]
    edge = Tool(radius=5e-3, contact="rigid_frictionless", edge_radius=0.5e-3)
    assert not flat_wave(edge)
    assert "8 to 24 %" in flat_wave(edge, hole=True)[0]
    assert not flat_wave(Tool(radius=5e-3, contact="uniform_pressure"), hole=True)
    assert not flat_wave(Tool(radius=5e-3, contact="rigid_bonded"))


@pytest.mark.parametrize("told", [{"load.control": "depth", "load.peak": "3 mm"}, {"load.peak": "-0.3 N"}])
def test_where_depths_are_told_or_small_strain_is_followed_there_is_none(told):
    """Depths that both waves were told were called 0 % off, and a pull in small strain off by itself."""
    record = run_scenario(load_scenario("skin-5N", QUICK | told), OPTIONS, QUIET)
    assert record.pair.wave.result is not None
    assert SMALL_STRAIN not in record.pair.wave.result.notes
