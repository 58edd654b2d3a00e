"""The iterative solver beside the direct one: its answer, and how many iterations that takes."""

import dataclasses

import numpy as np
import pytest

import fem
from fem.linear_solver import SingularMatrixError, iterative
from fem.setup import building

ONE_STEP = fem.Load("force", np.array([1.0]), np.array([1e-3]))


def block(
    density="coarse", poisson=0.49, moduli=(1e6, 1e5, 1e4), law=fem.LinearElastic, contact="rigid_bonded", **more
):
    layers = [
        fem.Layer(f"layer {n}", thickness, 1000.0, law(E, poisson))
        for n, (thickness, E) in enumerate(zip((0.2e-3, 1.5e-3, 6e-3), moduli, strict=True))
    ]
    settings = {
        "kinematics": "linear" if law is fem.LinearElastic else "finite",
        "geometry": "block",
        "discretisation": fem.Discretisation(density, radius=30e-3),
        **more,
    }
    return fem.Problem(tuple(layers), fem.Tool(5e-3, contact), fem.Support("bonded"), **settings)


def iterations(problem):
    """Of the solution under 1 N."""
    model = fem.prepare(problem, "iterative")
    model.run(ONE_STEP)
    assert model.linear_solver == "iterative"
    return model.equilibrium.solver.iterations


@pytest.mark.parametrize("contact", ["rigid_bonded", "rigid_frictionless", "uniform_pressure"])
def test_small_strain_equals_the_direct_solution(contact):
    problem = block(contact=contact)
    direct, found = (fem.prepare(problem, choice).run(ONE_STEP) for choice in ("auto", "iterative"))
    size = np.abs(direct.displacement).max()
    np.testing.assert_allclose(found.displacement, direct.displacement, rtol=0.0, atol=1e-8 * size)
    np.testing.assert_allclose(found.reaction, direct.reaction, rtol=1e-6)
    assert found.warnings == direct.warnings


@pytest.mark.parametrize(("control", "last"), [("force", 0.4), ("depth", 0.5e-3)])
def test_finite_strain_equals_the_direct_solution(control, last):
    problem = block(law=fem.NeoHookean)
    load = fem.Load(control, np.array([0.5, 1.0]), np.array([0.5, 1.0]) * last)
    direct, found = (fem.prepare(problem, choice).run(load) for choice in ("auto", "iterative"))
    assert found.complete
    size = np.abs(direct.displacement).max()
    np.testing.assert_allclose(found.displacement, direct.displacement, rtol=0.0, atol=1e-8 * size)


def test_iterations_know_neither_poisson_s_ratio_nor_moduli():
    usual = iterations(block())
    assert usual < 45
    for poisson in (0.45, 0.495, 0.499):
        assert iterations(block(poisson=poisson)) < 1.4 * usual
    for moduli in ((1e4, 1e4, 1e4), (1e4, 1e6, 1e4), (1e4, 1e5, 1e6)):
        assert iterations(block(moduli=moduli)) < 1.6 * usual


def test_iterations_hardly_grow_with_the_mesh():
    """Eight times the unknowns of `halved` take at most half as many iterations again."""
    coarse, fine = (fem.Discretisation("default", radius=30e-3, halved=halved) for halved in (True, False))
    assert iterations(block(discretisation=fine)) < 1.5 * iterations(block(discretisation=coarse))


def test_a_direct_solver_takes_over_and_that_is_said(monkeypatch):
    monkeypatch.setattr(iterative, "MOST_ITERATIONS", 2)
    monkeypatch.setattr(iterative, "RESTART", 2)
    model = fem.prepare(block(), "iterative")
    found, direct = model.run(ONE_STEP), fem.prepare(block()).run(ONE_STEP)
    np.testing.assert_allclose(found.depth, direct.depth, rtol=1e-9)
    assert model.linear_solver.startswith("iterative, then ")
    assert "2 iterations left" in found.warnings[-1]
    assert "took over" in found.warnings[-1]


def test_a_body_too_large_for_a_direct_solver_fails_with_the_reason(monkeypatch):
    monkeypatch.setattr(iterative, "MOST_ITERATIONS", 2)
    monkeypatch.setattr(iterative, "RESTART", 2)
    monkeypatch.setattr(iterative, "MOST_DIRECT", 10)
    with pytest.raises(SingularMatrixError, match="the iterative solver failed: 2 iterations left"):
        fem.prepare(block(), "iterative").run(ONE_STEP)
    found = fem.prepare(block(law=fem.NeoHookean), "iterative").run(ONE_STEP)
    assert "the iterative solver failed" in found.failure.reason


def test_an_old_cycle_is_kept_while_it_serves():
    model = fem.prepare(block(law=fem.NeoHookean), "iterative")
    model.run(fem.Load("force", np.array([0.5, 1.0]), np.array([0.01, 0.02])))
    solver = model.equilibrium.solver
    cycle = solver._cycle
    rest = model.equilibrium.system.evaluate(*model.equilibrium.system.rest())
    model.equilibrium.factorise(rest)
    model.equilibrium.solve(model.equilibrium.unit_load[:, None], 1e-4)
    assert solver._cycle is cycle


def test_a_load_that_comes_again_is_solved_from_what_it_moved_before():
    """As that of 1 N under a prescribed depth; any other from rest."""
    equilibrium = fem.prepare(block(), "iterative").equilibrium
    solver, load = equilibrium.solver, equilibrium.unit_load[:, None]
    other = np.random.default_rng(4).normal(size=load.shape)
    equilibrium.factorise(equilibrium.system.evaluate(*equilibrium.system.rest()))
    rough, first = solver.solve(np.hstack((other, load)), 1e-3)[:, 1], solver.iterations
    again, more = solver.solve(load, 1e-6)[:, 0], solver.iterations
    solver.solve(other, 1e-6)
    anew, whole = solver.solve(load, 1e-6)[:, 0], solver.iterations
    assert 0 < more < whole
    assert first < whole
    size = np.abs(anew).max()
    np.testing.assert_allclose(again, anew, rtol=0.0, atol=1e-5 * size)
    assert 1e-7 * size < np.abs(rough - anew).max() < 1e-1 * size


def test_it_is_refused_where_there_is_none():
    axisymmetric = dataclasses.replace(block(), geometry="axisymmetric")
    with pytest.raises(fem.FemError, match="only with geometry = 'block'"):
        fem.prepare(axisymmetric, "iterative")
    endless = fem.Layer("deep", np.inf, 1000.0, fem.LinearElastic(1e4, 0.49))
    half_space = dataclasses.replace(block(), layers=(endless,), support=fem.Support("half_space"))
    with pytest.raises(fem.FemError, match="not on a half-space"):
        fem.prepare(half_space, "iterative")


def test_round_off_bounds_what_exact_displacements_leave():
    model = fem.prepare(block(), "iterative")
    problem = model.equilibrium
    rest = problem.system.evaluate(*problem.system.rest())
    round_off = problem.factorise(rest)
    y = np.random.default_rng(3).normal(size=model.unknowns) * 1e-3
    entries = problem.system.tangent(rest)
    exact = problem.system.scatter.round_off(entries, y)
    assert exact <= round_off(y) <= 20 * exact


def test_large_blocks_have_it_by_themselves(monkeypatch):
    monkeypatch.setattr(building, "ITERATIVE_FROM", {"linear": 1_000, "finite": 1_000_000})
    assert fem.prepare(block()).linear_solver == "iterative"
    assert fem.prepare(block(law=fem.NeoHookean)).linear_solver != "iterative"
    assert fem.prepare(block(), "superlu").linear_solver == "superlu"
