"""Isochoric invariants of C = F^T F with their derivatives by F, for the laws written in them.

An invariant I of degree 2 m in F becomes isochoric by J^-p I, p = 2 m / 3. With G = dI/dF / 2 and c = cof F

    1/2 d(J^-p I)/dF   = J^-p (G - p/2 I/J c)
    1/2 d2(J^-p I)/dF2 = J^-p (dG/dF - p/J (G x c + c x G) + p/2 (1 + p) I/J^2 c x c - p/2 I/J dc/dF)

(Holzapfel, Nonlinear Solid Mechanics, 2000, chapter 6). Differences from rest are used where terms would cancel there.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from fem.arrays import FloatArray
from fem.materials.deformation import Deformation

FIRST, SECOND = 2.0 / 3.0, 4.0 / 3.0  # powers p of invariants of second and of fourth degree in F


def first_gradient(d: Deformation) -> FloatArray:
    """Half the derivative of J^(-2/3) tr C, (components, *points).

    J^(-2/3) (F - I1/(3 J) cof F), written with H - (cof F - I) - (I1/(3 J) - 1) cof F, which do not cancel.
    """
    share = (d.first_invariant_change - 3.0 * d.volume_change) / (3.0 * d.J)
    out: FloatArray = d.H - d.cofactor_change - share * d.cofactor
    out *= d.isochoric_factor
    return out


def first_curvature(d: Deformation, scale: FloatArray) -> FloatArray:
    """`scale` (*broadcast) times half the second derivative of J^(-2/3) tr C, packed (pairs, *points)."""
    out = np.zeros((len(d.components.pairs[0]), *d.J.shape))
    factor = scale * d.isochoric_factor
    add_projection(out, d, FIRST, factor, 3.0 + d.first_invariant_change, d.F)
    out[d.components.diagonal] += factor
    return out


def second_invariant_change(d: Deformation) -> FloatArray:
    """I2 - 3 = |cof F|^2 - 3, (*points)."""
    h = d.cofactor_change
    out: FloatArray = 2.0 * h[d.components.normal].sum(axis=0) + np.einsum("k...,k...->...", h, h)
    return out


def second_isochoric_change(d: Deformation) -> FloatArray:
    """J^(-4/3) I2 less 3, (*points)."""
    change = np.expm1(-SECOND * np.log1p(d.volume_change))
    out: FloatArray = (1.0 + change) * second_invariant_change(d) + 3.0 * change
    return out


def second_gradient(d: Deformation) -> FloatArray:
    """Half the derivative of J^(-4/3) I2, (components, *points)."""
    rest = _second_raw_change(d) - 2.0 * d.cofactor_change
    share = 2.0 / 3.0 * (second_invariant_change(d) - 3.0 * d.volume_change) / d.J
    out: FloatArray = d.isochoric_factor**2 * (rest - share * d.cofactor)
    return out


def second_curvature(d: Deformation, scale: FloatArray) -> FloatArray:
    """`scale` (*broadcast) times half the second derivative of J^(-4/3) I2, packed (pairs, *points)."""
    components = d.components
    factor = scale * d.isochoric_factor**2
    packed = np.zeros((len(components.pairs[0]), *d.J.shape))
    packed[components.cofactor_pairs] = d.cofactor_derivative
    bend = components.unpack(packed)
    k, m = components.pairs
    out: FloatArray = np.einsum("na...,na...->n...", bend[k], bend[m])
    out[components.cofactor_pairs] += components.cofactor_derivative(d.cofactor)
    out *= factor
    gradient = _second_raw_change(d) + 2.0 * d.identity
    add_projection(out, d, SECOND, factor, 3.0 + second_invariant_change(d), gradient)
    return out


def _second_raw_change(d: Deformation) -> FloatArray:
    """G of I2 less 2 I: the bilinear form of the cofactor in F and cof F, by its polarisation."""
    change, turned = d.components.cofactor_change, d.H + d.cofactor_change
    trace = turned[d.components.normal].sum(axis=0) * d.identity
    linear = trace - turned[d.components.transposed]
    out: FloatArray = change(turned) - d.components.cofactor_change(d.H) - change(d.cofactor_change) + linear
    return out


def structure_change(d: Deformation, structure: FloatArray) -> FloatArray:
    """J^(-2/3) M : C less tr M, (*points), of a symmetric structure tensor M (components, *broadcast)."""
    stretch = 2.0 * (structure * d.green_strain).sum(axis=0)
    trace = structure[d.components.normal].sum(axis=0)
    out: FloatArray = d.isochoric_factor * stretch + d.isochoric_change * trace
    return out


def structure_gradient(d: Deformation, structure: FloatArray) -> FloatArray:
    """Half the derivative of J^(-2/3) M : C, (components, *points)."""
    raw = d.components.product(d.F, structure)
    share = (d.F * raw).sum(axis=0) / (3.0 * d.J)
    out: FloatArray = d.isochoric_factor * (raw - share * d.cofactor)
    return out


def structure_curvature(d: Deformation, structure: FloatArray, scale: FloatArray) -> FloatArray:
    """`scale` (*broadcast) times half the second derivative of J^(-2/3) M : C, packed (pairs, *points)."""
    out = np.zeros((len(d.components.pairs[0]), *d.J.shape))
    factor, raw = scale * d.isochoric_factor, d.components.product(d.F, structure)
    add_projection(out, d, FIRST, factor, (d.F * raw).sum(axis=0), raw)
    place, component = d.components.row_pairs
    out[place] += factor * structure[component]
    return out


def add_projection(
    out: FloatArray, d: Deformation, power: float, factor: FloatArray, invariant: FloatArray, gradient: FloatArray
) -> None:
    """Add to packed `out` (pairs, *points) what J^-p does to an invariant's curvature.

    Parameters
    ----------
    out
        Changed in place.
    d, power
        Deformation and p.
    factor
        J^-p times any scale, (*points).
    invariant, gradient
        I (*points) and G (components, *points).
    """
    share = (0.5 * power) * factor * invariant / d.J
    b = power * factor / d.J
    mixed = ((1.0 + power) * share / d.J) * d.cofactor - b * gradient
    d.components.add_products(out, mixed, d.cofactor)
    d.components.add_products(out, -b * d.cofactor, gradient)
    out[d.components.cofactor_pairs] -= share * d.cofactor_derivative


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
