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
)

USUAL = Usual(depth=2e-3, speed=1e-3, hold=5.0, thickness=20e-3)
EVERYTHING = (same_again(USUAL), *menu(USUAL), rigid_block(4.0), ruler_image())


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


def test_a_thin_specimen_is_not_pressed_through() -> None:
    thin = Usual(depth=2e-3, speed=1e-3, hold=0.0, thickness=3e-3)
    assert "deeper" not in {each.name for each in menu(thin)}


def test_time_at_the_bench_counts_the_set_up() -> None:
    assert minutes(rigid_block(4.0), 1) > 10.0
    assert minutes(menu(USUAL)[0], 10) == pytest.approx(10 * minutes(menu(USUAL)[0], 1))
