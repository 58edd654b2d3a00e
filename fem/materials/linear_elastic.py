"""Isotropic linear elasticity (Hooke's law), for linear kinematics only.

sigma = 2 mu dev(eps) + K tr(eps) I. It is not objective: a rotation would give stress, so finite kinematics
refuses it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray
from fem.materials.deformation import Deformation
from fem.materials.material import IsochoricLaw, IsotropicSolid


@dataclass(frozen=True)
class HookeLaw:
    """Deviatoric part of Hooke's law; the one parameter is the shear modulus in Pa."""

    def energy(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Energy mu dev(eps) : dev(eps), (*points), in J/m3."""
        out: FloatArray = 0.5 * (self.stress(deformation, parameters) * deformation.small_strain).sum(axis=0)
        return out

    def stress(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """2 mu dev(eps), shape (components, *points), in Pa."""
        components = deformation.components
        strain = deformation.small_strain
        trace = strain[components.normal].sum(axis=0)
        out = strain.copy()
        out[components.normal] -= trace / 3.0
        out *= 2.0 * parameters[0]
        return out

    def tangent(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Constant derivative, packed upper triangle (pairs, *points), in Pa."""
        components = deformation.components
        shape = (len(components.pairs[0]), *deformation.J.shape)
        pattern = components.deviator.reshape(-1, *(1,) * deformation.J.ndim)
        return np.broadcast_to(2.0 * parameters[0] * pattern, shape).copy()


@dataclass(frozen=True)
class LinearElastic(IsotropicSolid):
    """Isotropic linear elastic solid: Young's modulus in Pa and Poisson's ratio, both at rest; see `IsotropicSolid`."""

    @property
    def law(self) -> IsochoricLaw:
        """The deviatoric law."""
        return HookeLaw()

    @property
    def finite_strain(self) -> bool:
        """Not objective: linear kinematics only."""
        return False
