"""Nodes of one side of an interface that slide along the other side once the shear stress reaches a limit.

The other side is one smooth curve: the displacement between the nodes of its row (corners and mid-sides alike) is the
cubic spline through all of them, so that a node slides from element to element without a kink, and at rest, where the
nodes of both sides coincide, nothing is interpolated. On the axis the radial displacement is odd and the vertical even;
at the outer border the spline is natural.

A node stands on the curve x(s), at first where it was at rest, s = S. Its slip s - S is an unknown, and so are the two
components of p: the node is held on the curve by the force k p. With c what it is off the curve, a function of
displacements and slip, the potential is k p (c - e p / 2): p is c / e, e so small that c is nothing. The equations have
no large penalty, and Newton's method follows the curve.

Friction (:mod:`fem.interactions.active_set`) has as little elastic stick, k / e, per area at rest: the force along the
curve is at most the limit, its work over a slip ds is that force times |x'| ds. The tangent leaves out how the
displacements change the stretch |x'| in it, which keeps it symmetric. Whether a node slips follows from the force that
holds it and from its slip.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import solve_banded

from fem.arrays import FloatArray, IntArray
from fem.assembly.item import EquationItem, ItemForces
from fem.interactions.active_set import Friction

SLIP_SHARE = 0.03  # of k, by which a node's slip counts against the force along the curve
MOST_MET = 4  # of Newton's corrections of the slips that bring the curve to the nodes
OWN = ((0, 2), (1, 3), (2, 2), (3, 3), (2, 4), (3, 4), (4, 4))  # unknowns of a node that its stiffness couples


@dataclass(frozen=True)
class Curve:
    """A row of nodes.

    Attributes
    ----------
    radius
        Radii (n,) in m at rest, increasing from 0 on the axis.
    """

    radius: FloatArray

    def weights(self, s: FloatArray) -> FloatArray | None:
        """Weights of the nodes' displacements in that at a place and its first two derivatives by s.

        Parameters
        ----------
        s
            Places (m,) as radii at rest, in m.

        Returns
        -------
        ndarray or None
            (3 derivatives, 2 components r and z, m, n); None if a place is beyond an end of the row.
        """
        r = self.radius
        if not ((s >= r[0]) & (s <= r[-1])).all():
            return None
        start = np.clip(np.searchsorted(r, s, side="right") - 1, 0, len(r) - 2)
        length = r[start + 1] - r[start]
        b = (s - r[start]) / length
        a, one, zero = 1.0 - b, np.ones_like(b), np.zeros_like(b)
        left = np.stack((a, -one / length, zero))
        right = np.stack((b, one / length, zero))
        left_bend = np.stack(((a**3 - a) * length**2 / 6.0, (1.0 - 3.0 * a * a) * length / 6.0, a))
        right_bend = np.stack(((b**3 - b) * length**2 / 6.0, (3.0 * b * b - 1.0) * length / 6.0, b))
        out = np.stack(
            [left_bend[..., None] * bends[start] + right_bend[..., None] * bends[start + 1] for bends in self._bends],
            axis=1,
        )
        node = np.arange(len(s))
        out[:, :, node, start] += left[:, None]
        out[:, :, node, start + 1] += right[:, None]
        return out

    @cached_property
    def _bends(self) -> tuple[FloatArray, FloatArray]:
        """Second derivatives at the nodes, (n, n) by values there, of the radial and of the vertical displacement."""
        step, count = np.diff(self.radius), len(self.radius)
        right = np.zeros((count, count))
        inner = np.arange(1, count - 1)
        right[inner, inner - 1] = 1.0 / step[:-1]
        right[inner, inner + 1] = 1.0 / step[1:]
        right[inner, inner] = -right[inner, inner - 1] - right[inner, inner + 1]
        bands = np.zeros((3, count))
        bands[0, 2:], bands[2, :-2] = step[1:] / 6.0, step[:-1] / 6.0
        bands[1, 1:-1] = (step[:-1] + step[1:]) / 3.0
        bands[1, [0, -1]] = 1.0
        odd = solve_banded((1, 1), bands, right)
        bands[0, 1], bands[1, 0] = step[0] / 6.0, step[0] / 3.0
        right[0, :2] = np.array([-1.0, 1.0]) / step[0]
        return odd, solve_banded((1, 1), bands, right)


@dataclass(frozen=True)
class InterfaceState:
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
class InterfaceFriction(EquationItem):
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
    friction
        Friction of the nodes, with their slip as path.
    """

    curve: Curve
    start: FloatArray
    own: IntArray
    along: IntArray
    hold: FloatArray
    give: float
    friction: Friction

    @property
    def remembers(self) -> bool:
        """Friction remembers."""
        return self.friction.present

    def respond(self, y: FloatArray) -> ItemForces | None:
        """Forces and stiffness at unknowns y (n,); None where a node is beyond an end of the curve."""
        state = self.evaluate(y)
        if state is None:
            return None
        force = np.concatenate((state.force.ravel(), state.curve_force[self.along >= 0]))
        stiffness = np.concatenate((state.stiffness.ravel(), state.curve_stiffness.ravel()))[self._free]
        return ItemForces(force, stiffness, float(state.curve_force[1][self.along[1] < 0].sum()))

    def evaluate(self, y: FloatArray) -> InterfaceState | None:
        """State at unknowns y (n,); None where a node is beyond an end of the curve."""
        u, k = np.append(y, 0.0), self.hold
        *moved, p_r, p_z, slip = u[self.own]
        weights = self.curve.weights(self.start + slip)
        if weights is None:
            return None
        place, rate, bend = np.einsum("dcmn,cn->dcm", weights, u[self.along])
        place[0] += slip
        rate[0] += 1.0
        held = k * np.stack((p_r, p_z))
        pull, stretch = (held * rate).sum(axis=0), np.hypot(*rate)
        friction, slope = self._friction(slip, pull, stretch, (rate * bend).sum(axis=0))
        left = k * (np.stack(moved) - place) - self.give * held
        soft = -self.give * k
        return InterfaceState(
            force=np.concatenate((held, left, (friction - pull)[None])),
            curve_force=-np.einsum("cm,cmn->cn", held, weights[0]),
            stiffness=np.concatenate(
                (np.stack((k, k, soft, soft)), -k * rate, (slope - (held * bend).sum(axis=0))[None])
            ),
            curve_stiffness=-np.stack((k[:, None] * weights[0], held[..., None] * weights[1])),
            friction=friction,
            stretch=stretch,
        )

    def _friction(
        self, slip: FloatArray, pull: FloatArray, stretch: FloatArray, turn: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Friction and its derivative by the slip (m,); turn is half the derivative of the squared stretch."""
        if not self.friction.present:
            return np.zeros_like(slip), np.zeros_like(slip)
        stick, slid = self.friction.stick, slip - self.friction.anchor
        trial = pull + SLIP_SHARE * (self.hold * slid - self.give * pull)
        friction, sticks = self.friction.drag(trial, stick * slid, stretch)
        return friction, np.where(sticks, stick, friction * turn / stretch**2)

    def accepted(self, y: FloatArray) -> InterfaceFriction:
        """The item after a step that ends at unknowns y (n,)."""
        state = self.evaluate(y)
        if state is None:
            raise ArithmeticError("an accepted state cannot be evaluated")
        return replace(self, friction=self.friction.after(y[self.own[4]], state.friction * self.give / self.hold))

    def met(self, y: FloatArray) -> FloatArray:
        """The unknowns (n,) with the slips that bring the curve to the nodes' radii; as they are if nothing does."""
        u, slip = np.append(y, 0.0), np.zeros(len(self.start))
        along = u[self.along[0]]
        for _ in range(MOST_MET):
            weights = self.curve.weights(self.start + slip)
            if weights is None:
                return y
            off = slip + weights[0, 0] @ along - u[self.own[0]]
            slip = slip - off / (1.0 + weights[1, 0] @ along)
        out = y.copy()
        out[self.own[4]] = slip
        return out

    def led(self, y: FloatArray) -> InterfaceFriction:
        """The item after a way from rest to unknowns y (n,) of another mesh."""
        return replace(self, friction=self.friction.led(y[self.own[4]]))

    @property
    def unknowns(self) -> IntArray:
        """Unknowns (k,): those of the nodes, then the free ones of the curve."""
        return np.concatenate((self.own.ravel(), self.along[self.along >= 0]))

    @cached_property
    def entries(self) -> tuple[IntArray, IntArray]:
        """Rows and columns (e,) of the stiffness, wherever the nodes stand; none of what is fixed."""
        count, free = self.along.shape[1], self._free
        rows = [*(self.own[a] for a, _ in OWN), *(self.own[a].repeat(count) for a in (2, 3, 4, 4))]
        columns = [*(self.own[b] for _, b in OWN), *(np.tile(self.along[c], len(self.start)) for c in (0, 1, 0, 1))]
        return np.concatenate(rows)[free], np.concatenate(columns)[free]

    @cached_property
    def _free(self) -> IntArray:
        """Which of all rows and columns are not fixed."""
        count = len(self.start)
        fixed = np.broadcast_to((self.along < 0)[None, :, None], (2, 2, count, self.along.shape[1]))
        return np.flatnonzero(np.concatenate((np.ones(len(OWN) * count, dtype=np.bool_), ~fixed.ravel())))
