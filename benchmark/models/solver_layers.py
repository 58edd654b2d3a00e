"""The layers of a tissue in the terms of the two solvers; each law's formula stands once, in `fem`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from benchmark.files import Layer
from benchmark.files.tissue import Gent, Hyperelastic, MooneyRivlin, NeoHookean, Ogden, Yeoh
from benchmark.models.model_result import Array, UncoveredError
from wavemodel import WaveLayer

if TYPE_CHECKING:
    import fem
    from fem.materials.deformation import Deformation

IN_FEM = [0, 1, 4, 2, 3]
"""Components rr, rz, hoop, zr, zz of the finite elements among the wave's rr, rz, zr, zz, hoop."""
IN_WAVE = [0, 1, 3, 4, 2]
"""The other way round."""


def fem_layer(layer: Layer, kinematics: str) -> fem.Layer:
    """A layer with its law: linear elastic with the file's moduli in small strain, its hyperelastic law otherwise.

    Raises
    ------
    UncoveredError
        For fibres in small strain.
    FemError
        If a constant is outside the law's range.
    """
    import fem

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
    import fem

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


@dataclass(frozen=True)
class MaterialEnergy:
    """The isochoric energy of a material of the finite elements as the wave takes it (`wavemodel.StrainEnergy`).

    The two packages know nothing of each other, and each formula stands once. That z points up in the finite elements
    makes no difference: the laws and their fibres are the same on both sides of the layer's plane.
    """

    material: fem.Material

    def _at(self, gradient: Array) -> tuple[Deformation, Array]:
        from fem.materials.components import AXISYMMETRIC
        from fem.materials.deformation import Deformation

        return Deformation(AXISYMMETRIC, gradient[IN_FEM]), np.array(self.material.parameters)

    def energy(self, gradient: Array) -> Array:
        """(...) J/m3 of displacement gradients (5, ...)."""
        return self.material.law.energy(*self._at(gradient))

    def stress(self, gradient: Array) -> Array:
        """(5, ...) Pa."""
        return self.material.law.stress(*self._at(gradient))[IN_WAVE]

    def tangent(self, gradient: Array) -> Array:
        """(5, 5, ...) Pa."""
        deformation, parameters = self._at(gradient)
        packed = self.material.law.tangent(deformation, parameters)
        return deformation.components.unpack(packed)[np.ix_(IN_WAVE, IN_WAVE)]


def wave_layers(layers: Iterable[Layer], *, laws: bool = True) -> list[WaveLayer]:
    """Layers with the initial moduli of their laws, and with the laws that are not neo-Hookean unless told otherwise.

    Raises
    ------
    UncoveredError
        If a law does not take its constants.
    """
    return [
        WaveLayer(
            layer.name,
            layer.thickness,
            layer.density,
            initial_modulus(layer),
            layer.poisson_ratio,
            _own_law(layer) if laws else None,
        )
        for layer in layers
    ]


def _own_law(layer: Layer) -> MaterialEnergy | None:
    if layer.hyperelastic.law == "neo_hookean" and layer.fibre is None:
        return None
    from fem import FemError

    try:
        return MaterialEnergy(fem_layer(layer, "finite").material)
    except FemError as error:
        raise UncoveredError(f"the layer {layer.name}: {error}") from None


def initial_modulus(layer: Layer) -> float:
    """Initial Young's modulus of the layer's law, Pa: what its finite elements begin with."""
    shear = layer.hyperelastic.shear_modulus
    return layer.youngs_modulus if shear is None else 2.0 * shear * (1.0 + layer.poisson_ratio)
