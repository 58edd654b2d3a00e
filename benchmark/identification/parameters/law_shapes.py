"""Hyperelastic laws with one constant of shape, common to all layers, beside each layer's shear modulus at rest.

A law of shape s and shear modulus G is `built`; where s is at its neo-Hookean end, all laws are one law, so that data
that do not tell s do not tell the laws apart either.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from benchmark.errors import InputError
from benchmark.files import Tissue
from benchmark.files.tissue import Fibre, Gent, Hyperelastic, Layer, MooneyRivlin, NeoHookean, Ogden, OgdenTerm, Yeoh

POWER = "law.alpha"
"""Ogden's power, of either sign: mu has the same one, so that mu alpha / 2, the shear modulus at rest, is above 0."""


@dataclass(frozen=True)
class LawShape:
    """A law's constant of shape.

    Attributes
    ----------
    key : str
        How a fit calls it; empty for a law without one.
    start, low, high : float
    built : (G, s) to law
        G the shear modulus at rest, Pa.
    words : str
        What the constant is.
    fibre : (G, s) to fibre family, or None
        What the law adds to each layer; without one a layer keeps the fibres that it has.
    """

    key: str
    start: float
    low: float
    high: float
    built: Callable[[float, float], Hyperelastic]
    words: str
    fibre: Callable[[float, float], Fibre] | None = None


def _mooney_rivlin(shear: float, ratio: float) -> Hyperelastic:
    c10 = 0.5 * shear / (1.0 + ratio)
    return MooneyRivlin(law="mooney_rivlin", c10=c10, c01=ratio * c10)


def _yeoh(shear: float, ratio: float) -> Hyperelastic:
    return Yeoh(law="yeoh", c10=0.5 * shear, c20=0.5 * ratio * shear)


def _gent(shear: float, locking: float) -> Hyperelastic:
    return Gent(law="gent", mu=shear, jm=locking)


def _ogden(shear: float, power: float) -> Hyperelastic:
    return Ogden(law="ogden", terms=(OgdenTerm(mu=2.0 * shear / power, alpha=power),))


def _neo_hookean(shear: float, unused: float) -> Hyperelastic:  # noqa: ARG001 - one signature for all laws
    return NeoHookean(c10=0.5 * shear)


def _spread_fibres(shear: float, ratio: float) -> Fibre:
    """Evenly over the plane of the layer; at rest they add no stiffness."""
    return Fibre(k1=0.5 * ratio * shear, k2=1.0)


LAW_SHAPES: Mapping[str, LawShape] = {
    "neo_hookean": LawShape("", 1.0, 1.0, 1.0, _neo_hookean, ""),
    "mooney_rivlin": LawShape("law.c01_over_c10", 0.3, 0.003, 30.0, _mooney_rivlin, "c01 over c10"),
    "yeoh": LawShape("law.c20_over_c10", 0.1, 1e-3, 10.0, _yeoh, "c20 over c10"),
    "gent": LawShape("law.jm", 3.0, 0.3, 300.0, _gent, "the strain measure jm at which the law locks"),
    "ogden": LawShape(POWER, 4.0, -40.0, 40.0, _ogden, "the power alpha of the stretches"),
    "fibres": LawShape(
        "law.k1_over_c10",
        1.0,
        0.01,
        100.0,
        _neo_hookean,
        "k1 of the fibres over c10 of what they lie in",
        _spread_fibres,
    ),
}
"""Laws by the names of tissue files; an Ogden law of one term; `fibres`: a family of Holzapfel, Gasser and Ogden with
k2 = 1 that spreads evenly over the plane, in a neo-Hookean solid."""


def law_shape(name: str) -> LawShape:
    """The law of that name; raises InputError."""
    found = LAW_SHAPES.get(name)
    if found is None:
        raise InputError(f"--law {name}: no such law; allowed: {', '.join(LAW_SHAPES)}")
    return found


def shear_modulus(layer: Layer) -> float:
    """Shear modulus at rest of a layer's law, Pa."""
    own = layer.hyperelastic.shear_modulus
    return layer.shear_modulus if own is None else own


def with_law(tissue: Tissue, name: str, shape: float) -> Tissue:
    """The tissue with one law in all layers, each with the shear modulus at rest that it had."""
    law = law_shape(name)
    layers = []
    for one in tissue.layers:
        shear = shear_modulus(one)
        fibre = one.fibre if law.fibre is None else law.fibre(shear, shape)
        layers.append(one.model_copy(update={"hyperelastic": law.built(shear, shape), "fibre": fibre}))
    return tissue.model_copy(update={"layers": tuple(layers)})
