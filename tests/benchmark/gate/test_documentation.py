"""What docs/gate.md shows works as it stands."""

import re
import tomllib
from pathlib import Path

import pytest

from benchmark.cli.app import main
from benchmark.gate.accuracy import tolerance_of
from benchmark.gate.plan import load_plan
from benchmark.gate.versions import PRODUCT

PAGE = (PRODUCT / "docs" / "gate.md").read_text(encoding="utf-8")


def test_the_gate_file_can_be_used(tmp_path: Path) -> None:
    (block,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "gate.toml").write_text(block)
    (tmp_path / "my_model.py").write_text("def deform(layers, tool, support, time, force): ...\n")
    plan = load_plan(tmp_path / "gate.toml")
    assert plan.file.timing.margin == pytest.approx(0.15)
    assert plan.jobs[0]["calls"] == tomllib.loads(block)["timed"][0]["calls"]
    for name, unit in (("max_deformation_mm.skin", "mm"), ("surface_at_2_radii_mm", "mm"), ("peak_force_N", "N")):
        assert tolerance_of(f"press.{name}", unit, plan.file.tolerances)[0] == pytest.approx(1e-3)


def test_every_option_it_names_exists(capfd: pytest.CaptureFixture[str]) -> None:
    main(["check", "--help"])
    known = set(re.findall(r"--[a-z]+", capfd.readouterr().out))
    commands = re.findall(r"python -m benchmark check(.*)", PAGE)
    used = {option for command in commands for option in re.findall(r"--[a-z]+", command)}
    assert len(commands) >= 6
    assert used <= known


def test_what_it_says_of_the_rule_is_what_the_gate_does() -> None:
    timing = load_plan(None).file.timing
    assert f"{timing.blocks} blocks in a process" in PAGE
    assert f"more than {100 * timing.margin:g} % above" in PAGE
    assert f"beyond {100 * timing.other_machine_margin:g} %" in PAGE
    assert f"more than {100 * timing.margin_against:g} % above the other revision" in PAGE
    assert timing.rounds == (3, 10)
    assert "three at least, ten at most" in PAGE


def test_both_pages_say_that_a_revision_makes_no_worktree() -> None:
    """One said that it is one; `test_versions` sees that there is none."""
    other = (PRODUCT / "docs" / "robustness.md").read_text(encoding="utf-8")
    assert "(no git worktree;" in " ".join(PAGE.split())
    assert "without a git worktree" in " ".join(other.split())
