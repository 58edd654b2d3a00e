"""What the waves of the harness share: their face and picture, a scenario's tool, relaxation, laws, fibres."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from benchmark.files import Scenario
from benchmark.models.model_result import Array, Drive, Picture, UncoveredError, WaveChoices
from wavemodel import DiscTool, Prony

VERTICES = 81
REACH = 4.0
"""Pictures are squares of 81 x 81 vertices, four tool radii to each side of the axis, or to the model's border."""


class Solution(Protocol):
    """What a run of a wave gives back (n steps, L layers; SI, press positive)."""

    @property
    def time(self) -> Array:
        """(n,) s."""
        ...

    @property
    def force(self) -> Array:
        """(n,) N."""
        ...

    @property
    def depth(self) -> Array:
        """(n,) m."""
        ...

    @property
    def layer_names(self) -> tuple[str, ...]:
        """L names from the surface down."""
        ...

    @property
    def top_deflection(self) -> Array:
        """(n, L) m."""
        ...

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader must know."""
        ...

    def warned(self, warning: str) -> Solution:
        """The same with one more warning."""
        ...

    def profile(self, step: int, radii: Array) -> Array:
        """(L, m) m, NaN outside the model's domain."""
        ...


@dataclass(frozen=True)
class PreparedWave:
    """A wave after its set-up.

    Attributes
    ----------
    follow
        Load history to solution; raises `wavemodel.WaveError` beyond the model's range.
    unknowns
        Of the model.
    choices
        What was chosen.
    warnings
        What is left out, one sentence each.
    picture
        Load history to what draws the faces at its peak, raises as `follow`; None for a wave without such tables.
    """

    follow: Callable[[Drive], Solution]
    unknowns: int
    choices: WaveChoices
    warnings: tuple[str, ...] = ()
    picture: Callable[[Drive], Picture] | None = None


def wave_tool(scenario: Scenario) -> DiscTool:
    """The tool; its edge counts at finite strain, where tissue slides over it."""
    tool = scenario.tool
    edge = tool.edge_radius if scenario.fem.kinematics == "finite" else None
    friction = scenario.physics.friction_coefficient if tool.contact == "rigid_frictional" else None
    return DiscTool(tool.radius, tool.contact, edge or 0.0, friction or 0.0)


def wave_relaxation(scenario: Scenario) -> list[Prony | None] | None:
    """A series a layer; None where all layers are elastic."""
    series = [
        Prony(tuple(term.g for term in layer.relaxation), tuple(term.tau for term in layer.relaxation))
        if layer.relaxation
        else None
        for layer in scenario.tissue.layers
    ]
    return series if any(series) else None


def refuse_fibres(scenario: Scenario, *, finite: bool = True) -> None:
    """Refuse fibres that a wave cannot follow.

    Parameters
    ----------
    scenario
        Resolved scenario.
    finite
        Whether the wave follows the layers' finite strain; else it has no fibres at all.

    Raises
    ------
    UncoveredError
        Naming the layer.
    """
    for layer in scenario.tissue.layers:
        if layer.fibre is None:
            continue
        if not finite:
            raise UncoveredError(
                f"the layer {layer.name} has fibres, which a wave of small strain or of the plate theory does not have"
            )
        if layer.fibre.directed:
            raise UncoveredError(
                f"the layer {layer.name} has fibres in one direction, which breaks the wave's axial symmetry: leave "
                "the angle out (fibres spread evenly over the plane)"
            )


def law_warnings(scenario: Scenario) -> tuple[str, ...]:
    """Say which layers have another law than the neo-Hookean one of a sheet by the plate theory."""
    return tuple(
        f"the wave takes the layer {layer.name} for neo-Hookean with the initial modulus of "
        f"its {layer.hyperelastic.law} law"
        for layer in scenario.tissue.layers
        if layer.hyperelastic.law != "neo_hookean"
    )


def vertices(tool_radius: float, border: float) -> Array:
    """Positions (P,) of a picture's vertices along one side, m from the tool axis, none beyond the border, m."""
    reach = min(REACH * tool_radius, border)
    return np.linspace(-reach, reach, VERTICES)
