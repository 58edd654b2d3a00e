"""The lower face of a sheet on the plate round a hole, on which it slides where the shear stress passes a limit."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.assembly.item import EquationItem, ItemForces
from fem.interactions.active_set import Friction

SLIDES_EVERYWHERE = (
    "the sheet slides on all of the plate, up to the outer border, which holds it: the answer depends on where that "
    "is; set the radius of the mesh to that of the clamp"
)


@dataclass(frozen=True)
class ClampFriction(EquationItem):
    """Displacements with friction against a body at rest; in small strain there is none.

    Attributes
    ----------
    own
        Numbers (m,) of the unknowns, each in it once.
    friction
        Friction of each, with their displacements as path.
    """

    own: IntArray
    friction: Friction
    kinked: ClassVar[bool] = True
    in_small_strain: ClassVar[bool] = False

    @property
    def unknowns(self) -> IntArray:
        """Unknowns (m,) it acts on."""
        return self.own

    @property
    def entries(self) -> tuple[IntArray, IntArray]:
        """The unknowns' diagonal."""
        return self.own, self.own

    @property
    def remembers(self) -> bool:
        """Where the sheet sticks follows from the states before."""
        return True

    def respond(self, y: FloatArray) -> ItemForces:
        """Friction and its derivative at unknowns y (n,)."""
        trial = self._trial(y)
        force, sticks = self.friction.drag(trial, trial)
        return ItemForces(force, np.where(sticks, self.friction.stick, 0.0))

    def accepted(self, y: FloatArray) -> ClampFriction:
        """The item after a step that ends at unknowns y (n,)."""
        elastic = self.respond(y).force / self.friction.stick
        return replace(self, friction=self.friction.after(y[self.own], elastic))

    def eased(self, share: float) -> ClampFriction:
        """The clamp with a share of its stiffness below the limit."""
        return replace(self, friction=replace(self.friction, stick=share * self.friction.stick))

    def tightened(self, y: FloatArray, share: float) -> FloatArray:
        """Unknowns y (n,) of the eased clamp with what sticks there moved to where its friction is the same here."""
        out, trial = y.copy(), share * self._trial(y)
        sticks = np.abs(trial) <= self.friction.limit
        out[self.own[sticks]] = (self.friction.anchor + trial / self.friction.stick)[sticks]
        return out

    def led(self, y: FloatArray) -> ClampFriction:
        """The item after a way from rest to unknowns y (n,) of another mesh."""
        return replace(self, friction=self.friction.led(y[self.own]))

    def warning(self, y: FloatArray) -> str:
        """Where the sheet slides up to the border."""
        return SLIDES_EVERYWHERE if self.friction.slides_everywhere(self._trial(y)) else ""

    def _trial(self, y: FloatArray) -> FloatArray:
        trial: FloatArray = self.friction.stick * (y[self.own] - self.friction.anchor)
        return trial
