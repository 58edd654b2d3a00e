"""A bonded press that folds the usual mesh is followed further with larger elements at the edge."""

from dataclasses import replace

import numpy as np
import pytest

import fem
from benchmark.files import load_scenario
from benchmark.models import prepare, scenario_drive
from benchmark.models.fem_problem import problem_of
from benchmark.models.fem_steps import WIDER, follow_deeper

LAYER = fem.Layer("jelly", 12e-3, 1000.0, fem.NeoHookean(2e4, 0.45))
TIME = np.array([1.0, 2.0, 3.0])


def model(contact: str = "rigid_bonded", **others) -> fem.analysis.prepared.Model:
    edge = None if contact in ("rigid_bonded", "uniform_pressure") else 1e-3
    problem = fem.Problem((LAYER,), fem.Tool(5e-3, contact, edge), fem.Support("bonded"), **others)
    return fem.prepare(problem)


def reaching(made: fem.analysis.prepared.Model, steps: int, reached: float, depth: float = 1.0) -> fem.Solution:
    """A run that stopped after so many of three steps of 1 N, or did not."""
    whole = made.run(fem.Load("force", TIME, [0.1, 0.2, 0.3]))
    stop = None if steps == 3 else fem.Failure(steps + 1, TIME[steps], "force", reached, steps + 1.0, "it folds")
    kept = {name: getattr(whole, name)[:steps] for name in ("time", "force", "top_deflection")}
    return replace(whole, **kept, depth=depth * np.arange(1.0, steps + 1), failure=stop, complete=stop is None)


def follow(made: fem.analysis.prepared.Model, answers: dict[float, tuple[int, float]]):
    tried: list[float] = []

    def run(each: fem.analysis.prepared.Model, edge: float) -> fem.Solution:
        assert each.problem.discretisation.edge == edge
        tried.append(edge)
        return reaching(each, *answers[edge], depth=1.0 if edge == 1.0 else 0.99)

    best, found = follow_deeper(made, run)
    return best.problem.discretisation.edge, found, tried


def test_a_press_that_the_usual_mesh_follows_is_run_once() -> None:
    edge, found, tried = follow(model(), {1.0: (3, 3.0)})
    assert (edge, tried, found.warnings) == (1.0, [1.0], ())


def test_the_first_larger_edge_that_goes_the_whole_way_is_taken_and_said() -> None:
    edge, found, tried = follow(model(), {1.0: (2, 2.5), 2.0: (3, 3.0)})
    assert (edge, tried) == (2.0, [1.0, 2.0])
    assert found.complete
    assert len(found.warnings) == 1
    assert "could not follow the press beyond 2.5 N" in found.warnings[0]
    assert "elements 2 times larger" in found.warnings[0]
    assert "depth is -1.00 % apart at 2000 mm" in found.warnings[0]


def test_of_runs_that_all_stop_the_furthest_is_taken() -> None:
    edge, found, tried = follow(model(), {1.0: (1, 1.5), 2.0: (2, 2.7), 4.0: (2, 2.6), 8.0: (2, 2.5)})
    assert (edge, tried) == (2.0, [1.0, *WIDER])
    assert found.failure is not None
    assert follow(model(), {1.0: (1, 1.5), 2.0: (1, 1.5), 4.0: (1, 1.2), 8.0: (1, 1.2)})[0] == 1.0


@pytest.mark.parametrize(
    "other", [{"contact": "uniform_pressure"}, {"contact": "rigid_frictionless"}, {"kinematics": "linear"}]
)
def test_other_presses_have_no_such_edge(other) -> None:
    assert follow(model(**other), {1.0: (1, 1.5)})[2] == [1.0]
    assert max(WIDER) <= fem.problem.parts.LARGEST_EDGE


def test_a_try_that_is_far_from_the_usual_mesh_is_not_believed() -> None:
    usual, tried = reaching(model(), 1, 1.5), []

    def run(each: fem.analysis.prepared.Model, edge: float) -> fem.Solution:
        tried.append(edge)
        return usual if edge == 1.0 else reaching(each, 3, 3.0, depth=0.96)

    best, found = follow_deeper(model(), run)
    assert (best.problem.discretisation.edge, tried) == (1.0, [1.0, *WIDER])
    assert found is usual


def test_a_thin_first_layer_has_no_larger_edge() -> None:
    thin = fem.Layer("skin", 1e-4, 1000.0, fem.NeoHookean(2e4, 0.45))
    made = fem.prepare(fem.Problem((thin, LAYER), fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded")))
    assert follow(made, {1.0: (1, 1.5)})[2] == [1.0]


THICK = {"epidermis": "5 mm", "dermis": "5 mm", "subcutaneous_fat": "10 mm"}


@pytest.mark.slow
def test_a_thick_soft_tissue_is_pressed_deeper_than_the_usual_mesh_can() -> None:
    settings = {"load.control": "depth", "load.peak": "7 mm", "load.shape": "ramp", "load.observations": "10"}
    for layer, thickness in THICK.items():
        values = {"youngs_modulus": "10 kPa", "thickness": thickness, "poisson_ratio": "0.45"}
        settings |= {f"{layer}.{name}": value for name, value in values.items()}
    scenario = load_scenario("skin-5N", {**settings, "tool.contact": "rigid_bonded"})
    drive = scenario_drive(scenario)
    usual = fem.prepare(problem_of(scenario)).run(fem.Load("depth", drive.time, drive.value))
    assert usual.failure is not None
    result = prepare("fem", scenario).run(drive)
    assert result.complete
    assert "times larger" in result.notes["mesh"]
    both = len(usual.time)
    assert both > 0
    np.testing.assert_allclose(result.force[:both], usual.force, rtol=0.015)
