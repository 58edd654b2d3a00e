"""What an interaction brings to the equations: forces on the unknowns and their derivative.

:class:`fem.assembly.system.System` sums the elements and the items, Newton's method solves the sum; neither knows what
an item stands for. The items are in :mod:`fem.interactions`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class ItemForces:
    """Forces and stiffness of an item at one state.

    Attributes
    ----------
    force
        Internal forces (k,) in N on the item's unknowns.
    stiffness
        Derivative (e,) in N/m at the item's entries.
    support
        Upward force in N on nodes that are fixed.
    """

    force: FloatArray
    stiffness: FloatArray
    support: float = 0.0


class EquationItem(ABC):
    """One interaction; what it remembers is in the item, a new one after each step."""

    kinked: ClassVar[bool] = False
    """Whether its forces have kinks, so that Newton's corrections must not leave more unbalanced than before."""
    in_small_strain: ClassVar[bool] = True
    """Whether it takes part in the equations of small displacements from rest."""

    @property
    @abstractmethod
    def unknowns(self) -> IntArray:
        """Unknowns (k,) it acts on, the same in all states, each as often as wanted."""

    @property
    @abstractmethod
    def entries(self) -> tuple[IntArray, IntArray]:
        """Rows and columns (e,) of its stiffness, the same in all states; of two mirrored entries only one."""

    @property
    @abstractmethod
    def remembers(self) -> bool:
        """Whether a state depends on the states before it."""

    @abstractmethod
    def respond(self, y: FloatArray) -> ItemForces | None:
        """Forces and stiffness at unknowns y (n,); None where they do not exist."""

    @abstractmethod
    def accepted(self, y: FloatArray) -> Self:
        """The item after a step that ends at unknowns y (n,)."""

    def met(self, y: FloatArray) -> FloatArray:
        """The unknowns (n,) with the item's own as the displacements among them have it, as far as these tell."""
        return y

    def eased(self, share: float) -> Self | None:
        """The item with a share of its stiffness below a limit; None where it has none, or multipliers in its place."""
        del share
        return None

    def tightened(self, y: FloatArray, share: float) -> FloatArray:
        """Unknowns (n,) of the eased item with its points where this one has the same forces on them."""
        del share
        return y

    def led(self, y: FloatArray) -> Self:
        """The item after a way from rest to unknowns y (n,) that are known from another mesh, not from equilibrium."""
        return self.accepted(y)

    def pressed_as(self, y: FloatArray, other: Self, theirs: FloatArray, *, pressed: bool) -> tuple[FloatArray, Self]:
        """Unknowns y (n,) and the item with the pressure that another mesh's item has.

        Parameters
        ----------
        y
            Unknowns (n,) of this mesh.
        other, theirs
            The item of the other mesh, and its unknowns (m,).
        pressed
            Whether the tool pressed before this state.
        """
        del other, theirs, pressed
        return y, self

    @property
    def follows_pressure(self) -> bool:
        """Whether limits are guessed and corrected, round after round, until they fit the pressure."""
        return False

    @property
    def touches_by_point(self) -> bool:
        """Whether it begins at a point, round which predictions easily turn an element inside out."""
        return False

    def corrected(self, y: FloatArray, press: float) -> Self | None:
        """The item that fits a state in equilibrium at y (n,) under a press in N; None if this one does."""
        del y, press
        return None

    def fitted(self, y: FloatArray) -> Self:
        """The item with limits exactly those of a state with unknowns y (n,); `corrected` leaves small misfits."""
        del y
        return self

    @property
    def settled(self) -> FloatArray:
        """What `corrected` has chosen (k,), which the state alone tells to a tolerance only; as many in all states."""
        return np.zeros(0)

    def as_settled(self, chosen: FloatArray) -> Self:
        """The item with what `corrected` had chosen (k,) in an earlier run."""
        del chosen
        return self

    def active(self, y: FloatArray) -> BoolArray | None:
        """Which of its points act at unknowns y (n,); None where it has no such choice."""
        del y
        return None

    def holding(self, active: BoolArray | None) -> Self:
        """The item with these points acting, whatever the state; by itself again with None."""
        del active
        return self

    def at_press(self, share: float) -> Self | None:
        """The item to begin with under a share of the last press, above 1 under more; None if it is this one."""
        del share
        return None

    @property
    def is_beyond(self) -> bool:
        """Whether it may be followed over limit points."""
        return False

    def beyond_limits(self) -> Self | None:
        """The item that may be followed over limit points; None if it is this one, or may not."""
        return None

    def lets_go(self, press: float) -> str:
        """Why it cannot hold a press in N, whatever the state, or ""."""
        del press
        return ""

    def is_sound(self, y: FloatArray) -> bool:
        """Whether what lies between its points at unknowns y (n,) is near enough to where the points are."""
        del y
        return True

    def warning(self, y: FloatArray) -> str:
        """What a person must know of an accepted state, or ""."""
        del y
        return ""
