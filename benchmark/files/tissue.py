"""The tissue file: layers from the surface down with laws, relaxation and fibres; parameters and bounds, no mechanics.

Each law states its initial shear modulus, so that a file whose law and Young's modulus disagree can be told.
The volumetric part always follows the layer's Poisson ratio.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal, Self, TypeVar

from pydantic import BaseModel, Field, model_validator

from benchmark.files.quantities import (
    Angle,
    Bounds,
    Density,
    Duration,
    Force,
    Modulus,
    Number,
    Pressure,
    SignedModulus,
    Thickness,
    problem,
)
from benchmark.files.schema import FileModel, Name, Schema


class NeoHookean(FileModel):
    """W = c10 (I1 - 3); without `c10` it follows the layer's moduli."""

    law: Literal["neo_hookean"] = "neo_hookean"
    c10: Modulus | None = None

    @property
    def shear_modulus(self) -> float | None:
        """Initial shear modulus 2 c10 in Pa; None where the layer's moduli give it."""
        return None if self.c10 is None else 2 * self.c10


class MooneyRivlin(FileModel):
    """W = c10 (I1 - 3) + c01 (I2 - 3)."""

    law: Literal["mooney_rivlin"]
    c10: SignedModulus
    c01: SignedModulus

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus 2 (c10 + c01) in Pa."""
        return 2 * (self.c10 + self.c01)

    @model_validator(mode="after")
    def _stiff_at_rest(self) -> Self:
        _require_stiffness(self.shear_modulus)
        return self


class Yeoh(FileModel):
    """W = c10 (I1 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3."""

    law: Literal["yeoh"]
    c10: Modulus
    c20: SignedModulus = 0.0
    c30: SignedModulus = 0.0

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus 2 c10 in Pa."""
        return 2 * self.c10


LARGEST_EXPONENT = 1e3
"""Of Ogden's terms: at a stretch of 2 its power is the largest that a number can have."""


class OgdenTerm(FileModel):
    """One term mu / alpha (l1^alpha + l2^alpha + l3^alpha - 3) of Ogden's energy.

    Of constants for 2 mu / alpha^2 (Abaqus) `mu` here is 2 mu / alpha, of those for c / m^2 (FEBio) it is c / m.
    """

    mu: SignedModulus
    alpha: Annotated[float, Number("-1000 to 1000, and not 0", Bounds(-LARGEST_EXPONENT, LARGEST_EXPONENT))]

    @model_validator(mode="after")
    def _of_some_exponent(self) -> Self:
        if self.alpha == 0:
            raise problem("0 is outside what is allowed, -1000 to 1000, and not 0", key="alpha")
        return self


class Ogden(FileModel):
    """W = sum of mu_p / alpha_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3)."""

    law: Literal["ogden"]
    terms: Annotated[tuple[OgdenTerm, ...], Field(min_length=1, max_length=6)]

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus, half the sum of mu_p alpha_p, in Pa."""
        return sum(term.mu * term.alpha for term in self.terms) / 2

    @model_validator(mode="after")
    def _stiff_at_rest(self) -> Self:
        _require_stiffness(self.shear_modulus)
        return self


class Gent(FileModel):
    """W = -mu jm / 2 ln(1 - (I1 - 3) / jm), which locks at I1 = 3 + jm."""

    law: Literal["gent"]
    mu: Modulus
    jm: Annotated[float, Number("above 0, at most 1e6", Bounds(0.0, 1e6, above=True))]

    @property
    def shear_modulus(self) -> float:
        """Initial shear modulus mu in Pa."""
        return self.mu


Hyperelastic = Annotated[NeoHookean | MooneyRivlin | Yeoh | Ogden | Gent, Field(discriminator="law")]


class PronyTerm(FileModel):
    """One fading part of the stiffness: the fraction `g` relaxes with the time constant `tau` (s)."""

    g: Annotated[float, Number("above 0 and below 1", Bounds(0.0, 1.0 - 1e-9, above=True))]
    tau: Duration


ISOTROPIC = 1.0 / 3.0 - 1e-9
"""Dispersion from which on fibres have no direction."""


class Fibre(FileModel):
    """One fibre family of Holzapfel, Gasser and Ogden in the plane of the layer.

    W = k1 / (2 k2) (exp(k2 E^2) - 1), E = dispersion (I1 - 3) + (1 - 3 dispersion) (I4 - 1); `angle` from the x axis.
    Without an angle the fibres spread evenly over the plane, I4 the mean over its directions.
    """

    angle: Angle | None = None
    k1: Pressure
    k2: Annotated[float, Number("above 0, at most 1e4", Bounds(0.0, 1e4, above=True))]
    dispersion: Annotated[float, Number("0 (aligned) to 1/3 (isotropic)", Bounds(0.0, 0.33333333333333337))] = 0.0

    @property
    def directed(self) -> bool:
        """Whether the fibres have a direction in the plane, which breaks axial symmetry."""
        return self.angle is not None and self.dispersion < ISOTROPIC


def _require_stiffness(shear_modulus: float) -> None:
    if not shear_modulus > 0:
        raise problem(f"the law's initial shear modulus is {shear_modulus:.6g} Pa; it must be above 0 Pa")


PoissonRatio = Annotated[
    float,
    Number("0 to 0.49999 (at 0.5 the material has no finite bulk modulus)", Bounds(0.0, 0.49999)),
]


_OF_SHEAR = "a layer takes youngs_modulus, which is 2 (1 + poisson_ratio) times the shear modulus."
_OF_A_LAW = 'it belongs to a law, as in hyperelastic = { law = "yeoh", c10 = "8.4 kPa", c20 = "2.5 kPa" }.'
OTHER_NAMES: Mapping[str, str] = {
    **dict.fromkeys(("E", "e_modulus", "young", "modulus", "stiffness"), "Young's modulus is youngs_modulus."),
    **dict.fromkeys(("nu", "v", "poisson"), "Poisson's ratio is poisson_ratio."),
    **dict.fromkeys(("shear_modulus", "mu", "G", "mu0"), _OF_SHEAR),
    **dict.fromkeys(
        ("bulk_modulus", "K", "kappa"),
        "a layer takes youngs_modulus, which is 3 (1 - 2 poisson_ratio) times the bulk modulus.",
    ),
    **dict.fromkeys(("c10", "C10", "c01", "C01", "c20", "C20", "c30", "C30", "alpha", "jm"), _OF_A_LAW),
    "prony": "its key is relaxation, a list of { g, tau }.",
}
"""What a layer's file calls what other programs and papers call so; the end of a sentence."""


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
    hyperelastic : law of `benchmark.files.tissue`
        Finite-strain law; neo-Hookean from the moduli by default.
    relaxation : tuple of PronyTerm
        Fading parts of the stiffness, empty for an elastic layer.
    fibre : Fibre or None
        Fibre family added to the law.
    """

    other_names: ClassVar[Mapping[str, str]] = OTHER_NAMES

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


class Correlation(FileModel):
    """How the errors of two values go together.

    Attributes
    ----------
    between : tuple of str
        Keys of the two, `LAYER.NAME`.
    value : float
        Of the errors of their logarithms.
    """

    between: Annotated[tuple[str, str], Field(min_length=2, max_length=2)]
    value: Annotated[float, Number("-1 to 1", Bounds(-1.0, 1.0))]


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
    correlations : tuple of Correlation or None
        Of values with a stated uncertainty, where their errors go together.
    not_determined : tuple of str or None
        Keys `LAYER.NAME` of values that the trials behind the file do not determine.
    """

    schema_: Annotated[Schema, Field(alias="schema")] = 1
    name: Name
    citation: str = ""
    max_force: Force | None = None
    correlations: tuple[Correlation, ...] | None = None
    not_determined: tuple[str, ...] | None = None
    layers: Annotated[tuple[Layer, ...], Field(min_length=1, max_length=100)]

    @property
    def layer_names(self) -> tuple[str, ...]:
        """The layers' names from the surface down."""
        return tuple(layer.name for layer in self.layers)

    @property
    def thickness(self) -> float:
        """Total thickness in m; infinite where the last layer is endless."""
        return sum(layer.thickness for layer in self.layers)

    @property
    def uncertainties(self) -> dict[str, float]:
        """Standard uncertainties that the file states of its layers, as shares of the values, by keys as in `--set`."""
        return {f"{one.name}.{key}": share for one in self.layers for key, share in one.own_uncertainties.items()}

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
        told = self.layer(name)
        stated = {key: share for key, share in told.own_uncertainties.items() if key not in changes}
        changed = Layer(**{**dict(told), **changes}).keeping_uncertainties(stated)
        layers = tuple(changed if layer.name == name else layer for layer in self.layers)
        return self.model_copy(update={"layers": layers})

    @model_validator(mode="after")
    def _keys_are_of_layers(self) -> Self:
        pairs = [key for each in self.correlations or () for key in each.between]
        for name, keys in (("correlations", pairs), ("not_determined", self.not_determined or ())):
            stray = [key for key in keys if not any(key.startswith(f"{layer}.") for layer in self.layer_names)]
            if stray:
                raise problem(f"{stray[0]!r} is of no layer; allowed: LAYER.NAME", key=name)
        return self

    @model_validator(mode="after")
    def _layers_fit(self) -> Self:
        name, times = Counter(" ".join(each.casefold().split()) for each in self.layer_names).most_common(1)[0]
        if times > 1:
            alike = [each for each in self.layer_names if " ".join(each.casefold().split()) == name]
            named = " and ".join(repr(each) for each in dict.fromkeys(alike))
            raise problem(f"{times} layers are named {named}; each layer needs its own name", key="layers")
        for index, layer in enumerate(self.layers[:-1]):
            if math.isinf(layer.thickness):
                raise problem(
                    f"the layer {layer.name!r} has no thickness; only the last layer of a half-space may leave it out",
                    key=f"layers.{index}.thickness",
                )
        return self


LawModel = TypeVar("LawModel", bound=BaseModel)

STRESSES = ("c10", "c01", "c20", "c30", "mu", "k1")
"""The parameters of laws and fibres that are stresses; alpha, jm, k2 and dispersion are numbers."""


def scaled_tissue(tissue: Tissue, factor: float, name: str) -> Tissue:
    """Return the tissue with every modulus times `factor`, under a new name.

    Forces of all the hyperelastic laws are homogeneous of degree one in these parameters: a force-depth curve
    scales with the same factor.
    """
    layers = tuple(scaled_layer(layer, factor) for layer in tissue.layers)
    return tissue.model_copy(update={"name": name, "layers": layers})


def stretched_tissue(tissue: Tissue, height: float) -> Tissue:
    """Return the tissue as thick as `height` (m), each layer keeping its share of it; an endless one as it is."""
    if math.isinf(tissue.thickness) or height == tissue.thickness:
        return tissue
    share = height / tissue.thickness
    layers = tuple(layer.model_copy(update={"thickness": share * layer.thickness}) for layer in tissue.layers)
    return tissue.model_copy(update={"layers": layers})


def scaled_layer(layer: Layer, factor: float) -> Layer:
    """Return the layer with every modulus times `factor`: its own, its law's and its fibres'."""
    changes: dict[str, object] = {"youngs_modulus": factor * layer.youngs_modulus}
    changes["hyperelastic"] = _scaled(layer.hyperelastic, factor)
    if layer.fibre is not None:
        changes["fibre"] = _scaled(layer.fibre, factor)
    return layer.model_copy(update=changes)


def _scaled(law: LawModel, factor: float) -> LawModel:
    """Scale the stresses of a law, those of its terms included."""
    changes: dict[str, object] = {
        key: factor * value for key in STRESSES if isinstance(value := getattr(law, key, None), float)
    }
    terms = getattr(law, "terms", None)
    if terms is not None:
        changes["terms"] = tuple(_scaled(term, factor) for term in terms)
    return law.model_copy(update=changes)
