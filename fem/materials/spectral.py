"""Stress and tangent of isotropic laws written in the principal stretches.

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
from fem.deformation import Deformation


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
