"""What a material law is to the solver.

A law gives the isochoric (shape-changing) part of the stress and its tangent. The volumetric part is the
same for all laws, U(J) = K/2 (J - 1)^2 with the pressure as a field of its own, and belongs to the element.
"""

from __future__ import annotations

from typing import Protocol

from fem.arrays import FloatArray
from fem.deformation import Deformation


class IsochoricLaw(Protocol):
    """Isochoric energy with its stress and tangent for many points at once; parameters are (k, *broadcast)."""

    def energy(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Isochoric strain energy in J/m3, (*points)."""
        ...

    def stress(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """First Piola-Kirchhoff stress in Pa, shape (components, *points); parameters (k, *broadcast)."""
        ...

    def tangent(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Derivative dP/dF in Pa, packed upper triangle, shape (pairs, *points)."""
        ...


class Material(Protocol):
    """One layer's material."""

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at rest in Pa."""
        ...

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus in Pa."""
        ...

    @property
    def law(self) -> IsochoricLaw:
        """The isochoric law; equal for materials that differ in their parameters only."""
        ...

    @property
    def parameters(self) -> tuple[float, ...]:
        """Parameters the law is evaluated with."""
        ...

    @property
    def finite_strain(self) -> bool:
        """Whether the law is objective, so that it may be used in finite kinematics."""
        ...
