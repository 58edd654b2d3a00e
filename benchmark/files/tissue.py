"""The tissue file: layers from the surface down, with their source."""

from __future__ import annotations

import math
from collections import Counter
from typing import Annotated, Self

from pydantic import Field, model_validator

from benchmark.files.base import FileModel, Name, Schema
from benchmark.files.laws import Fibre, Hyperelastic, NeoHookean, PronyTerm
from benchmark.files.quantities import Bounds, Density, Force, Modulus, Number, Thickness, problem

PoissonRatio = Annotated[
    float,
    Number("0 to 0.49999 (at 0.5 the material has no finite bulk modulus)", Bounds(0.0, 0.49999)),
]


class Layer(FileModel):
    """One layer.

    Attributes
    ----------
    name : str
        Unique in the tissue; `--set NAME.key=...` addresses it.
    thickness : float
        m; infinite where the file leaves it out, which the last layer of a half-space may.
    density : float
        kg/m^3.
    youngs_modulus : float
        Initial (instantaneous) Young's modulus, Pa.
    poisson_ratio : float
        Below 0.5.
    hyperelastic : law of `benchmark.files.laws`
        Finite-strain law; neo-Hookean from the moduli by default.
    relaxation : tuple of PronyTerm
        Fading parts of the stiffness, empty for an elastic layer.
    fibre : Fibre or None
        Fibre family added to the law.
    """

    name: Name
    thickness: Thickness = math.inf
    density: Density
    youngs_modulus: Modulus
    poisson_ratio: PoissonRatio
    hyperelastic: Hyperelastic = NeoHookean()
    relaxation: Annotated[tuple[PronyTerm, ...], Field(max_length=10)] = ()
    fibre: Fibre | None = None

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus E / (2 (1 + nu)) in Pa."""
        return self.youngs_modulus / (2 * (1 + self.poisson_ratio))

    @model_validator(mode="after")
    def _something_stays(self) -> Self:
        total = sum(term.g for term in self.relaxation)
        if total >= 1:
            raise problem(f"the fractions g add up to {total:.6g}; their sum must stay below 1", key="relaxation")
        if len({term.tau for term in self.relaxation}) < len(self.relaxation):
            raise problem("two terms share one time constant tau; each must be different", key="relaxation")
        return self


class Tissue(FileModel):
    """A layered tissue.

    Attributes
    ----------
    name : str
        Any printable text; escape it where it is shown.
    citation : str
        Where the values come from; empty where the file does not say.
    layers : tuple of Layer
        From the surface down.
    max_force : float or None
        The largest press, N, that the sources cover.
    """

    schema_: Annotated[Schema, Field(alias="schema")] = 1
    name: Name
    citation: str = ""
    max_force: Force | None = None
    layers: Annotated[tuple[Layer, ...], Field(min_length=1, max_length=100)]

    @property
    def layer_names(self) -> tuple[str, ...]:
        """The layers' names from the surface down."""
        return tuple(layer.name for layer in self.layers)

    @property
    def thickness(self) -> float:
        """Total thickness in m; infinite where the last layer is endless."""
        return sum(layer.thickness for layer in self.layers)

    def layer(self, name: str) -> Layer:
        """The layer of that name; KeyError where there is none."""
        return {layer.name: layer for layer in self.layers}[name]

    def with_layer(self, name: str, **changes: object) -> Tissue:
        """A copy in which one layer's fields (SI values) are replaced, checked like a new one.

        Raises
        ------
        pydantic.ValidationError
            When a value lies outside its bounds.
        """
        changed = Layer(**{**dict(self.layer(name)), **changes})
        layers = tuple(changed if layer.name == name else layer for layer in self.layers)
        return self.model_copy(update={"layers": layers})

    @model_validator(mode="after")
    def _layers_fit(self) -> Self:
        name, times = Counter(self.layer_names).most_common(1)[0]
        if times > 1:
            raise problem(f"{times} layers are named {name!r}; each layer needs its own name", key="layers")
        for index, layer in enumerate(self.layers[:-1]):
            if math.isinf(layer.thickness):
                raise problem(
                    f"the layer {layer.name!r} has no thickness; only the last layer of a half-space may leave it out",
                    key=f"layers.{index}.thickness",
                )
        return self
