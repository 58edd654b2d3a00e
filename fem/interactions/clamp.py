"""Unknowns that rub on a fixed body: they stick, with a little give, up to a limit and slide at it.

Tresca's friction with the elastic stick that a consistent tangent needs (P. Wriggers, Computational Contact Mechanics,
2nd ed., 2006, chapter 5). The limit does not depend on the pressure, so that each step has a convex potential.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fem.arrays import FloatArray, IntArray

AT_THE_LIMIT = 1e-9


@dataclass(frozen=True)
class Sliding:
    """What rubs, and where it rests.

    Attributes
    ----------
    unknowns
        Numbers (m,) of the unknowns, each in it once.
    stick
        Stiffness (m,) in N/m below the limit.
    limit
        Largest friction (m,) in N.
    anchor
        Displacement (m,) in m at which there is no friction.
    """

    unknowns: IntArray
    stick: FloatArray
    limit: FloatArray
    anchor: FloatArray

    def force(self, y: FloatArray) -> FloatArray:
        """Friction (m,) in N against the motion to unknowns y (n,)."""
        out: FloatArray = np.clip(self._trial(y), -self.limit, self.limit)
        return out

    def stiffness(self, y: FloatArray) -> FloatArray:
        """Derivative (m,) of the friction in N/m."""
        out: FloatArray = np.where(np.abs(self._trial(y)) <= self.limit, self.stick, 0.0)
        return out

    def after(self, y: FloatArray) -> Sliding:
        """The same after a step that ends at unknowns y (n,)."""
        return replace(self, anchor=y[self.unknowns] - self.force(y) / self.stick)

    def everywhere(self, y: FloatArray) -> bool:
        """Whether the limit is reached everywhere at unknowns y (n,)."""
        return bool((np.abs(self._trial(y)) >= (1.0 - AT_THE_LIMIT) * self.limit).all())

    def _trial(self, y: FloatArray) -> FloatArray:
        trial: FloatArray = self.stick * (y[self.unknowns] - self.anchor)
        return trial
