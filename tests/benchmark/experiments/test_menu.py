from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from bench_hw.cli import app
from bench_hw.motion.protocol_file import load_protocol
from benchmark.experiments.menu import (
    Usual,
    menu,
    minutes,
    motion,
    protocol_toml,
    rigid_block,
    ruler_image,
    same_again,
    second_tools,
)

USUAL = Usual(depth=2e-3, speed=1e-3, hold=5.0, thickness=20e-3)
EVERYTHING = (same_again(USUAL), *menu(USUAL), *second_tools(USUAL, 5e-3), rigid_block(4.0), ruler_image())


@pytest.mark.parametrize("experiment", EVERYTHING, ids=lambda each: each.name)
def test_the_bench_reads_every_protocol(experiment, tmp_path: Path) -> None:
    path = tmp_path / "next_experiment.toml"
    path.write_text(protocol_toml(experiment))
    protocol = load_protocol(path).protocol
    assert protocol.segments
    assert protocol.setup == dict(experiment.setup)


@pytest.mark.parametrize("experiment", [menu(USUAL)[0], rigid_block(4.0)], ids=lambda each: each.name)
def test_a_dry_run_of_the_bench_takes_it(experiment, tmp_path: Path) -> None:
    path = tmp_path / "next_experiment.toml"
    path.write_text(protocol_toml(experiment))
    result = CliRunner().invoke(app, ["capture", str(path), "--dry-run"])
    assert result.exit_code == 0
    assert "s a trial" in result.stdout


def test_each_entry_changes_one_thing() -> None:
    motions = {each.name: motion(each, 500) for each in (same_again(USUAL), *menu(USUAL))}
    assert motions["deeper"][1].max() == pytest.approx(3e-3, rel=0.02)
    assert all(depth.max() == pytest.approx(2e-3, rel=0.02) for name, (_, depth) in motions.items() if name != "deeper")
    assert motions["slower"][0][-1] > 3.0 * motions["same again"][0][-1]
    assert motions["longer hold"][0][-1] == pytest.approx(motions["same again"][0][-1] + 55.0)
    assert np.sum(np.diff(np.sign(motions["cycles"][1] - 1e-3)) > 0) == 3


def test_a_wider_tool_is_held_as_much_longer_as_fluid_takes_to_leave() -> None:
    tools = {each.name: each for each in second_tools(USUAL, 5e-3)}
    assert [each.tool_radius for each in tools.values()] == pytest.approx([8e-3, 3e-3, 12.5e-3, 2e-3])
    usual = motion(same_again(USUAL), 500)[0][-1]
    more = {name: motion(each, 500)[0][-1] - usual for name, each in tools.items()}
    assert more["wider tool"] == pytest.approx(5.0 * (1.6**2 - 1.0))
    assert more["much wider tool"] == pytest.approx(5.0 * (2.5**2 - 1.0))
    assert more["narrower tool"] == more["much narrower tool"] == pytest.approx(0.0, abs=1e-9)
    longest = second_tools(replace(USUAL, hold=50.0), 5e-3)[2]
    assert motion(longest, 500)[0][-1] == pytest.approx(usual + 55.0)
    assert "hold for 60 s" in longest.words


def test_no_tool_is_pressed_deeper_than_its_diameter_but_where_its_own_is():
    deep = replace(USUAL, depth=9.7e-3)
    assert [each.name for each in second_tools(deep, 5e-3)] == ["wider tool", "much wider tool"]
    assert [each.tool_radius for each in second_tools(deep, 5e-3, (4.8e-3, 5e-3, 6e-3))] == [6e-3]
    needle = replace(USUAL, depth=9.7e-3)
    assert [each.tool_radius for each in second_tools(needle, 1e-3, (0.5e-3, 1.5e-3))] == [1.5e-3]


def test_tools_that_are_there_are_taken_instead_of_any() -> None:
    found = second_tools(USUAL, 5e-3, (5.02e-3, 2.5e-3, 9e-3))
    assert {each.name: each.tool_radius for each in found} == {"tool of 2.5 mm": 2.5e-3, "tool of 9 mm": 9e-3}
    assert second_tools(USUAL, 5e-3, ()) == ()


def test_a_thin_specimen_is_not_pressed_through() -> None:
    thin = Usual(depth=2e-3, speed=1e-3, hold=0.0, thickness=3e-3)
    assert "deeper" not in {each.name for each in menu(thin)}


def test_time_at_the_bench_counts_the_set_up() -> None:
    assert minutes(rigid_block(4.0), 1) > 10.0
    assert minutes(menu(USUAL)[0], 10) == pytest.approx(10 * minutes(menu(USUAL)[0], 1))
