"""What models of this version leave out: refused, because it would change the answer."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from typing import Any

import numpy as np

from benchmark.files import Layer, Scenario
from benchmark.files.tool import Support
from benchmark.models.model_result import UncoveredError
from benchmark.models.solver_layers import wave_layers
from benchmark.physics import Effect, TrialContext, option_effects
from wavemodel import ShearLimit, WaveLayer
from wavemodel.physics import Physics

FRICTION = "friction_coefficient"
"""Belongs to a rigid_frictional tool, which each model refuses by itself, and has no effect on any other."""

HALF_SPACE_RADII = 4.0
"""Height of a half-space to effects that measure a depth by it, in radii of the tool, which is its only length."""
REASONS = {
    "interface_shear_limit": "the layered wave on a base and the finite elements have it",
    "clamp_shear_limit": "only the finite elements have it, for a hole in axial symmetry",
}
"""Why an option is in no model."""


def refuse_options(scenario: Scenario, has: Collection[str] = ()) -> None:
    """Refuse what a model does not have.

    Parameters
    ----------
    scenario
        Resolved scenario.
    has
        Options of the body that the model has.

    Raises
    ------
    UncoveredError
        For options of the body.
    """
    given = [name for name, value in dict(scenario.physics).items() if value is not None]
    lacking = [name for name in given if name not in (FRICTION, *has)]
    if lacking:
        reason = REASONS.get(lacking[0], f"it has {', '.join(has) or 'none'}")
        raise UncoveredError(f"the option physics.{lacking[0]} is not part of this model: {reason}")


def refuse_solid(scenario: Scenario) -> None:
    """Refuse what only a three-dimensional model has.

    Raises
    ------
    UncoveredError
        For a body from a surface file, a tilted tool, or an off-centre tool over a hole.
    """
    if scenario.fem.geometry == "surface":
        raise UncoveredError("a body from a surface file has no plane layers")
    if scenario.tool.tilt != 0.0:
        raise UncoveredError("a tilted tool is part of the three-dimensional finite elements only")
    if scenario.support.kind == "hole" and scenario.tool.position != (0.0, 0.0):
        raise UncoveredError("the tool stands off the centre of the hole")


def relaxation_warnings(scenario: Scenario) -> tuple[str, ...]:
    """Say which layers of a sheet relax in their file, each in its own way, and are elastic here."""
    names = [layer.name for layer in scenario.tissue.layers if layer.relaxation]
    if not names:
        return ()
    return (f"relaxation of {', '.join(names)} is left out: over a hole the wave needs one series for all layers",)


Given = tuple[Effect, Mapping[str, float]]
"""An effect with those of its parameters and options that a scenario gives, SI."""
SHEAR_LIMIT = "interface_shear_limit"
"""Of the layered wave only; it changes the elastic law, the other options act on top of it."""


def given_effects(scenario: Scenario) -> tuple[Given, ...]:
    """The effects that the scenario states, in the order of the catalogue."""
    found = []
    for effect in option_effects():
        stated = {each.name: getattr(scenario.physics, key) for key, each in effect.description.keys.items()}
        values = {name: value for name, value in stated.items() if value is not None}
        if values:
            found.append((effect, values))
    return tuple(found)


def scenario_context(scenario: Scenario) -> TrialContext:
    """What an effect may know of a scenario."""
    layers = specimen_layers(scenario.tissue.layers)
    thickness = math.fsum(layer.thickness for layer in layers)
    history, control = scenario.load_history(), scenario.load.control
    peak = float(np.abs(history.value).max())
    return TrialContext(
        tool_radius=scenario.tool.radius,
        thickness=measured_height(thickness, scenario.support, scenario.tool.radius),
        peak_depth=0.1 * thickness if control == "force" else peak,
        peak_force=peak,
        duration=float(history.time[-1]),
        hole_radius=open_radius(scenario.support),
        layers=layers,
        contact=scenario.tool.contact,
        edge_radius=scenario.tool.edge_radius or 0.0,
        control=control,
    )


def specimen_layers(layers: Iterable[Layer]) -> tuple[WaveLayer, ...]:
    """The layers of a specimen as effects know them, without an endless base."""
    return tuple(wave_layers((layer for layer in layers if math.isfinite(layer.thickness)), laws=False))


def measured_height(thickness: float, support: Support, tool_radius: float) -> float:
    """Height in m by which effects measure a depth: the specimen's; a half-space has none but that of the tool."""
    endless = support.kind == "half_space" or not math.isfinite(thickness)
    return HALF_SPACE_RADII * tool_radius if endless else thickness


def open_radius(support: Support) -> float:
    """Radius in m of the hole below a specimen; infinite without one."""
    return (support.hole_radius or math.inf) if support.kind == "hole" else math.inf


def keys_on_top() -> tuple[str, ...]:
    """Keys of `[physics]` that act on top of the elastic law of any wave."""
    effects = (effect for effect in option_effects() if effect.body is not None)
    return tuple(p.key for e in effects for p in e.description.parameters if p.key and p.name not in e.native_in_wave)


def given_in_wave(scenario: Scenario) -> tuple[str, ...]:
    """Keys of `[physics]` that change a wave's elastic law or act on top of it; pretension is part of the wave."""
    return tuple(name for name in (SHEAR_LIMIT, *keys_on_top()) if getattr(scenario.physics, name) is not None)


def wave_physics(scenario: Scenario) -> Physics | None:
    """Return the options on top of a wave's elastic law; None where the scenario has none.

    Raises
    ------
    wavemodel.WaveError
        For a value that the wave does not take.
    """
    context = scenario_context(scenario)
    options: dict[str, Any] = {}
    for effect, given in given_effects(scenario):
        own = {p.name for p in effect.description.parameters} - set(effect.native_in_wave)
        if effect.body is not None and own & set(given):
            options |= effect.body(_whole(effect, given), context)
    return Physics(**options) if options else None


def _whole(effect: Effect, given: Mapping[str, float]) -> dict[str, float]:
    """A value for every parameter: what is not given is at its default, or does nothing."""
    values = {}
    for parameter in effect.description.parameters:
        default = None if parameter.option is None else parameter.option.default
        values[parameter.name] = given.get(parameter.name, parameter.start[0] if default is None else default)
    return values


def wave_slip(scenario: Scenario) -> ShearLimit | None:
    """Return the shear stress at which layers begin to slide; None where they are bonded for good.

    Raises
    ------
    UncoveredError
        If all of them slide from the start.
    """
    limit = scenario.physics.interface_shear_limit
    if limit == 0.0:
        raise UncoveredError(
            "the option physics.interface_shear_limit = 0 Pa is not part of this model: it lets one interface slide, "
            "the one that comes to a limit above 0 first"
        )
    return None if limit is None else ShearLimit(limit)
