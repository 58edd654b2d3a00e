"""What models of this version leave out: refused, because it would change the answer."""

from __future__ import annotations

from collections.abc import Collection

from benchmark.files import Scenario
from benchmark.models.result import UncoveredError

FRICTION = "friction_coefficient"
"""Belongs to a rigid_frictional tool, which each model refuses by itself, and has no effect on any other."""

REASONS = {
    "interface_shear_limit": "the layered wave on a base and the finite elements have it",
    "clamp_shear_limit": "only the finite elements have it, for a hole in axial symmetry",
}
"""Why an option is in no model."""


def refuse_options(scenario: Scenario, has: Collection[str] = (), fibres: bool = False) -> None:
    """Refuse what a model does not have.

    Parameters
    ----------
    scenario
        Resolved scenario.
    has
        Options of the body that the model has.
    fibres
        Whether it has fibres.

    Raises
    ------
    UncoveredError
        For options of the body, or fibres.
    """
    given = [name for name, value in dict(scenario.physics).items() if value is not None]
    lacking = [name for name in given if name not in (FRICTION, *has)]
    if lacking:
        reason = REASONS.get(lacking[0], f"it has {', '.join(has) or 'none'}")
        raise UncoveredError(f"the option physics.{lacking[0]} is not part of this model: {reason}")
    names = [layer.name for layer in scenario.tissue.layers if layer.fibre is not None]
    if names and not fibres:
        raise UncoveredError(f"the layer {names[0]} has fibres, which this model does not have")


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
