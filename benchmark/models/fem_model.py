"""The finite-element solver as a model of the harness."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import fem
from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.models.fem_problem import carried_keys, refuse_contact, with_added_effects, with_stated_effects
from benchmark.models.fem_steps import follow_deeper, kept_mesh, kept_steps
from benchmark.models.model_result import (
    Drive,
    FemChoices,
    FieldSnapshot,
    Keeping,
    LastState,
    ModelResult,
    OnStep,
    Reading,
    Resumption,
    RunFailure,
    StepProgress,
    profile_radii,
    silent,
)
from benchmark.models.scenario_effects import Given, refuse_options
from fem.analysis.prepared import Model

DISCRETISATION = "discretisation error"
UNITS = {"force": (1.0, "N"), "depth": (1e3, "mm")}


class FemModel:
    """A scenario meshed and set up.

    Parameters
    ----------
    scenario
        Resolved scenario.
    every_field
        Keep the fields of each step instead of the peak's and the last one's.
    keeping
        Where the steps of the one load history that is followed are kept, and taken up; None keeps nothing.
    judge_mesh
        Whether results tell the discretisation error of their mesh, which takes further solutions.
    beyond_limits
        Whether a press goes on over limit points, where its curve jumps.
    added
        Effects of a model file; those that the solver does not carry by itself are `carried.on_top`.

    Raises
    ------
    UncoveredError
        The solver has no answer to this scenario.
    InputError
        The scenario cannot be meshed or solved as it stands.
    """

    def __init__(
        self,
        scenario: Scenario,
        *,
        every_field: bool = False,
        keeping: Keeping | None = None,
        judge_mesh: bool = False,
        beyond_limits: bool = True,
        added: tuple[Given, ...] = (),
    ):
        refuse_options(scenario, carried_keys())
        self._scenario = scenario
        self._every_field = every_field
        self._keeping = keeping
        self._judge_mesh = judge_mesh
        refuse_contact(scenario)
        try:
            slow = scenario.fem.geometry == "surface"
            mesh_file = kept_mesh(keeping) if keeping is not None and slow else None
            self.carried = with_added_effects(with_stated_effects(scenario), added, scenario)
            model = fem.prepare(self.carried.problem, mesh_file=mesh_file)
        except fem.FemError as error:
            raise InputError(f"scenario {scenario.name}: {error}") from None
        self._model = model if beyond_limits else model.within_limits

    @property
    def prepared(self) -> Model:
        """The solver's own model."""
        return self._model

    def run(self, drive: Drive, on_step: OnStep = silent) -> ModelResult:
        """Follow a load history and read everything off it."""
        return self.follow(drive, on_step)()

    def follow(self, drive: Drive, on_step: OnStep = silent) -> Reading:
        """Follow a load history; a run that stops early keeps what it reached."""
        pull = self._scenario.support.pull
        load = fem.Load(drive.control, drive.time, pull * drive.value)

        def report(step: fem.StepReport) -> None:
            on_step(StepProgress(step.step, step.total, pull * step.force, pull * step.depth))

        def run(model: Model, edge: float) -> fem.Solution:
            kept = None if self._keeping is None else kept_steps(self._keeping, model, load, edge)
            return model.run(load, on_step=report, checkpoint=kept)

        model, solution = follow_deeper(self._model, run)
        return lambda: self._result(model, solution, load, drive)

    def _result(self, model: Model, solution: fem.Solution, load: fem.Load, drive: Drive) -> ModelResult:
        """The solution in the harness's terms, with its profile and fields; a pull counts as positive there."""
        pull = self._scenario.support.pull
        steps = solution.force.size
        peak = int(np.abs(drive.value[:steps]).argmax()) if steps else 0
        radii = profile_radii(self._scenario.tool.radius)
        layers, choices = solution.layer_names, self._choices(model)
        mesh_error = _turned(fem.estimate_mesh_error(model, load, solution) if self._judge_mesh else None, pull)
        return ModelResult(
            model="fem",
            layers=tuple(layers),
            time=solution.time,
            force=pull * solution.force,
            depth=pull * solution.depth,
            top_deflection=pull * solution.top_deflection,
            profile_radii=radii,
            profile=pull * solution.profile(peak, radii) if steps else np.full((len(layers), radii.size), np.nan),
            peak_step=peak,
            unknowns=model.unknowns,
            notes={**choices.notes(), **({DISCRETISATION: mesh_error_words(mesh_error)} if self._judge_mesh else {})},
            choices=choices,
            warnings=(*self.carried.remarks, *solution.warnings),
            resumed=_resumption(solution, load),
            failure=run_failure(solution, load, pull),
            last=_last(solution, pull),
            mesh_error=mesh_error,
            fields=tuple(_snapshot(solution, step) for step in self._field_steps(peak, steps)),
        )

    def _choices(self, model: Model) -> FemChoices:
        options, edge = self._scenario.fem, model.problem.discretisation.edge
        return FemChoices(options.kinematics, options.geometry, options.mesh, edge, str(model.linear_solver))

    def _field_steps(self, peak: int, steps: int) -> list[int]:
        """Steps whose fields are kept."""
        if not steps:
            return []
        return list(range(steps)) if self._every_field else sorted({peak, steps - 1})


