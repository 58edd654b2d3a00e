"""A scenario in the finite-element solver's terms: layers and laws, tool, support, and the effects it carries."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import fem
from benchmark.files import Scenario
from benchmark.models.model_result import UncoveredError
from benchmark.models.scenario_effects import Given, given_effects, scenario_context
from benchmark.models.solver_layers import fem_layer
from benchmark.physics import NotInFemError, option_effects


def refuse_contact(scenario: Scenario) -> None:
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
            max(tool.radius, scenario.support.specimen_radius or 0.0),
            tool.contact,
            tool.edge_radius,
            position,
            tool.tilt,
            scenario.physics.friction_coefficient,
        ),
        support=fem.Support(
            "plates" if scenario.support.cylinder else scenario.support.kind,
            scenario.support.hole_radius if scenario.support.kind == "hole" else None,
            clamp=scenario.support.clamp,
            specimen_radius=scenario.support.specimen_radius,
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
