"""Flagged cells as places: which are shown, where each is largest, and how they join those of accepted effects."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection import places as module
from benchmark.discovery.detection.cells import Cell, CellTable, FlipTest
from benchmark.discovery.detection.disagreement import Detection
from benchmark.discovery.detection.places import flagged_places, places
from benchmark.discovery.discovery_result import PHASES, Place

HOLD, LOAD = PHASES.index("hold"), PHASES.index("load")
FIRST, LAST = np.array([True, True, False, False]), np.array([False, False, True, True])


def study():
    """Two conditions of two trials: two rows of loading, two of a hold, the second one twice as deep."""
    conditions = tuple(
        SimpleNamespace(
            name=name,
            phase=np.array([LOAD, LOAD, HOLD, HOLD]),
            depth=np.array([[0.5e-3, 1e-3, 2e-3, 2e-3]] * 2) * deep,
        )
        for name, deep in (("slow", 1.0), ("fast", 2.0))
    )
    return SimpleNamespace(conditions=conditions, channels=("force_z",), names=("force_z",))


RESIDUAL = ((0.1, -0.4), (0.1, -0.4), (0.2, -0.1), (0.2, -0.1))
"""Of each trial while it loads and in its hold, N."""


@pytest.fixture
def base():
    signals = np.array([[0.0], [2.0], [4.0], [3.0]])
    missed = [np.array([[load], [load], [hold], [hold]]) for load, hold in RESIDUAL]
    count = np.ones((4, 1))
    trials = tuple(
        SimpleNamespace(condition=number, signals=signals + missing, count=count)
        for number, missing in zip((0, 0, 1, 1), missed, strict=True)
    )
    problem = SimpleNamespace(study=study(), trials=trials)
    model = SimpleNamespace(problem=problem, signals=lambda vector, nuisance: [signals] * 4)
    return SimpleNamespace(model=model, vector=None, nuisance=None)


def detection(p, t, means):
    rows = [{0: FIRST, 1: FIRST}, {0: LAST, 1: LAST}, {1: LAST}]
    cells = tuple(
        Cell(phase, 1, part, 0, each) for phase, part, each in zip((LOAD, HOLD, HOLD), (0, 0, 1), rows, strict=True)
    )
    test = FlipTest(np.array(t), np.array(p), 3.0, np.ones(3), min(p))
    return Detection(CellTable(cells, np.array(means)), test, 0.01, 0.01, np.zeros(3))


MEANS = [[0.1, 0.1, 0.2, 0.2], [-0.4, -0.4, -0.1, -0.1], [np.nan, np.nan, 0.3, 0.3]]


def test_only_cells_under_the_level_are_places_the_clearest_first(base):
    found = flagged_places(base, detection((0.01, 0.02, 0.2), (3.0, -9.0, 4.0), MEANS), 0.05)
    assert [(each.phase, each.condition) for each in found] == [("hold", "slow"), ("load", "fast")]
    assert flagged_places(base, detection((0.05, 0.05, 0.05), (3.0, 3.0, 3.0), MEANS), 0.05) == ()


def test_a_place_has_the_sign_size_depth_and_share_of_its_largest_condition(base):
    (place,) = flagged_places(base, detection((1.0, 0.02, 1.0), (3.0, -9.0, 4.0), MEANS), 0.05)
    assert (place.size, place.percent_of_signal) == pytest.approx((-0.4, 10.0))  # of a range of 4 N
    assert place.depth == pytest.approx((2e-3, 2e-3))
    (later,) = flagged_places(base, detection((1.0, 1.0, 0.02), (3.0, -9.0, 4.0), MEANS), 0.05)
    assert (later.condition, later.p) == ("fast", 0.02)
    assert later.size == pytest.approx(-0.1)  # what the picture shows, whatever was left on clean cells
    assert (later.residual, later.added) == (None, None)
    assert later.depth == pytest.approx((4e-3, 4e-3))


def test_cells_of_one_kind_are_shown_once_by_the_clearest(base):
    made = detection((1.0, 0.02, 0.02), (3.0, -9.0, 4.0), MEANS)
    twice = replace(made, table=replace(made.table, cells=(*made.table.cells[:2], made.table.cells[1])))
    twice = replace(twice, table=replace(twice.table, means=np.array([MEANS[0], MEANS[1], MEANS[1]])))
    (place,) = flagged_places(base, twice, 0.05)
    assert place.size == pytest.approx(-0.4)


def test_what_effects_add_stands_beside_the_residual_with_its_own_sign(base):
    changes = [np.full((4, 1), 0.88)] * 4
    (place,) = flagged_places(base, detection((1.0, 0.02, 1.0), (3.0, -9.0, 4.0), MEANS), 0.05, base, changes)
    assert (place.missed, place.added, place.size) == pytest.approx((-0.4, 0.88, 0.88))
    assert place.percent_of_signal == pytest.approx(10.0)  # of the residual


def place(channel, phase):
    return Place(channel, phase, "slow", 1, (0.0, 1e-3), 0.1, 1.0, 0.01)


def test_flagged_cells_follow_where_no_effect_shows(base, monkeypatch):
    shown, flagged = (place("force_z", "hold"),), (place("force_z", "hold"), place("force_z", "load"))
    monkeypatch.setattr(module, "effect_places", lambda *all_of: shown)
    monkeypatch.setattr(module, "flagged_places", lambda *all_of: flagged)
    monkeypatch.setattr(module, "effect_changes", lambda chosen: [])
    assert places(base, base, object(), None, Settings()) == (shown[0], flagged[1])
    assert places(base, base, base, None, Settings()) == flagged