def mesh_error_words(found: fem.MeshError | None) -> str:
    """The discretisation error of a mesh in a sentence."""
    if found is None:
        return (
            "not estimated: there is no like mesh with larger elements that follows the press, or on it other errors "
            "hide that of the edges"
        )
    prescribed = "force" if found.quantity == "depth" else "depth"
    (scale, unit), (load_scale, load_unit) = UNITS[found.quantity], UNITS[prescribed]
    side = "large" if found.percent > 0.0 else "small"
    return (
        f"{found.quantity} {scale * found.value:.5g} {unit} at {load_scale * found.load:.4g} {load_unit} is estimated "
        f"{abs(found.percent):.2g} % too {side} ({scale * found.extrapolated:.5g} {unit} in the limit of refinement)"
    )


def _resumption(solution: fem.Solution, load: fem.Load) -> Resumption | None:
    """What an earlier run had done already, in the harness's terms."""
    earlier = solution.resumed
    return None if earlier is None else Resumption(earlier.steps, load.time.size, earlier.seconds)


def _turned(found: fem.MeshError | None, pull: float) -> fem.MeshError | None:
    """An estimate with the signs of the harness."""
    if found is None or pull > 0.0:
        return found
    return replace(found, load=-found.load, value=-found.value, halved=-found.halved, error=-found.error)


def run_failure(solution: fem.Solution, load: fem.Load, pull: float = 1.0) -> RunFailure | None:
    """The solver's failure in the harness's terms."""
    stop = solution.failure
    if stop is None:
        return None
    return RunFailure(stop.step, stop.time, pull * stop.reached, pull * stop.target, load.unit, stop.reason)


def _last(solution: fem.Solution, pull: float) -> LastState | None:
    """The last state of equilibrium of a run that stopped early, at a step or between two; None if that is rest."""
    found = solution if solution.last is None else solution.last
    if solution.failure is None or not found.time.size:
        return None
    row = found.time.size - 1
    return LastState(
        time=float(found.time[row]),
        force=pull * float(found.force[row]),
        depth=pull * float(found.depth[row]),
        top_deflection=pull * found.top_deflection[row],
        field=_snapshot(found, row),
    )


def _snapshot(solution: fem.Solution, step: int) -> FieldSnapshot:
    """The continuum at one step."""
    fields = solution.fields(step)
    return FieldSnapshot(
        step=step,
        points=fields.points,
        cells=fields.cells,
        cell_type=fields.cell_type,
        point_data={"displacement_m": fields.displacement},
        cell_data={
            "layer": fields.layer.astype(np.float64),
            "cauchy_stress_Pa": fields.cauchy_stress.reshape(-1, 9),
            "strain": fields.strain.reshape(-1, 9),
            "det_F": fields.det_F,
        },
    )
