"""Bounded steps against SciPy's bounded linear least squares."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from benchmark.response.normal_equations import bounded_step, joint_step, stepped, trial_equations


@pytest.mark.parametrize("seed", range(40))
def test_a_bounded_step_is_the_least_within_its_edges(seed) -> None:
    rng = np.random.default_rng(seed)
    size = int(rng.integers(2, 9))
    design = rng.normal(size=(2 * size, size)) @ (np.eye(size) + 3.0 * np.ones((size, size)))
    measured = 10.0 * rng.normal(size=2 * size)
    low, high = -np.abs(rng.normal(size=size)), np.abs(rng.normal(size=size))
    low[rng.random(size) < 0.3], high[rng.random(size) < 0.2] = 0.0, 0.0
    exact = lsq_linear(design, measured, (low - 1e-12, high + 1e-12), tol=1e-14, method="bvls").x
    found = bounded_step(design.T @ design, design.T @ measured, (low, high))
    assert ((found >= low) & (found <= high)).all()
    assert 0.5 * np.sum((design @ found - measured) ** 2) == pytest.approx(
        0.5 * np.sum((design @ exact - measured) ** 2), rel=1e-9
    )


def test_what_left_with_another_comes_back_where_the_slope_leads_inside() -> None:
    """Both leave to begin with; with the first at its edge the second is best at 0.45, inside."""
    matrix, slope = np.array([[1.0, 0.9], [0.9, 1.0]]), np.array([2.0, 1.35])
    found = bounded_step(matrix, slope, (np.array([-1.0, -0.5]), np.array([1.0, 5.0])))
    assert np.linalg.solve(matrix, slope)[0] > 1.0
    assert np.linalg.solve(matrix, slope)[1] < -0.5
    assert found == pytest.approx([1.0, 0.45])


def test_nuisances_at_their_edges_change_what_the_vector_does() -> None:
    rng = np.random.default_rng(5)
    columns, own = rng.normal(size=(3, 30, 2)), rng.normal(size=(3, 30, 2))
    residual = rng.normal(size=(3, 30)) + 3.0 * own[..., 0] + columns[..., 0]
    weight = np.array([2.0, 0.5])
    trials = [trial_equations(*each, np.zeros(2), weight) for each in zip(columns, own, residual, strict=True)]
    edges = np.full((3, 2), 0.8)
    held = [np.zeros(2, dtype=bool)] * 3
    step, moves = joint_step(
        trials, (np.ones(2), np.zeros(2)), 0.0, (np.full(2, -9.0), np.full(2, 9.0)), (-edges, edges), held
    )
    whole = np.zeros((98, 8))
    for k in range(3):
        whole[30 * k : 30 * k + 30, :2], whole[30 * k : 30 * k + 30, 2 + 2 * k : 4 + 2 * k] = columns[k], own[k]
    whole[90:] = np.diag([1.0, 1.0, *np.sqrt([2.0, 0.5] * 3)])
    ends = np.r_[9.0, 9.0, edges.ravel()]
    exact = lsq_linear(whole, np.r_[residual.ravel(), np.zeros(8)], (-ends, ends), tol=1e-14, method="bvls").x
    assert (np.abs(exact[2:]) == 0.8).any()
    assert step == pytest.approx(exact[:2], abs=1e-9)
    assert moves.ravel() == pytest.approx(exact[2:], abs=1e-9)


def test_a_step_to_a_bound_ends_on_it_to_the_last_bit() -> None:
    at, bounds = np.array([0.1, 0.3, 0.2]), (np.array([-0.7, -1.0, -1.0]), np.array([1.0, 0.7, 1.0]))
    after = stepped(at, np.array([-0.7 - 0.1, 0.7 - 0.3, 0.1]), bounds)
    assert after.tolist() == [-0.7, 0.7, pytest.approx(0.3)]
