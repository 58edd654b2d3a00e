"""The benchmark of growth runs, and both solvers press the same depth."""

import pytest

from tests.performance.scale import FIELDS, measure, mesh


def test_both_solvers_press_one_depth():
    direct, found = (measure(0.6, solver, 0) for solver in ("auto", "iterative"))
    assert tuple(found) == FIELDS
    assert found["solver"] == "iterative"
    assert found["iterations"] > 0
    assert found["depth_mm"] == pytest.approx(direct["depth_mm"], rel=1e-7)


def test_the_mesh_is_finer_in_all_directions():
    coarse, fine = mesh(0.8), mesh(1.6)
    assert 6 < fine.elements.shape[1] / coarse.elements.shape[1] < 10
