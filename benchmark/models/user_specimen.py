"""What the functions of a user's model get: plain values in SI units, nothing of this program needed to read them."""

from __future__ import annotations

from dataclasses import dataclass

from benchmark.files import Scenario
from benchmark.models.result import UncoveredError


@dataclass(frozen=True)
class UserLayer:
    """One layer.

    Attributes
    ----------
    name : str
    thickness : float
        m; infinite for the last layer of a half-space.
    density : float
        kg/m^3.
    youngs_modulus : float
        Initial Young's modulus, Pa.
    poisson_ratio : float
    relaxation : tuple of (g, tau)
        Fading fractions of the stiffness with their time constants in s; empty for an elastic layer.
    """

    name: str
    thickness: float
    density: float
    youngs_modulus: float
    poisson_ratio: float
    relaxation: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class UserTool:
    """A round flat tool: `radius` in m, `contact` as in a scenario, `edge_radius` in m or None for a sharp edge."""

    radius: float
    contact: str
    edge_radius: float | None


@dataclass(frozen=True)
class UserSupport:
    """What holds the lower face: `kind` (bonded, hole, half_space) and, of a hole, `hole_radius` in m."""

    kind: str
    hole_radius: float | None


FRICTION = "friction_coefficient"
"""Belongs to a rigid_frictional tool; the contact's name says that there is friction."""

Specimen = tuple[tuple[UserLayer, ...], UserTool, UserSupport]


def specimen_of(scenario: Scenario) -> Specimen:
    """Layers from the surface down, tool and support of a scenario.

    Raises
    ------
    UncoveredError
        The scenario has an option of the body, a tilted tool or fibres, which the functions are not told of.
    """
    options = [name for name, value in dict(scenario.physics).items() if value is not None and name != FRICTION]
    untold = [f"physics.{name}" for name in options]
    untold += ["tool.tilt"] if scenario.tool.tilt != 0.0 else []
    untold += [f"the fibres of {layer.name}" for layer in scenario.tissue.layers if layer.fibre is not None]
    if untold:
        raise UncoveredError(f"a user's model is not told of {', '.join(untold)}")
    layers = tuple(
        UserLayer(
            name=layer.name,
            thickness=layer.thickness,
            density=layer.density,
            youngs_modulus=layer.youngs_modulus,
            poisson_ratio=layer.poisson_ratio,
            relaxation=tuple((term.g, term.tau) for term in layer.relaxation),
        )
        for layer in scenario.tissue.layers
    )
    tool, support = scenario.tool, scenario.support
    hole = support.hole_radius if support.kind == "hole" else None
    return layers, UserTool(tool.radius, tool.contact, tool.edge_radius), UserSupport(support.kind, hole)
