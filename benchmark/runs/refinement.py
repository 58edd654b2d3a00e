"""Mesh, load steps and modes refined: what the numbers' own error is, and how time grows with unknowns.

Each model runs alone in a process of its own with one thread, twice a level, the second time timed; what a user put in
a model's place is not refined.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from benchmark.comparison import GridConvergence, grid_convergence
from benchmark.files import Scenario
from benchmark.models import ModelResult, WaveChoices
from benchmark.runs.options import Listener
from benchmark.side_by_side import Finished, ModelProcess, Seconds, SideBySide

MESHES = ("fine", "default", "coarse")
DIMENSIONS = 2
"""An axisymmetric mesh: the size of a cell goes with unknowns to the power -1/2."""
ORDER = {"mesh": 2.0, "modes": 2.0, "load steps": 1.0}
"""The most that is believed of an observed order, and what is assumed without one."""


@dataclass(frozen=True)
class Level:
    """One run: which model, what was refined, how far, in how long.

    `size` is the representative cell size in any unit, `used` whether it is the run's own setting.
    """

    model: str
    refined: str
    level: str
    size: float
    used: bool
    seconds: Seconds
    result: ModelResult


def refine(scenario: Scenario, pair: SideBySide, listener: Listener) -> tuple[Level, ...]:
    """Run each of our models that covers the scenario on coarser and finer levels.

    Raises
    ------
    InputError, SolverError
        See `ModelProcess.receive`; a level whose solver stops early is left out.
    """
    plan = [each for run in (pair.fem, pair.wave) if run.result is not None and run.own is None
            for each in _levels(run.model, scenario, run.result)]  # fmt: skip
    found = []
    with listener.progress(f"{scenario.name}: coarser and finer") as advance:
        for number, (model, refined, level, used, changed) in enumerate(plan, start=1):
            with ModelProcess(model, changed) as process:
                process.command(keep_result=True)
                answer = process.answer()
                process.command(keep_result=False)
                timed = process.answer()
            advance(model, number, len(plan), f"{refined} {level}")
            if not isinstance(answer, Finished) or not isinstance(timed, Finished):
                continue
            if answer.result is not None and answer.result.complete:
                size = _size(refined, level, answer.result)
                found.append(Level(model, refined, level, size, used, timed.seconds, answer.result))
    return tuple(found)


def _levels(model: str, scenario: Scenario, result: ModelResult) -> Iterator[tuple[str, str, str, bool, Scenario]]:
    """Model, what is refined, level, whether it is the scenario's own, and the scenario of each level."""
    if model == "fem":
        for mesh in MESHES:
            yield model, "mesh", mesh, mesh == scenario.fem.mesh, _changed(scenario, "fem", mesh=mesh)
    elif (modes := _modes(result)) is not None:
        for count in (2 * modes, modes, max(modes // 2, 1)):
            yield model, "modes", str(count), count == modes, _changed(scenario, "wave", modes=count)
    steps = scenario.load.observations
    if scenario.load.shape != "table" and steps is not None:
        for count in (2 * steps, steps):
            yield model, "load steps", str(count), count == steps, _changed(scenario, "load", observations=count)


def _changed(scenario: Scenario, section: str, **values: object) -> Scenario:
    part = getattr(scenario, section).model_copy(update=values)
    return scenario.model_copy(update={section: part})


def _modes(result: ModelResult) -> int | None:
    """N of a wave model's modes m, n = 1..N; None for a model without."""
    return result.choices.plane_modes if isinstance(result.choices, WaveChoices) else None


def _size(refined: str, level: str, result: ModelResult) -> float:
    if refined == "mesh":
        return float((result.unknowns or 1) ** (-1.0 / DIMENSIONS))
    return 1.0 / int(level)


def convergence(levels: tuple[Level, ...], model: str, refined: str, layer: int) -> GridConvergence | None:
    """What a series tells of the largest deflection (m) of a layer at the run's own setting; None without a series."""
    series = sorted((each for each in levels if (each.model, each.refined) == (model, refined)), key=lambda e: e.size)
    used = [place for place, each in enumerate(series) if each.used]
    if len(series) < 2 or not used:
        return None
    values = [float(each.result.max_deformation()[layer]) for each in series]
    return grid_convergence(values, [each.size for each in series], used[0], ORDER[refined])
