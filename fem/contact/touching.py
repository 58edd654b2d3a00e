"""Nodes of the surface against a rigid punch: a multiplier a node, a second one with friction; adhesion.

The multiplier x of a node is a length: its force is k x, k the node's penalty. In touch g = -x, so a node enters the
punch by about 1e-5 of the punch's radius where the pressure equals the surface layer's shear modulus; out of touch
x = 0. A node touches where x >= share * g, share a small number: the primal-dual active set (M. Hintermueller, K. Ito
and K. Kunisch, SIAM J. Optim. 13 (2002) 865), with the symmetric potential -k x g - k x^2 / 2.

Friction is Coulomb's law with as little elastic stick and a multiplier of its own (P. Wriggers, Computational Contact
Mechanics, 2nd ed., 2006, chapters 5 and 6); within one Newton run its limit is given (Tresca's law, which keeps the
stiffness symmetric), and runs follow each other until the limit fits the pressure. With adhesion the nodes of the flat
face are held both ways once the punch has pressed, until it pulls more than its adhesion.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.contact.punch import Gap, Punch

STIFFNESS = 1e5  # penalty in shear moduli of the surface layer over the punch's radius
SHARE = 1e-3  # of the penalty, by which a gap counts against a multiplier
TURN = 1e-5  # the same for slip against the multiplier of friction; larger ones make the slip turn to and fro
SETTLED = 1e-6  # change of all friction limits, over the press, that ends these runs
LOOSE = 1e-12  # stiffness of a punch in the air, in penalties
ENTRIES = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2), (0, 3), (1, 3), (2, 3), (3, 3))
FRICTION_ENTRIES = ((0, 4), (1, 4), (2, 4), (4, 4))


@dataclass(frozen=True)
class Touch:
    """Contact at one state: forces on (node r, node z, punch, multiplier) and their derivative.

    Attributes
    ----------
    force
        Internal forces (4 or 5, m) in N: against the motion of node and punch; those of the multipliers are what their
        equations leave, times k.
    stiffness
        (10 or 14, m) in N/m, in the order of `ENTRIES` and, with friction, `FRICTION_ENTRIES`.
    anchor
        Path (m,) in m on the punch at which friction would be zero.
    push
        Force (m,) in N of punch and node on each other.
    """

    force: FloatArray
    stiffness: FloatArray
    anchor: FloatArray
    push: FloatArray


@dataclass(frozen=True)
class Contact:
    """Candidate nodes and what they remember.

    Attributes
    ----------
    punch
        The punch.
    place
        Radius and height (2, m) of the nodes at rest, in m.
    penalty
        Stiffness k (m,) of each node against the punch in N/m.
    unknowns
        Unknowns (4, m): radial and vertical displacement of the node, -1 where fixed, of the punch, multiplier; with
        friction (5, m): its multiplier.
    anchor
        Path (m,) in m on the punch at which friction is zero.
    limit
        Largest friction (m,) in N.
    pressed
        Whether the punch has pressed and has not come off since.
    peak
        Largest press so far in N.
    """

    punch: Punch
    place: FloatArray
    penalty: FloatArray
    unknowns: IntArray
    anchor: FloatArray
    limit: FloatArray
    pressed: bool = False
    peak: float = 0.0

    def touch(self, y: FloatArray) -> Touch | None:
        """Contact at unknowns y (n,); None where a node is deep inside the punch."""
        u = np.append(y, 0.0)[self.unknowns]
        gap = self.punch.gap(self.place[0] + u[0], self.place[1] + u[1] - u[2])
        if gap is None:
            return None
        active = ((u[3] >= SHARE * gap.distance) | self._glued) * self.penalty
        push, rate = active * u[3], _three(gap.normal)
        left = -active * gap.distance - self.penalty * u[3]
        force = np.concatenate((-push * rate, left[None]))
        stiffness = np.concatenate((-push * _bend(gap), -active * rate, -self.penalty[None]))
        touch = Touch(force, stiffness, gap.path, push)
        return touch if self.punch.friction == 0.0 else self._with_friction(gap, u[4], touch)

    def _with_friction(self, gap: Gap, drawn: FloatArray, touch: Touch) -> Touch:
        """With the friction multipliers (m,) in m."""
        limit, k, slid = self.limit, self.penalty, gap.path - self.anchor
        trial = k * (drawn + TURN * (slid - drawn))
        sticks = np.abs(trial) <= limit
        drag = np.where(sticks, k * drawn, np.clip(trial, -limit, limit))
        left = np.where(sticks, k * (slid - drawn), drag - k * drawn)
        rate = _three(gap.along)
        force = np.concatenate((touch.force[:3] + drag * rate, touch.force[3:], left[None]))
        stiffness = np.concatenate((touch.stiffness, sticks * k * rate, -k[None]))
        return Touch(force, stiffness, gap.path - drag / k, touch.push)

    @property
    def entries(self) -> tuple[tuple[int, int], ...]:
        """Which unknowns each row of a touch's stiffness couples."""
        return ENTRIES if self.punch.friction == 0.0 else ENTRIES + FRICTION_ENTRIES

    @property
    def _glued(self) -> BoolArray:
        """Nodes (m,) that are held both ways."""
        held = self.place[0] <= self.punch.face
        return held if self.pressed and self.punch.adhesion > 0.0 else np.zeros_like(held)

    def after(self, touch: Touch, press: float) -> Contact:
        """What is remembered after a state with this contact, in which the punch presses (N)."""
        return replace(self, anchor=touch.anchor, pressed=self.pressed or press > 0.0, peak=max(self.peak, press))

    def corrected(self, touch: Touch, press: float) -> Contact | None:
        """The contact that fits a state with a press in N, where this one does not; None where it does.

        It comes off where the punch pulls more than it holds; the friction limit follows the pressure.
        """
        if self.pressed and self.punch.adhesion > 0.0 and press < -self.punch.adhesion:
            return replace(self, pressed=False)
        limit = self.punch.friction * np.maximum(touch.push, 0.0)
        if np.abs(limit - self.limit).sum() <= SETTLED * max(abs(press), self.peak):
            return None
        return replace(self, limit=limit)


def _three(rate: FloatArray) -> FloatArray:
    """By (node r, node z, punch) of a derivative by (r, h), (2, m)."""
    return np.stack((rate[0], rate[1], -rate[1]))


def _outer(rate: FloatArray) -> FloatArray:
    a, b = rate
    return np.stack((a * a, a * b, -a * b, b * b, -b * b, b * b))


def _bend(gap: Gap) -> FloatArray:
    rr, rh, hh = gap.bend
    return np.stack((rr, rh, -rh, hh, -hh, hh))
