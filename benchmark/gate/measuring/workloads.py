"""The timed pieces of the product: what a user waits for, one function each.

A workload is set up from a job (names and absolute paths) and returns the work that is then called again and again;
set-up is not timed. What only one of them needs it imports itself, since another revision may not have it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmark.files import Scenario, load_scenario
from benchmark.gate.measuring.models import model_of
from benchmark.gate.measuring.references import Work
from benchmark.models import scenario_drive

if TYPE_CHECKING:
    import fem

Job = Mapping[str, Any]

VERTICES = 81
REACH = 4.0
"""A frame is a square of 81 x 81 vertices, four tool radii to each side of the axis."""
FIT_TRIALS = 2


def run_history(job: Job) -> Work:
    """Follow the scenario's load history with the FEM or the wave model (`model`): all its load steps."""
    scenario = load_scenario(Path(job["scenario"]), job["set"])
    prepared, drive = model_of(job, scenario), scenario_drive(scenario)
    return lambda: prepared.run(drive)


def wave_frame(job: Job) -> Work:
    """One frame of every layer's deflected face for each step of the scenario's load history."""
    from wavemodel import DiscTool, LayeredWave, WaveLayer

    scenario = load_scenario(Path(job["scenario"]), job["set"])
    layers = [
        WaveLayer(layer.name, layer.thickness, layer.density, layer.youngs_modulus, layer.poisson_ratio)
        for layer in scenario.tissue.layers
    ]
    tool, options = scenario.tool, scenario.wave
    wave = LayeredWave(layers, DiscTool(tool.radius, tool.contact), window=options.window, modes=options.modes)
    positions = np.linspace(-REACH * tool.radius, REACH * tool.radius, VERTICES)
    surface, drive = wave.surface(positions, positions), scenario_drive(scenario)
    solution = wave.run(drive.control, drive.time, drive.value)
    states = [solution.snapshot(step) for step in range(drive.time.size)]

    def work() -> None:
        for state in states:
            surface.frame(state)

    return work


def fem_assembly(job: Job) -> Work:
    """Residual and tangent of the finite elements, assembled once under a tenth of the scenario's peak load."""
    import fem

    scenario = load_scenario(Path(job["scenario"]), job["set"])
    model = fem.prepare(_problem(scenario))
    system = model.equilibrium.system
    unknowns, pressure = system.rest()
    rest = system.evaluate(unknowns, pressure)
    if rest is None:
        raise ArithmeticError(f"scenario {scenario.name}: the mesh has an element without volume")
    model.equilibrium.solver.factorise(system.tangent(rest))
    loaded = 0.1 * scenario.load.peak * model.equilibrium.solver.solve(model.equilibrium.unit_load[:, None])[:, 0]

    def work() -> None:
        state = system.evaluate(loaded, pressure)
        if state is None:
            raise ArithmeticError(f"scenario {scenario.name}: a tenth of the load turns an element inside out")
        system.tangent(state)

    return work


def _problem(scenario: Scenario) -> fem.Problem:
    """A finite-strain press with neo-Hookean layers, in the solver's terms."""
    import fem

    return fem.Problem(
        layers=tuple(
            fem.Layer(each.name, each.thickness, each.density, fem.NeoHookean(each.youngs_modulus, each.poisson_ratio))
            for each in scenario.tissue.layers
        ),
        tool=fem.Tool(scenario.tool.radius, scenario.tool.contact),
        support=fem.Support(scenario.support.kind),
        kinematics="finite",
        discretisation=fem.Discretisation(scenario.fem.mesh, scenario.fem.radius),
    )


def fit(job: Job) -> Work:
    """Fit two trials of a session with a curve that is given: no finite elements in it."""
    from benchmark.files import load_session
    from benchmark.fitting import ForceCurve, TrialData, fit_session

    session = load_session(Path(job["session"]))
    depth = np.linspace(0.0, 12e-3, 41)[1:]
    curve = ForceCurve(depth, 260.0 * depth * (1.0 + (depth / 8e-3) ** 1.5))
    trials = [
        TrialData(trial.name, trial.condition, trial.table.time, trial.table.depth, trial.table.force, curve)
        for trial in session.trials[:FIT_TRIALS]
    ]
    layers = session.specimen.layers
    return lambda: fit_session(trials, layers)


WORKLOADS: Mapping[str, Callable[[Job], Work]] = MappingProxyType(
    {"history": run_history, "wave_frame": wave_frame, "fem_assembly": fem_assembly, "fit": fit}
)
"""The workloads by the names that a gate file calls them."""
