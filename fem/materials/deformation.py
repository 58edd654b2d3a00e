"""Deformation at many points, with what the laws need of it, each computed once and on demand.

Everything starts from the displacement gradient H = F - I. Differences from the state at rest (J - 1,
cof F - I, I1 - 3) are formed without F, so that they keep all digits when the strain is tiny.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from fem.arrays import FloatArray
from fem.materials.components import Components


class Deformation:
    """Deformation gradient F = I + H at many points.

    Parameters
    ----------
    components
        Which components of F there are.
    H
        Displacement gradient, (components, *points).
    """

    def __init__(self, components: Components, H: FloatArray) -> None:
        self.components = components
        self.H = H

    @cached_property
    def identity(self) -> FloatArray:
        """The unit tensor, shaped to be added to (components, *points)."""
        return self.components.identity.reshape(-1, *(1,) * (self.H.ndim - 1))

    @cached_property
    def F(self) -> FloatArray:  # noqa: N802 (the field's symbol)
        """Deformation gradient, (components, *points)."""
        out: FloatArray = self.H + self.identity
        return out

    @cached_property
    def cofactor_change(self) -> FloatArray:
        """Cof F - I, (components, *points)."""
        return self.components.cofactor_change(self.H)

    @cached_property
    def cofactor(self) -> FloatArray:
        """Cofactor dJ/dF, (components, *points)."""
        out: FloatArray = self.cofactor_change + self.identity
        return out

    @cached_property
    def volume_change(self) -> FloatArray:
        """J - 1, (*points)."""
        return self.components.volume_change(self.H, self.cofactor_change)

    @cached_property
    def J(self) -> FloatArray:  # noqa: N802 (the field's symbol)
        """Volume ratio det F, (*points)."""
        out: FloatArray = 1.0 + self.volume_change
        return out

    @cached_property
    def cofactor_derivative(self) -> FloatArray:
        """d(cof F)/dF at `components.cofactor_pairs`."""
        return self.components.cofactor_derivative(self.F)

    @cached_property
    def first_invariant_change(self) -> FloatArray:
        """Trace of C = F^T F less 3, (*points)."""
        trace = self.H[self.components.normal].sum(axis=0)
        out: FloatArray = 2.0 * trace + np.einsum("k...,k...->...", self.H, self.H)
        return out

    @cached_property
    def isochoric_invariant_change(self) -> FloatArray:
        """J^(-2/3) tr C less 3, (*points)."""
        out: FloatArray = self.isochoric_factor * self.first_invariant_change + 3.0 * self.isochoric_change
        return out

    @cached_property
    def isochoric_change(self) -> FloatArray:
        """J^(-2/3) less 1, (*points)."""
        out: FloatArray = np.expm1(-2.0 / 3.0 * np.log1p(self.volume_change))
        return out

    @cached_property
    def isochoric_factor(self) -> FloatArray:
        """J^(-2/3), (*points)."""
        out: FloatArray = 1.0 / np.cbrt(self.J * self.J)
        return out

    @cached_property
    def small_strain(self) -> FloatArray:
        """Symmetric part of H, (components, *points)."""
        out: FloatArray = 0.5 * (self.H + self.H[self.components.transposed])
        return out

    @cached_property
    def green_strain(self) -> FloatArray:
        """Green-Lagrange strain (F^T F - I)/2 = sym H + H^T H / 2, (components, *points)."""
        out: FloatArray = self.small_strain + 0.5 * self.components.right_product(self.H)
        return out
