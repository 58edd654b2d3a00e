"""The layers of a tissue file in the finite-element solver's terms."""

from __future__ import annotations

import fem
from benchmark.files import Layer
from benchmark.files.tissue import Gent, Hyperelastic, MooneyRivlin, NeoHookean, Ogden, Yeoh
from benchmark.models.result import UncoveredError


def fem_layer(layer: Layer, kinematics: str) -> fem.Layer:
    """A layer with its law: linear elastic with the file's moduli in small strain, its hyperelastic law otherwise.

    Raises
    ------
    UncoveredError
        For fibres in small strain.
    FemError
        If a constant is outside the law's range.
    """
    relaxation = tuple(fem.PronyTerm(term.g, term.tau) for term in layer.relaxation)
    if kinematics == "linear":
        if layer.fibre is not None:
            raise UncoveredError(f"the layer {layer.name} has fibres, which need finite strain")
        material: fem.Material = fem.LinearElastic(layer.youngs_modulus, layer.poisson_ratio)
    else:
        material = _ground(layer.hyperelastic, layer)
        if layer.fibre is not None:
            fibre = fem.Fibre(layer.fibre.k1, layer.fibre.k2, layer.fibre.dispersion, layer.fibre.angle)
            material = fem.FibreReinforced(material, (fibre,))
    return fem.Layer(layer.name, layer.thickness, layer.density, material, relaxation)


def _ground(law: Hyperelastic, layer: Layer) -> fem.Material:
    """The isotropic law; its bulk modulus follows the layer's Poisson ratio."""
    nu = layer.poisson_ratio
    match law:
        case NeoHookean():
            shear = law.shear_modulus
            return fem.NeoHookean(layer.youngs_modulus if shear is None else 2 * shear * (1 + nu), nu)
        case MooneyRivlin():
            return fem.MooneyRivlin(law.c10, law.c01, nu)
        case Yeoh():
            return fem.Yeoh(law.c10, law.c20, law.c30, nu)
        case Ogden():
            return fem.Ogden(tuple((term.mu, term.alpha) for term in law.terms), nu)
        case Gent():
            return fem.Gent(law.mu, law.jm, nu)
