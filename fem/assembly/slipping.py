"""Nodes of one side of an interface that slide along the other side once the shear stress reaches a limit.

A node stands on the other side's curve x(s) (see :mod:`fem.assembly.curve`), at first where it was at rest, s = S. Its
slip s - S is an unknown, and so are the two components of p: the node is held on the curve by the force k p. With c
what it is off the curve, a function of displacements and slip, the potential is k p (c - e p / 2): p is c / e, e so
small that c is nothing. The equations have no large penalty, and Newton's method follows the curve.

Friction is Tresca's with as little elastic stick, k / e, per area at rest: the force along the curve is at most the
limit, its work over a slip ds is that force times |x'| ds. The tangent leaves out how the displacements change the
stretch |x'| in it, which keeps it symmetric. Whether a node slips follows from the force that holds it and from its
slip, the primal-dual active set (M. Hintermueller, K. Ito and K. Kunisch, SIAM J. Optim. 13 (2002) 865).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.assembly.curve import Curve

TURN = 0.03  # of k, by which a node's slip counts against the force along the curve
OWN = ((0, 2), (1, 3), (2, 2), (3, 3), (2, 4), (3, 4), (4, 4))  # unknowns of a node that its stiffness couples


@dataclass(frozen=True)
class Grip:
    """Forces at one state of m nodes on a curve of n nodes.

    Attributes
    ----------
    force
        Internal forces (5, m) in N on the own unknowns of the nodes; those of p are what its equations leave, times k.
    curve_force
        Internal forces (2, n) in N on the curve's nodes.
    stiffness
        (7, m) in N/m, in the order of `OWN`.
    curve_stiffness
        (2, 2, m, n) in N/m: of p, then of the slip, with the curve's radial and vertical displacements.
    friction
        Force (m,) in N by the slip, along the curve times its stretch.
    stretch
        Length (m,) of the curve over its length at rest.
    """

    force: FloatArray
    curve_force: FloatArray
    stiffness: FloatArray
    curve_stiffness: FloatArray
    friction: FloatArray
    stretch: FloatArray


@dataclass(frozen=True)
class Slipping:
    """The nodes of one side and what they remember.

    Attributes
    ----------
    curve
        The other side.
    start
        Radii (m,) in m at which the nodes stand at rest.
    own
        Unknowns (5, m): radial and vertical displacement, the components of p, slip.
    along
        Unknowns (2, n) of the displacements of the curve's nodes, -1 where fixed.
    hold
        k (m,) in N/m.
    give
        e, of which the elastic slip is made as well.
    limit
        Largest friction (m,) in N.
    anchor
        Slip (m,) in m at which there is no friction.
    """

    curve: Curve
    start: FloatArray
    own: IntArray
    along: IntArray
    hold: FloatArray
    give: float
    limit: FloatArray
    anchor: FloatArray

    @property
    def rubs(self) -> bool:
        """Whether there is friction, which remembers."""
        return bool(self.limit.any())

    def grip(self, y: FloatArray) -> Grip | None:
        """Forces and stiffness at unknowns y (n,); None where a node is beyond an end of the curve."""
        u, k = np.append(y, 0.0), self.hold
        *moved, p_r, p_z, slip = u[self.own]
        weights = self.curve.weights(self.start + slip)
        if weights is None:
            return None
        place, rate, bend = np.einsum("dcmn,cn->dcm", weights, u[self.along])
        place[0] += slip
        rate[0] += 1.0
        held = k * np.stack((p_r, p_z))
        pull = (held * rate).sum(axis=0)
        friction, slope = self._friction(slip, pull, np.hypot(*rate), (rate * bend).sum(axis=0))
        left = k * (np.stack(moved) - place) - self.give * held
        soft = -self.give * k
        return Grip(
            force=np.concatenate((held, left, (friction - pull)[None])),
            curve_force=-np.einsum("cm,cmn->cn", held, weights[0]),
            stiffness=np.concatenate(
                (np.stack((k, k, soft, soft)), -k * rate, (slope - (held * bend).sum(axis=0))[None])
            ),
            curve_stiffness=-np.stack((k[:, None] * weights[0], held[..., None] * weights[1])),
            friction=friction,
            stretch=np.hypot(*rate),
        )

    def _friction(
        self, slip: FloatArray, pull: FloatArray, stretch: FloatArray, turn: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Friction and its derivative by the slip (m,); turn is half the derivative of the squared stretch."""
        limit, stick = self.limit * stretch, self.hold / self.give
        slid = slip - self.anchor
        trial = pull + TURN * (self.hold * slid - self.give * pull)
        sticks = np.abs(trial) < limit
        friction = np.where(sticks, stick * slid, np.copysign(limit, trial))
        return friction, np.where(sticks, stick, friction * turn / stretch**2)

    def after(self, y: FloatArray) -> Slipping:
        """The same after a step that ends at unknowns y (n,)."""
        grip = self.grip(y)
        if grip is None:
            raise ArithmeticError("an accepted state cannot be evaluated")
        return replace(self, anchor=y[self.own[4]] - grip.friction * self.give / self.hold)

    def add_force(self, grip: Grip, residual: FloatArray) -> None:
        """Add the forces to those on the unknowns (n,), in place."""
        free = self.along >= 0
        residual[self.own] += grip.force
        residual[self.along[free]] += grip.curve_force[free]

    def on_fixed(self, grip: Grip) -> float:
        """Upward force in N on nodes that are fixed."""
        return float(grip.curve_force[1][self.along[1] < 0].sum())

    @cached_property
    def entries(self) -> tuple[IntArray, IntArray]:
        """Rows and columns (k,) of the stiffness, wherever the nodes stand; none of what is fixed."""
        count, free = self.along.shape[1], self._free
        rows = [*(self.own[a] for a, _ in OWN), *(self.own[a].repeat(count) for a in (2, 3, 4, 4))]
        columns = [*(self.own[b] for _, b in OWN), *(np.tile(self.along[c], len(self.start)) for c in (0, 1, 0, 1))]
        return np.concatenate(rows)[free], np.concatenate(columns)[free]

    def values(self, grip: Grip) -> FloatArray:
        """Stiffness (k,) in N/m at the `entries`."""
        return np.concatenate((grip.stiffness.ravel(), grip.curve_stiffness.ravel()))[self._free]

    @cached_property
    def _free(self) -> IntArray:
        """Which of all rows and columns are not fixed."""
        count = len(self.start)
        fixed = np.broadcast_to((self.along < 0)[None, :, None], (2, 2, count, self.along.shape[1]))
        return np.flatnonzero(np.concatenate((np.ones(len(OWN) * count, dtype=np.bool_), ~fixed.ravel())))
