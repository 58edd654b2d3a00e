from dataclasses import replace

import numpy as np
import pytest

from bench_hw.motion.protocol_file import load_protocol
from benchmark.experiments.optimal_design import _able, designed
from benchmark.identification.parameters.identifiability import directions
from benchmark.identification.parameters.identified import identify


@pytest.fixture
def design(toy_fit):
    found = toy_fit(tools=(1,))
    return designed(identify(found, (), directions(found), ["one"] * len(found.problem.trials), ("toy",)))


def test_another_tool_tells_what_one_tool_leaves_open(design) -> None:
    same = next(one for one in design.proposals if one.experiment.name == "same again")
    others = [one for one in design.proposals if "tool" in one.experiment.name]
    assert others
    assert design.best_d.determines > same.determines
    assert design.best_a.determines == max(one.determines for one in design.proposals)
    assert (design.best_a.errors <= design.errors_now + 1e-9).all()


def test_a_smaller_tool_is_pressed_no_deeper(design) -> None:
    names = {(one.tool.radius, one.experiment.name.rpartition(", ")[2]) for one in design.proposals}
    assert {(5e-3, "deeper"), (2e-3, "deeper"), (0.8e-3, "faster")} <= names
    assert (0.8e-3, "deeper") not in names


def test_more_of_the_same_never_tells_less(design) -> None:
    same = next(one for one in design.proposals if one.experiment.name == "same again")
    assert same.determinant > 0.0
    assert (same.errors <= design.errors_now * (1.0 + 1e-9)).all()


def test_the_bench_reads_what_is_proposed(design, tmp_path) -> None:
    path = tmp_path / "next_experiment.toml"
    path.write_text(design.best_d.toml())
    protocol = load_protocol(path).protocol
    assert protocol.segments
    assert np.isfinite(design.best_d.minutes)


def test_after_one_tool_another_is_proposed_where_it_determines_as_much(design) -> None:
    other = design.best_d
    same = replace(other, tool=other.tool.model_copy(update={"radius": 2e-3}))
    assert other.tool.radius != 2e-3
    assert _able((same, other), {2e-3}) == [other]
    assert _able((same,), {2e-3}) == [same]
    assert _able((same, other), {2e-3, 5e-3}) == [same, other]
    assert _able((same, replace(other, errors=other.errors + 9.0)), {2e-3}) == [same]
