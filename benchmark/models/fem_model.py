"""The finite-element solver as a model of the harness."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

import fem
from benchmark.errors import InputError
from benchmark.files import Scenario
from benchmark.models.coverage import refuse_options
from benchmark.models.fem_layers import fem_layer
from benchmark.models.keeping import Keeping
from benchmark.models.kept_steps import kept_mesh, kept_steps
from benchmark.models.radii import profile_radii
from benchmark.models.result import (
    Drive,
    FieldSnapshot,
    LastState,
    ModelResult,
    OnStep,
    Reading,
    Resumption,
    RunFailure,
    StepProgress,
    UncoveredError,
    silent,
)
from benchmark.models.scenario_effects import Given, given_effects, scenario_context
from benchmark.models.wider_edge import follow_deeper
from benchmark.physics import NotInFemError, option_effects
from fem.analysis.prepared import Model


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
        added: tuple[Given, ...] = (),
    ):
        refuse_options(scenario, carried_keys(), fibres=True)
        self._scenario = scenario
        self._every_field = every_field
        self._keeping = keeping
        _refuse_contact(scenario)
        try:
            slow = scenario.fem.geometry == "surface"
            mesh_file = kept_mesh(keeping) if keeping is not None and slow else None
            self.carried = with_added_effects(with_stated_effects(scenario), added, scenario)
            self._model = fem.prepare(self.carried.problem, mesh_file=mesh_file)
        except fem.FemError as error:
            raise InputError(f"scenario {scenario.name}: {error}") from None

    def run(self, drive: Drive, on_step: OnStep = silent) -> ModelResult:
        """Follow a load history and read everything off it."""
        return self.follow(drive, on_step)()

    def follow(self, drive: Drive, on_step: OnStep = silent) -> Reading:
        """Follow a load history; a run that stops early keeps what it reached."""
        load = fem.Load(drive.control, drive.time, drive.value)

        def report(step: fem.StepReport) -> None:
            on_step(StepProgress(step.step, step.total, step.force, step.depth))

        def run(model: Model, edge: float) -> fem.Solution:
            kept = None if self._keeping is None else kept_steps(self._keeping, model, load, edge)
            return model.run(load, on_step=report, checkpoint=kept)

        model, solution = follow_deeper(self._model, run)
        return lambda: self._result(model, solution, load, drive)

    def _result(self, model: Model, solution: fem.Solution, load: fem.Load, drive: Drive) -> ModelResult:
        """The solution in the harness's terms, with its profile and fields."""
        steps = solution.force.size
        peak = int(np.abs(drive.value[:steps]).argmax()) if steps else 0
        radii = profile_radii(self._scenario.tool.radius)
        layers = solution.layer_names
        return ModelResult(
            model="fem",
            layers=tuple(layers),
            time=solution.time,
            force=solution.force,
            depth=solution.depth,
            top_deflection=solution.top_deflection,
            profile_radii=radii,
            profile=solution.profile(peak, radii) if steps else np.full((len(layers), radii.size), np.nan),
            peak_step=peak,
            unknowns=model.unknowns,
            notes=self._notes(model),
            warnings=(*self.carried.remarks, *solution.warnings),
            resumed=_resumption(solution, load),
            failure=_failure(solution, load),
            last=_last(solution),
            fields=tuple(_snapshot(solution, step) for step in self._field_steps(peak, steps)),
        )

    def _notes(self, model: Model) -> dict[str, str]:
        """Choices of the solver, in words."""
        options, edge = self._scenario.fem, model.problem.discretisation.edge
        return {
            "kinematics": "finite strain" if options.kinematics == "finite" else "small strain",
            "geometry": options.geometry,
            "mesh": options.mesh + ("" if edge == 1.0 else f", elements at the tool's edge {edge:g} times larger"),
            "linear solver": str(model.linear_solver),
        }

    def _field_steps(self, peak: int, steps: int) -> list[int]:
        """Steps whose fields are kept."""
        if not steps:
            return []
        return list(range(steps)) if self._every_field else sorted({peak, steps - 1})


def _refuse_contact(scenario: Scenario) -> None:
    """Refuse contacts that this solver does not have."""
    tool, finite = scenario.tool, scenario.fem.kinematics == "finite"
    touches = tool.contact in ("rigid_frictionless", "rigid_frictional")
    if tool.contact == "rigid_frictional" and not finite:
        raise UncoveredError("the contact rigid_frictional is part of finite strain only")
    if touches and finite and scenario.fem.geometry == "surface":
        raise UncoveredError(f"a {tool.contact} tool that touches is not part of the geometry surface")
    if tool.contact == "rigid_bonded" and tool.edge_radius is not None:
        raise UncoveredError("a rigid_bonded tool with a rounded edge is not part of this solver; a sharp edge is")


def carried_keys() -> tuple[str, ...]:
    """Keys of `[physics]` that the FEM carries by itself."""
    return tuple(
        key
        for effect in option_effects()
        for key, parameter in effect.description.keys.items()
        if effect.fem is not None and parameter.name in effect.fem.names
    )


