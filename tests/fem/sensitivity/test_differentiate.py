"""The derivatives of a press against differences of presses that are solved anew on the same, moved mesh."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import fem
from fem.analysis.newton import NewtonSettings
from fem.interactions import active_set
from fem.linear_solver import SingularMatrixError
from fem.sensitivity.changed_equations import changed_equations, moved_mesh
from fem.sensitivity.following import Following, _correction

TIGHT = NewtonSettings(tolerance=1e-13)
COARSE = fem.Discretisation("coarse")
STEP, SMALL = 1e-3, 1e-5
CENTRAL = {-2.0: 1.0 / 12.0, -1.0: -2.0 / 3.0, 1.0: 2.0 / 3.0, 2.0: -1.0 / 12.0}
PRESS = fem.Load("depth", np.array([0.5, 1.0]), np.array([0.6e-3, 1.2e-3]))


def skin() -> tuple[fem.Layer, ...]:
    """Three layers with three laws."""
    return (
        fem.Layer("epidermis", 0.4e-3, 1100.0, fem.NeoHookean(1.5e5, 0.48)),
        fem.Layer("dermis", 1.5e-3, 1116.0, fem.Yeoh(1.5e4, 1e4, 2e3, 0.45)),
        fem.Layer("fat", 6e-3, 971.0, fem.Gent(5e3, 20.0, 0.49)),
    )


def tied() -> fem.Problem:
    """A tool that the surface sticks to, over a hole, under pretension."""
    return fem.Problem(
        skin(), fem.Tool(3e-3, "rigid_bonded"), fem.Support("hole", 12e-3), discretisation=COARSE, pretension=2e3
    )


def touching() -> fem.Problem:
    """A tool that touches, on a base."""
    return fem.Problem(
        skin(),
        fem.Tool(3e-3, "rigid_frictionless", edge_radius=0.5e-3),
        fem.Support("bonded"),
        discretisation=COARSE,
    )


def changed(problem: fem.Problem, key: str, share: float) -> fem.Problem:
    """The problem with one number times 1 + share; Poisson's ratio moves by a share of its way to 0.5."""
    part, _, name = key.partition(".")
    if part in ("tool", "support"):
        whole = getattr(problem, part)
        return replace(problem, **{part: replace(whole, **{name: getattr(whole, name) * (1.0 + share)})})
    if part == "pretension":
        return replace(problem, pretension=problem.pretension * (1.0 + share))
    layers = list(problem.layers)
    number = [layer.name for layer in layers].index(part)
    layer = layers[number]
    if name == "thickness":
        layers[number] = replace(layer, thickness=layer.thickness * (1.0 + share))
    else:
        value = getattr(layer.material, name)
        more = value + share * (0.5 - value) if name == "poisson_ratio" else value * (1.0 + share)
        layers[number] = replace(layer, material=replace(layer.material, **{name: more}))
    return replace(problem, layers=tuple(layers))


def solved_anew(model, problem: fem.Problem, load: fem.Load) -> fem.Solution:
    """A changed problem on the moved mesh, to the last digits."""
    equations = changed_equations(model, problem, 0.0)
    equilibrium = replace(model.equilibrium, system=equations.system, unit_load=equations.unit_load)
    mesh = moved_mesh(model.mesh, model.problem, problem)
    return replace(model, problem=problem, mesh=mesh, equilibrium=equilibrium, newton=TIGHT).run(load)


