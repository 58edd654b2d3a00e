"""On the same mesh other finite-element programs find the same displacements; each is skipped where it is missing."""

import importlib.util
import shutil

import numpy as np
import pytest

from tests.performance.peers.bars import Bar, bars
from tests.performance.peers.cases import axisymmetric_case, block_case
from tests.performance.peers.comparison import compare
from tests.performance.peers.running import Timing, run_in_turn

needs_felupe = pytest.mark.skipif(importlib.util.find_spec("felupe") is None, reason="felupe is not installed")
needs_calculix = pytest.mark.skipif(shutil.which("ccx") is None, reason="Debian's calculix-ccx is not installed")


@pytest.mark.parametrize(
    ("program", "case", "allowed"),
    [
        pytest.param("felupe", lambda: block_case(0.6), 1e-8, marks=needs_felupe, id="felupe-linear"),
        pytest.param("felupe", lambda: axisymmetric_case(5, 1.0), 1e-6, marks=needs_felupe, id="felupe-hyperelastic"),
        pytest.param("calculix", lambda: block_case(0.6), 1e-5, marks=needs_calculix, id="calculix-linear"),
    ],
)
def test_the_same_mesh_gives_the_same_displacements(program, case, allowed):
    found = compare(run_in_turn(case(), ["ours", program], repeats=1, threads=1))
    assert 0.0 < found[program].difference < allowed


@needs_felupe
@pytest.mark.parametrize(("name", "within"), [("sheet, small", 0.02), ("stiff on soft", 0.015)])
def test_elements_of_another_code_bound_the_force_over_a_hole(name, within):
    """By displacement alone from above, with one pressure an element from below; held too near, ours was 5 % above."""
    from tests.performance.peers.felupe_refined import PRESSES, SMALL, Judge

    press = PRESSES[name]
    ours, above = press.ours("fine"), Judge(press, 0.5).force()
    assert above * (1.0 - within) < ours < above
    if press.depth < SMALL * press.radius:
        assert above * (1.0 - 2.0 * within) < Judge(press, 0.5, pressure=True).force() < ours


def timing(seconds, moved=1.0):
    return Timing(seconds, seconds, seconds, np.array([[0.0, moved]]))


def test_ratios_are_formed_within_a_repeat():
    found = compare({"ours": [timing(1.0), timing(10.0)], "calculix": [timing(3.0), timing(30.0, 2.0)]})
    assert (found["calculix"].ratio["process"].least, found["calculix"].ratio["process"].most) == (3.0, 3.0)
    assert found["calculix"].difference == 0.0


def test_bars_are_held_or_missed():
    sizes = {"linear 44k": 44_000, "linear 97k": 88_000}
    found = {
        "linear 44k": compare({"ours": [timing(1.0)], "calculix": [timing(1.2, 1.0 + 1e-4)]}),
        "linear 97k": compare({"ours": [timing(2.0)], "calculix": [timing(8.0)]}),
    }
    held = {bar.name: bar for bar in bars(found, sizes)}
    assert not held["linear 44k, calculix over ours, whole process"].held
    assert held["linear 97k, calculix over ours, whole process"].held
    assert not held["linear, largest difference from calculix"].held
    growth = held["growth exponent of ours from 44000 to 88000 unknowns, whole process"]
    assert growth.value == pytest.approx(1.0)
    assert str(Bar("x", 1.0, 2.0, True)) == "  MISSED x: 1 (>= 2)"