@dataclass(frozen=True)
class FemProblem:
    """A problem with the effects that the FEM carries by itself.

    Attributes
    ----------
    problem
        In the solver's terms.
    remarks
        What a reader must know of how they are carried.
    carried
        Slugs of the effects that are in it.
    on_top
        Effects of a model file that are not, each with the reason.
    """

    problem: fem.Problem
    remarks: tuple[str, ...] = ()
    carried: tuple[str, ...] = ()
    on_top: tuple[tuple[Given, str], ...] = ()


def problem_of(scenario: Scenario) -> fem.Problem:
    """The scenario in the solver's terms, with the effects that it states."""
    return with_stated_effects(scenario).problem


def _without_effects(scenario: Scenario) -> fem.Problem:
    """The scenario in the solver's terms.

    A laterally endless specimen is the same everywhere, so that its axisymmetric model needs no position.
    """
    tool, options = scenario.tool, scenario.fem
    centred = options.geometry == "axisymmetric" and scenario.support.kind != "hole"
    position = (0.0, 0.0) if centred else tool.position
    surface = None
    if options.surface is not None and options.surface_unit is not None:
        surface = fem.read_surface(options.surface, options.surface_unit)
    return fem.Problem(
        layers=tuple(fem_layer(layer, options.kinematics) for layer in scenario.tissue.layers),
        tool=fem.Tool(
            tool.radius,
            tool.contact,
            tool.edge_radius,
            position,
            tool.tilt,
            scenario.physics.friction_coefficient,
        ),
        support=fem.Support(
            scenario.support.kind,
            scenario.support.hole_radius if scenario.support.kind == "hole" else None,
        ),
        kinematics=options.kinematics,
        discretisation=fem.Discretisation(options.mesh, options.radius),
        geometry=options.geometry,
        surface=surface,
    )


def with_stated_effects(scenario: Scenario) -> FemProblem:
    """The scenario's problem with what its `[physics]` states; raises UncoveredError for a term the FEM lacks."""
    found = _carry(FemProblem(_without_effects(scenario)), given_effects(scenario), scenario)
    for given, reason in found.on_top:
        if _has_term(given):
            raise UncoveredError(reason)
    return replace(found, on_top=())


def with_added_effects(stated: FemProblem, added: Iterable[Given], scenario: Scenario) -> FemProblem:
    """A problem with further effects where the FEM carries them; those that it does not are `on_top`.

    What acts on top needs an elastic answer below it: effects with a memory are in the FEM all or none.
    """
    effects = tuple(added)
    elastic = _carry(stated, [each for each in effects if not _remembers(each)], scenario)
    remembering = [each for each in effects if _remembers(each)]
    whole = elastic if elastic.on_top else _carry(elastic, remembering, scenario)
    if not whole.on_top or not remembering:
        return whole
    first = whole.on_top[0][0][0].slug
    beside = f"it has a memory, and {first} acts on top of the FEM's elastic answer"
    reasons = {effect.slug: reason for (effect, _), reason in whole.on_top}
    return replace(
        elastic, on_top=(*elastic.on_top, *((each, reasons.get(each[0].slug, beside)) for each in remembering))
    )


def _has_term(given: Given) -> bool:
    effect, values = given
    return effect.fem is not None and bool(set(effect.fem.names) & set(values))


def _remembers(given: Given) -> bool:
    return given[0].fem is not None and not given[0].fem.elastic


def _carry(found: FemProblem, effects: Iterable[Given], scenario: Scenario) -> FemProblem:
    """The problem with one effect after the other; an effect that the FEM does not carry is left on top."""
    context = scenario_context(scenario)
    for effect, values in effects:
        if effect.fem is None or not _has_term((effect, values)):
            found = replace(found, on_top=(*found.on_top, ((effect, values), "the FEM has no such term")))
            continue
        try:
            problem, remark = effect.fem.change(values, found.problem, context)
        except NotInFemError as error:
            found = replace(found, on_top=(*found.on_top, ((effect, values), str(error))))
            continue
        remarks = (*found.remarks, remark) if remark else found.remarks
        found = replace(found, problem=problem, remarks=remarks, carried=(*found.carried, effect.slug))
    return found


def _resumption(solution: fem.Solution, load: fem.Load) -> Resumption | None:
    """What an earlier run had done already, in the harness's terms."""
    earlier = solution.resumed
    return None if earlier is None else Resumption(earlier.steps, load.time.size, earlier.seconds)


def _failure(solution: fem.Solution, load: fem.Load) -> RunFailure | None:
    """The solver's failure in the harness's terms."""
    stop = solution.failure
    if stop is None:
        return None
    return RunFailure(stop.step, stop.time, stop.reached, stop.target, load.unit, stop.reason)


def _last(solution: fem.Solution) -> LastState | None:
    """The last state of equilibrium of a run that stopped early, at a step or between two; None if that is rest."""
    found = solution if solution.last is None else solution.last
    if solution.failure is None or not found.time.size:
        return None
    row = found.time.size - 1
    return LastState(
        time=float(found.time[row]),
        force=float(found.force[row]),
        depth=float(found.depth[row]),
        top_deflection=found.top_deflection[row],
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