def differences(model, load: fem.Load, key: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Derivatives of force, depth and displacement by central differences of the fourth order.

    Smaller steps than these lose more to round-off, and at the second order they leave 1e-6.
    """
    runs = {by: solved_anew(model, changed(model.problem, key, by * STEP), load) for by in (-2.0, -1.0, 1.0, 2.0)}
    assert all(run.complete for run in runs.values())
    force, depth, displacement = (
        sum(weight * getattr(runs[by], name) for by, weight in CENTRAL.items()) / STEP
        for name in ("force", "depth", "displacement")
    )
    return force, depth, displacement


def derivatives(model, load: fem.Load, keys: tuple[str, ...]) -> fem.DifferentiatedSolution:
    changes = {
        key: fem.ProblemChange(*(changed(model.problem, key, sign * SMALL) for sign in (-1.0, 1.0)), SMALL, SMALL)
        for key in keys
    }
    return fem.differentiate(model, load, changes)


def assert_right(problem: fem.Problem, load: fem.Load, keys: tuple[str, ...]) -> None:
    model = replace(fem.prepare(problem), newton=TIGHT)
    found = derivatives(model, load, keys)
    assert found.solution.force == pytest.approx(model.run(load).force, rel=1e-12)
    for key in keys:
        force, depth, displacement = differences(model, load, key)
        by = found.by[key]
        assert by.force == pytest.approx(force, rel=1e-6), key
        assert by.depth == pytest.approx(depth, rel=1e-6, abs=1e-15), key
        most = np.abs(displacement).max(axis=(1, 2), keepdims=True)
        assert np.abs(by.displacement - displacement) / most == pytest.approx(0.0, abs=2e-6), key


STACK = ("epidermis.youngs_modulus", "dermis.c20", "fat.mu", "fat.jm", "dermis.poisson_ratio", "dermis.thickness")


def test_a_tied_tool_over_a_hole() -> None:
    assert_right(tied(), PRESS, (*STACK, "tool.radius", "support.hole_radius", "pretension"))


def test_a_tool_that_touches_on_a_base() -> None:
    assert_right(touching(), PRESS, ("dermis.c20", "dermis.thickness", "tool.radius", "tool.edge_radius"))


def test_a_uniform_pressure_by_force() -> None:
    problem = fem.Problem(skin(), fem.Tool(3e-3, "uniform_pressure"), fem.Support("bonded"), discretisation=COARSE)
    load = fem.Load("force", np.array([0.5, 1.0]), np.array([0.1, 0.2]))
    assert_right(problem, load, ("fat.mu", "dermis.thickness", "tool.radius"))


def test_small_strain() -> None:
    problem = replace(tied(), kinematics="linear")
    assert_right(problem, PRESS, ("fat.mu", "fat.poisson_ratio", "dermis.thickness", "tool.radius", "pretension"))


def test_friction_is_followed_from_step_to_step(monkeypatch) -> None:
    """Where nodes stick, and the limits that follow the pressure, change with the parameter, too."""
    monkeypatch.setattr(active_set, "SETTLED", 1e-9)
    rubbing = fem.Tool(3e-3, "rigid_frictional", edge_radius=0.5e-3, friction_coefficient=0.3)
    model = replace(fem.prepare(replace(touching(), tool=rubbing)), newton=NewtonSettings(tolerance=1e-11))
    keys = ("tool.friction_coefficient", "dermis.thickness")
    found = derivatives(model, PRESS, keys)
    for key in keys:
        runs = []
        for sign in (-1.0, 1.0):
            equations = changed_equations(model, changed(model.problem, key, sign * STEP), 0.0)
            mesh = moved_mesh(model.mesh, model.problem, changed(model.problem, key, sign * STEP))
            equilibrium = replace(model.equilibrium, system=equations.system)
            runs.append(replace(model, mesh=mesh, equilibrium=equilibrium).run(PRESS))
        difference = (runs[1].force - runs[0].force) / (2.0 * STEP)
        assert found.by[key].force == pytest.approx(difference, abs=1e-5 * np.abs(difference).max()), key


def test_second_derivatives_are_those_of_differences() -> None:
    model, keys, step = replace(fem.prepare(tied()), newton=TIGHT), ("dermis.c20", "support.hole_radius"), 2e-3
    changes = {
        key: fem.ProblemChange(*(changed(model.problem, key, sign * 1e-4) for sign in (-1.0, 1.0)), 1e-4, 1e-4)
        for key in keys
    }
    found = fem.differentiate(model, PRESS, changes, second=True)
    for key in keys:
        less, more = (solved_anew(model, changed(model.problem, key, sign * step), PRESS) for sign in (-1.0, 1.0))
        second = found.by[key].second
        assert second is not None
        for name in ("force", "displacement"):
            middle = getattr(found.solution, name)
            difference = (getattr(more, name) - 2.0 * middle + getattr(less, name)) / step**2
            apart = np.abs(getattr(second, name) - difference).max()
            assert apart < 1e-3 * np.abs(difference).max(), (key, name)


def test_the_force_goes_with_all_moduli_together() -> None:
    """Forces of one degree in all stresses: their derivatives add up to the force itself."""
    keys = ("epidermis.youngs_modulus", "dermis.c10", "dermis.c20", "dermis.c30", "fat.mu")
    found = derivatives(fem.prepare(touching()), PRESS, keys)
    assert sum(found.by[key].force for key in keys) == pytest.approx(found.solution.force, rel=1e-8)


def test_what_is_no_number_has_no_derivative() -> None:
    told = tied()
    model = fem.prepare(told)
    other = replace(told, tool=replace(told.tool, contact="uniform_pressure"))
    with pytest.raises(fem.NotDifferentiableError, match="by numbers"):
        fem.differentiate(model, PRESS, {"contact": fem.ProblemChange(told, other, 0.0, 1.0)})
    wide = replace(told, tool=replace(told.tool, radius=13e-3))
    with pytest.raises(fem.NotDifferentiableError, match="would meet"):
        fem.differentiate(model, PRESS, {"tool.radius": fem.ProblemChange(told, wide, 0.0, 1.0)})


@pytest.mark.parametrize(("below", "above"), [(0.0, 0.0), (float("nan"), 1.0), (float("inf"), 1.0), (-1.0, 2.0)])
def test_a_change_by_nothing_or_by_no_number_is_refused(below: float, above: float) -> None:
    with pytest.raises(fem.FemError, match="together above 0"):
        fem.ProblemChange(tied(), tied(), below, above)


@pytest.mark.parametrize(
    ("control", "part", "message"), [("force", "all", "no derivative"), ("depth", "probe", "force")]
)
def test_a_derivative_that_is_no_number_is_said(monkeypatch, control: str, part: str, message: str) -> None:
    model = fem.prepare(tied())
    equilibrium = model.equilibrium
    solved = np.zeros((equilibrium.system.numbering.count, 2))

    def solve(right: np.ndarray) -> np.ndarray:
        if part == "all":
            raise SingularMatrixError("the stiffness matrix is singular")
        return solved

    monkeypatch.setattr(equilibrium.solver, "solve", solve)
    with pytest.raises(fem.NotDifferentiableError, match=message):
        _correction(equilibrium, control, solved[:, :1])


def test_a_state_whose_stiffness_cannot_be_factorised_has_no_derivative(monkeypatch) -> None:
    def factorise(*_: object) -> None:
        raise SingularMatrixError("the stiffness matrix is singular")

    equilibrium = fem.prepare(tied()).equilibrium
    monkeypatch.setattr(type(equilibrium), "factorise", factorise)
    state, system = SimpleNamespace(y=None, pressure=None), SimpleNamespace(evaluate=lambda *_: "evaluated")
    with pytest.raises(fem.NotDifferentiableError, match="no derivative: the stiffness matrix is singular"):
        Following(equilibrium, "force", [])(system, state, 1.0)
