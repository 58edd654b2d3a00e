"""What the waves of the harness share: their face, and a scenario's layers, tool and relaxation in their terms."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

from benchmark.files import Layer, Scenario
from benchmark.models.model_result import Array, Drive, Picture, WaveChoices
from wavemodel import DiscTool, Prony, WaveLayer


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


def wave_layers(layers: Iterable[Layer]) -> list[WaveLayer]:
    """Layers with the initial moduli of their laws."""
    return [
        WaveLayer(layer.name, layer.thickness, layer.density, initial_modulus(layer), layer.poisson_ratio)
        for layer in layers
    ]


def initial_modulus(layer: Layer) -> float:
    """Initial Young's modulus of the layer's law, Pa: what its finite elements begin with."""
    shear = layer.hyperelastic.shear_modulus
    return layer.youngs_modulus if shear is None else 2.0 * shear * (1.0 + layer.poisson_ratio)


def wave_tool(scenario: Scenario) -> DiscTool:
    """The tool."""
    return DiscTool(scenario.tool.radius, scenario.tool.contact)


def wave_relaxation(scenario: Scenario) -> list[Prony | None] | None:
    """A series a layer; None where all layers are elastic."""
    series = [
        Prony(tuple(term.g for term in layer.relaxation), tuple(term.tau for term in layer.relaxation))
        if layer.relaxation
        else None
        for layer in scenario.tissue.layers
    ]
    return series if any(series) else None


def law_warnings(scenario: Scenario) -> tuple[str, ...]:
    """Say which layers have another law than the neo-Hookean one of a wave in finite strain."""
    return tuple(
        f"the wave takes the layer {layer.name} for neo-Hookean with the initial modulus of "
        f"its {layer.hyperelastic.law} law"
        for layer in scenario.tissue.layers
        if layer.hyperelastic.law != "neo_hookean"
    )
