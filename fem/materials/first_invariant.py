"""What laws have in common whose isochoric energy depends on J^(-2/3) tr C alone."""

from __future__ import annotations

from abc import ABC, abstractmethod

from fem.arrays import FloatArray
from fem.deformation import Deformation
from fem.materials.invariants import first_curvature, first_gradient


class FirstInvariantLaw(ABC):
    """W(x), x = J^(-2/3) tr C - 3: P = 2 W' g, dP/dF = 2 W' dg/dF + 4 W'' g x g, g = 1/2 dx/dF."""

    @abstractmethod
    def energy_of(self, x: FloatArray, parameters: FloatArray) -> FloatArray:
        """W in J/m3, (*points)."""

    @abstractmethod
    def slopes(self, x: FloatArray, parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
        """2 W' and 4 W'' in Pa, (*points) each; not finite where the law has no answer."""

    def energy(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Isochoric strain energy in J/m3, (*points)."""
        return self.energy_of(deformation.isochoric_invariant_change, parameters)

    def stress(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """First Piola-Kirchhoff stress in Pa, (components, *points)."""
        out = first_gradient(deformation)
        out *= self.slopes(deformation.isochoric_invariant_change, parameters)[0]
        return out

    def tangent(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Derivative dP/dF, packed upper triangle (pairs, *points), in Pa."""
        slope, bend = self.slopes(deformation.isochoric_invariant_change, parameters)
        gradient = first_gradient(deformation)
        out = first_curvature(deformation, slope)
        deformation.components.add_products(out, bend * gradient, gradient)
        return out
