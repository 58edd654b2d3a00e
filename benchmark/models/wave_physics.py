"""The options of the body in a scenario in the wave's terms."""

from __future__ import annotations

import math

from benchmark.files import Scenario
from benchmark.models.result import UncoveredError
from wavemodel import ShearLimit
from wavemodel.physics import (
    Adhesion,
    DryFriction,
    Floor,
    InterfaceSlip,
    PermanentSet,
    Physics,
    PoroelasticDrainage,
    StrainStiffening,
    StressSoftening,
    ViscousDamping,
)

STIFF_FLOOR = 1e6
"""N/m of a floor whose stiffness is not given."""
OPTIONS = (
    "adhesion_force",
    "floor_depth",
    "floor_stiffness",
    "friction_force",
    "friction_length",
    "damping_time",
    "softening",
    "softening_width",
    "permanent_set",
    "permanent_set_onset",
    "stiffening_linear",
    "stiffening_quadratic",
    "drainage_share",
    "drainage_diffusivity",
    "slip_force",
    "slip_share",
)
"""What acts on top of the elastic law of any wave; pretension is part of the wave itself."""


SHEAR_LIMIT = "interface_shear_limit"
"""Of the layered wave only."""


def given(scenario: Scenario) -> tuple[str, ...]:
    """Which of the options the scenario has."""
    return tuple(name for name in (SHEAR_LIMIT, *OPTIONS) if getattr(scenario.physics, name) is not None)


def wave_physics(scenario: Scenario) -> Physics | None:
    """Return the options on top of a wave's elastic law; None where the scenario has none.

    Raises
    ------
    wavemodel.WaveError
        For a value that the wave does not take.
    """
    if not set(given(scenario)) - {SHEAR_LIMIT}:
        return None
    body = scenario.physics
    return Physics(
        stiffening=_stiffening(scenario),
        floor=None if body.floor_depth is None else Floor(body.floor_depth, body.floor_stiffness or STIFF_FLOOR),
        slip=None
        if body.slip_force is None or body.slip_share is None
        else InterfaceSlip(body.slip_force, body.slip_share),
        softening=None if body.softening is None else StressSoftening(body.softening, body.softening_width or 0.5),
        permanent_set=None
        if body.permanent_set is None
        else PermanentSet(body.permanent_set, body.permanent_set_onset or 0.0),
        drainage=None
        if body.drainage_share is None or body.drainage_diffusivity is None
        else PoroelasticDrainage(body.drainage_share, body.drainage_diffusivity, scenario.tool.radius),
        damping=None if body.damping_time is None else ViscousDamping(body.damping_time),
        friction=None
        if body.friction_force is None or body.friction_length is None
        else DryFriction(body.friction_force, body.friction_length),
        adhesion=None if body.adhesion_force is None else Adhesion(body.adhesion_force),
    )


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


def _stiffening(scenario: Scenario) -> StrainStiffening | None:
    linear, quadratic = scenario.physics.stiffening_linear, scenario.physics.stiffening_quadratic
    if linear is None and quadratic is None:
        return None
    thickness = math.fsum(layer.thickness for layer in scenario.tissue.layers)
    return StrainStiffening(linear or 0.0, quadratic or 0.0, thickness)
