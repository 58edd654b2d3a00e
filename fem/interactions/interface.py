"""The deformed lower side of an interface as one smooth curve.

The displacement between the nodes of the row (corners and mid-sides alike) is the cubic spline through all of them: the
curve's tangent and curvature are continuous, so that a node slides from element to element without a kink, and at rest,
where the nodes of both sides coincide, nothing is interpolated. On the axis the radial displacement is odd and the
vertical even; at the outer border the spline is natural.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import solve_banded

from fem.arrays import FloatArray, IntArray


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
