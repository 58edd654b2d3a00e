"""A tissue made stiffer by one factor: every stress-like parameter is scaled, every plain number kept."""

from __future__ import annotations

from typing import TypeVar

from pydantic import BaseModel

from benchmark.files.tissue import Layer, Tissue

LawModel = TypeVar("LawModel", bound=BaseModel)

STRESSES = ("c10", "c01", "c20", "c30", "mu", "k1")
"""The parameters of laws and fibres that are stresses; alpha, jm, k2 and dispersion are numbers."""


def scaled_tissue(tissue: Tissue, factor: float, name: str) -> Tissue:
    """Return the tissue with every modulus times `factor`, under a new name.

    Forces of all the hyperelastic laws are homogeneous of degree one in these parameters: a force-depth curve
    scales with the same factor.
    """
    layers = tuple(_scaled_layer(layer, factor) for layer in tissue.layers)
    return tissue.model_copy(update={"name": name, "layers": layers})


def _scaled_layer(layer: Layer, factor: float) -> Layer:
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
