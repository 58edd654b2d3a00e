"""Ogden's material.

W = sum_p mu_p / alpha_p (L1^alpha_p + L2^alpha_p + L3^alpha_p - 3), L_a = J^(-1/3) l_a (R. W. Ogden, Proc. R. Soc.
Lond. A 326 (1972) 565). With b_a = sum_p mu_p L_a^alpha_p the principal stresses are P_a = (b_a - mean b) / l_a.

With F = sum_a l_a r_a x q_a the basis B_ab = r_a x q_b turns dP/dF into its principal form: d2W/dl_a dl_b between B_aa
and B_bb, and for a != b, with P_a = dW/dl_a,

    B_ab B_ab: (d + s) / 2,  B_ab B_ba: (d - s) / 2,  d = (P_a - P_b) / (l_a - l_b),  s = (P_a + P_b) / (l_a + l_b)

(Ogden, Non-linear Elastic Deformations, 1984, section 6.1.4). Stretches come from the Green-Lagrange strain, so that
they keep their digits near rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem.arrays import FloatArray
from fem.errors import FemError, require_finite
from fem.materials.deformation import Deformation
from fem.materials.material import Hyperelastic, IsochoricLaw

CLOSE = 1e-5  # difference of logarithmic stretches below which the limit is used: its error is the square


@dataclass(frozen=True)
class OgdenLaw:
    """Parameters mu_1, alpha_1, mu_2, alpha_2, ...: mu in Pa.

    Attributes
    ----------
    terms
        How many pairs there are.
    """

    terms: int

    def energy(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Isochoric strain energy in J/m3, (*points)."""
        mu, alpha = _split(parameters, deformation.J.ndim)
        powers = np.expm1(alpha * _isochoric(principal_frame(deformation), deformation))
        out: FloatArray = (mu / alpha * powers).sum(axis=(0, 1))
        return out

    def stress(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """First Piola-Kirchhoff stress in Pa, (components, *points)."""
        frame = principal_frame(deformation)
        return spectral_stress(deformation, frame, _principal_stress(frame, deformation, parameters))

    def tangent(self, deformation: Deformation, parameters: FloatArray) -> FloatArray:
        """Derivative dP/dF, packed upper triangle (pairs, *points), in Pa."""
        frame = principal_frame(deformation)
        principal = _principal_stress(frame, deformation, parameters)
        mu, alpha = _split(parameters, deformation.J.ndim)
        rate = (mu * alpha * np.exp(alpha * _isochoric(frame, deformation))).sum(axis=0)
        bend = _second_derivative(frame.stretch, principal, rate)
        quotient = _quotient(frame, principal, bend)
        return spectral_tangent(deformation, frame, principal, bend, quotient)


@dataclass(frozen=True)
class Ogden(Hyperelastic):
    """Ogden's solid.

    Attributes
    ----------
    terms
        (mu in Pa, alpha) of each term, at least one, alpha not zero; half the sum of mu alpha, the shear modulus
        at rest, is above 0.
    poisson_ratio
        At rest, above -1 and at most 0.4999.

    Raises
    ------
    FemError
        If a constant is outside its range.
    """

    terms: tuple[tuple[float, float], ...]
    poisson_ratio: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "terms", tuple((float(mu), float(alpha)) for mu, alpha in self.terms))
        if not self.terms:
            raise FemError("ogden: terms: none given, at least one (mu, alpha) is needed")
        for n, (mu, alpha) in enumerate(self.terms):
            require_finite(f"ogden: mu of term {n + 1}", mu, "Pa")
            require_finite(f"ogden: alpha of term {n + 1}", alpha, "(no unit)")
            if alpha == 0.0:
                raise FemError(f"ogden: alpha of term {n + 1} = 0: must not be zero")
        self._require_stiffness("ogden: half the sum of mu alpha")

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at rest, half the sum of mu alpha, in Pa."""
        return 0.5 * sum(mu * alpha for mu, alpha in self.terms)

    @property
    def law(self) -> IsochoricLaw:
        """The isochoric law."""
        return OgdenLaw(len(self.terms))

    @property
    def parameters(self) -> tuple[float, ...]:
        """Parameters mu and alpha of each term in turn."""
        return tuple(value for term in self.terms for value in term)


def _split(parameters: FloatArray, points: int) -> tuple[FloatArray, FloatArray]:
    """Parameters mu and alpha, (terms, 1, *broadcast), of parameters for arrays of `points` axes."""
    table = parameters.reshape(len(parameters), 1, *(1,) * (points - parameters.ndim + 1), *parameters.shape[1:])
    return table[::2], table[1::2]


def _isochoric(frame: PrincipalFrame, d: Deformation) -> FloatArray:
    """Logarithms ln L_a, (3, *points)."""
    out: FloatArray = frame.logarithm - np.log1p(d.volume_change) / 3.0
    return out


def _principal_stress(frame: PrincipalFrame, d: Deformation, parameters: FloatArray) -> FloatArray:
    mu, alpha = _split(parameters, d.J.ndim)
    b = (mu * np.expm1(alpha * _isochoric(frame, d))).sum(axis=0)
    out: FloatArray = (b - b.mean(axis=0)) * np.exp(-frame.logarithm)
    return out


def _second_derivative(stretch: FloatArray, principal: FloatArray, rate: FloatArray) -> FloatArray:
    """d2W/dl_a dl_b (3, 3, *points), of db_a/d(ln L_a) = `rate` (3, *points).

    l_a l_b W_ab = rate_a (delta_ab - 1/3) - (rate_b - mean rate) / 3 - delta_ab l_a P_a.
    """
    mean = rate.mean(axis=0)
    out = np.empty((3, *stretch.shape))
    for a in range(3):
        for b in range(3):
            value = mean / 3.0 - (rate[a] + rate[b]) / 3.0
            if a == b:
                value = value + rate[a] - stretch[a] * principal[a]
            out[a, b] = value / (stretch[a] * stretch[b])
    return out


def _quotient(frame: PrincipalFrame, principal: FloatArray, bend: FloatArray) -> FloatArray:
    """(P_a - P_b) / (l_a - l_b), (3, 3, *points); W_aa - W_ab, symmetrised, where the stretches are equal."""
    stretch, log = frame.stretch, frame.logarithm
    out = np.zeros_like(bend)
    for a in range(3):
        for b in range(3):
            if a != b:
                close = np.abs(log[a] - log[b]) < CLOSE
                gap = np.where(close, 1.0, stretch[a] - stretch[b])
                limit = 0.5 * (bend[a, a] + bend[b, b]) - bend[a, b]
                out[a, b] = np.where(close, limit, (principal[a] - principal[b]) / gap)
    return out


@dataclass(frozen=True)
class PrincipalFrame:
    """Principal stretches and the basis of F.

    Attributes
    ----------
    logarithm
        ln l_a, (3, *points).
    basis
        Components (components, components, *points) of B_ab, the second axis in the order of the positions (a, b).
    """

    logarithm: FloatArray
    basis: FloatArray

    @property
    def stretch(self) -> FloatArray:
        """l_a, (3, *points)."""
        return np.exp(self.logarithm)


def principal_frame(d: Deformation) -> PrincipalFrame:
    """Frame of a deformation."""
    strain, axes = d.components.principal(d.green_strain)
    logarithm = 0.5 * np.log1p(2.0 * strain)
    F = np.moveaxis(d.components.tensor(d.F), (-2, -1), (0, 1))
    turned = np.einsum("ij...,ja...->ia...", F, axes) * np.exp(-logarithm)
    positions = d.components.positions
    basis = np.stack([np.stack([turned[i, a] * axes[j, b] for a, b in positions]) for i, j in positions])
    return PrincipalFrame(logarithm, basis)


def spectral_stress(d: Deformation, frame: PrincipalFrame, principal: FloatArray) -> FloatArray:
    """P (components, *points) of its principal values (3, *points)."""
    normal = d.components.normal
    out: FloatArray = np.einsum("ka...,a...->k...", frame.basis[:, normal], principal)
    return out


def spectral_tangent(
    d: Deformation, frame: PrincipalFrame, principal: FloatArray, bend: FloatArray, quotient: FloatArray
) -> FloatArray:
    """dP/dF, packed (pairs, *points).

    Parameters
    ----------
    d, frame
        Deformation and its frame.
    principal
        P_a, (3, *points).
    bend
        d2W/dl_a dl_b, (3, 3, *points).
    quotient
        (P_a - P_b) / (l_a - l_b) with its limit where the stretches are equal, (3, 3, *points).
    """
    positions, stretch = d.components.positions, frame.stretch
    inner = np.zeros((len(positions), len(positions), *d.J.shape))
    for n, (a, b) in enumerate(positions):
        for m, (e, f) in enumerate(positions):
            if a == b and e == f:
                inner[n, m] = bend[a, e]
            elif a != b and {a, b} == {e, f}:
                mean = (principal[a] + principal[b]) / (stretch[a] + stretch[b])
                inner[n, m] = 0.5 * (quotient[a, b] + (mean if a == e else -mean))
    half = np.einsum("ka...,ab...->kb...", frame.basis, inner)
    first, second = d.components.pairs
    out: FloatArray = np.einsum("na...,na...->n...", half[first], frame.basis[second])
    return out
