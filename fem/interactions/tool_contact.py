"""Nodes of the surface against a rigid punch: a multiplier a node, more of them with friction; adhesion.

The multiplier x of a node is a length: its force is k x, k the node's penalty. In touch g = -x, so a node enters the
punch by about 1e-5 of the punch's radius where the pressure equals the surface layer's shear modulus; out of touch
x = 0. The potential -k x g - k x^2 / 2 is symmetric.

Friction has a multiplier for each direction on the punch (see :mod:`fem.interactions.active_set`); its limit is given
within one Newton run, and runs follow each other until it fits the pressure. With adhesion the nodes of the flat
face are held both ways once the punch has pressed, until it pulls more than its adhesion.

A node has c displacements, the vertical one last: two in axial symmetry, three in three dimensions.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Self

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.assembly.item import EquationItem, ItemForces
from fem.interactions.active_set import Friction, in_touch
from fem.interactions.punch import Gap, Punch

LOOSE = 1e-12  # stiffness of a punch in the air, in penalties
ROUND_OFF = 1e-9  # of the largest press or of what adhesion holds, up to which a pull is none, or not more
MOST_ENTRY = 0.5
"""Of the edge radius, by which the surface may enter the punch between its nodes; at 0.27 the depth was within 0.5 % of
that of much smaller elements."""


@dataclass(frozen=True)
class Touch:
    """Contact at one state: forces on (node, punch, multipliers) and their derivative.

    Attributes
    ----------
    force
        Internal forces (c + 2, m) in N, with friction (2 c + 1, m): against the motion of node and punch; those of the
        multipliers are what their equations leave, times k.
    stiffness
        In N/m, in the order of :attr:`ToolContact.pairs`.
    elastic
        Elastic slip (c - 1, m) in m along the punch.
    path
        Path (c - 1, m) in m of the nodes on the punch.
    push
        Force (m,) in N of punch and node on each other.
    press
        Force in N of the punch on the tissue, downwards.
    """

    force: FloatArray
    stiffness: FloatArray
    elastic: FloatArray
    path: FloatArray
    push: FloatArray
    press: float


@dataclass(frozen=True)
class ToolContact(EquationItem):
    """Candidate nodes and what they remember.

    Attributes
    ----------
    punch
        The punch.
    place
        Nodes (c, m) at rest, in m.
    own
        Unknowns (c + 2, m): displacements of the node, -1 where fixed, of the punch, multiplier; with friction
        (2 c + 1, m): its multipliers.
    friction
        Friction of the nodes, with their path (c - 1, m) on the punch; its `stick` is the stiffness k (m,) in N/m of
        each node against the punch.
    pressed
        Whether the punch has pressed and has not come off since.
    peak
        Largest press so far in N.
    held
        Nodes (m,) that touch, whatever the state; None where multiplier and gap decide.
    axis
        Which node lies on the axis and which is next to it; None in three dimensions.
    joined
        Whether the one on the axis also touches where the next one does: without area of its own it gets of a pressure
        p(r) no more than a force of the order p'' r^4, whose sign says nothing of p.
    """

    punch: Punch
    place: FloatArray
    own: IntArray
    friction: Friction
    pressed: bool = False
    peak: float = 0.0
    held: BoolArray | None = None
    axis: tuple[int, int] | None = None
    joined: bool = False

    def touch(self, y: FloatArray) -> Touch | None:
        """Contact at unknowns y (n,); None where a node is deep inside the punch."""
        c, penalty = len(self.place), self.friction.stick
        u, gap = np.append(y, 0.0)[self.own], self._gap(y)
        if gap is None:
            return None
        touches = self._touching(u[c + 1], gap) if self.held is None else self.held
        active = (touches | self._adheres) * penalty
        push, rate = active * u[c + 1], with_punch(gap.normal)
        left = -active * gap.distance - penalty * u[c + 1]
        force = np.concatenate((-push * rate, left[None]))
        stiffness = np.concatenate((-push * bend_with_punch(gap), -active * rate, -penalty[None]))
        touch = Touch(force, stiffness, np.zeros_like(gap.path), gap.path, push, -float(force[c].sum()))
        return touch if self.punch.friction == 0.0 else self._with_friction(gap, u[c + 2 :], touch)

    def _with_friction(self, gap: Gap, multiplier: FloatArray, touch: Touch) -> Touch:
        """With the friction multipliers (c - 1, m) in m."""
        c, k, metric = len(self.place), self.friction.stick, self.punch.metric(self.friction.anchor)
        drag = self.friction.multiplier_drag(multiplier, _apply(metric, gap.path - self.friction.anchor))
        rates = [with_punch(rate) for rate in _apply(metric, gap.along)]
        force, stiffness = touch.force.copy(), touch.stiffness.copy()
        for against, rate in zip(drag.force, rates, strict=True):
            force[: c + 1] += against * rate
        if drag.turning is not None:
            i, j = np.triu_indices(c + 1)
            for a, b in itertools.product(range(c - 1), repeat=2):
                stiffness[: len(i)] += drag.turning[a, b] * rates[a][i] * rates[b][j]
        more = [part for rate in rates for part in (drag.sticks * k * rate, -k[None])]
        force = np.concatenate((force, drag.left))
        elastic, press = _undo(metric, drag.force / k), -float(force[c].sum())
        return Touch(force, np.concatenate((stiffness, *more)), elastic, gap.path, touch.push, press)

    def respond(self, y: FloatArray) -> ItemForces | None:
        """Forces and stiffness at unknowns y (n,); a punch in the air keeps a trace of stiffness."""
        touch = self.touch(y)
        if touch is None:
            return None
        loose = LOOSE * float(self.friction.stick.sum())
        stiffness = np.append(touch.stiffness.ravel(), loose)[self._free_pairs]
        return ItemForces(touch.force.ravel()[self._free], stiffness)

    @cached_property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Which unknowns each row of a touch's stiffness couples."""
        moving = range(len(self.place) + 1)
        pairs = list(itertools.combinations_with_replacement(moving, 2))
        for multiplier in range(len(moving), len(self.own)):
            pairs += [*((i, multiplier) for i in moving), (multiplier, multiplier)]
        return tuple(pairs)

    @property
    def unknowns(self) -> IntArray:
        """Unknowns (k,) of nodes, punch and multipliers that are not fixed."""
        return self.own.ravel()[self._free]

    @property
    def entries(self) -> tuple[IntArray, IntArray]:
        """Rows and columns (e,) of the stiffness, the punch's own one last."""
        rows, columns = self._all_entries
        return rows[self._free_pairs], columns[self._free_pairs]

    @cached_property
    def _all_entries(self) -> tuple[IntArray, IntArray]:
        first, second = zip(*self.pairs, strict=True)
        rows, columns = (np.concatenate([*(self.own[n] for n in side), [self.tool]]) for side in (first, second))
        return rows, columns

    @cached_property
    def _free(self) -> IntArray:
        return np.flatnonzero(self.own.ravel() >= 0)

    @cached_property
    def _free_pairs(self) -> IntArray:
        rows, columns = self._all_entries
        return np.flatnonzero((rows >= 0) & (columns >= 0))

    @property
    def tool(self) -> int:
        """Unknown of the punch's displacement."""
        return int(self.own[len(self.place), 0])

    @property
    def remembers(self) -> bool:
        """Friction remembers."""
        return self.punch.friction > 0.0

    @property
    def _adheres(self) -> BoolArray:
        """Nodes (m,) that are held both ways."""
        held = self.punch.under_face(self.place)
        return held if self.pressed and self.punch.adhesion > 0.0 else np.zeros_like(held)

    def accepted(self, y: FloatArray) -> ToolContact:
        """The item after a step that ends at unknowns y (n,)."""
        touch = self.touch(y)
        if touch is None:
            raise ArithmeticError("an accepted state cannot be evaluated")
        friction = self.friction.after(touch.path, touch.elastic)
        pressed, peak = self.pressed or touch.press > 0.0, max(self.peak, touch.press)
        return replace(self, friction=friction, pressed=pressed, peak=peak)

    def led(self, y: FloatArray) -> ToolContact:
        """The contact after a way from rest to unknowns y (n,) of another mesh; whether it pressed is not told."""
        gap = self._gap(y)
        return self if gap is None else replace(self, friction=self.friction.led(gap.path))

    def pressed_as(self, y: FloatArray, other: Self, theirs: FloatArray, *, pressed: bool) -> tuple[FloatArray, Self]:
        """Multipliers and friction limits by how far another mesh's nodes are inside the punch.

        As they are where one of those nodes is deep inside. Of a face that adheres and has pressed, nodes outside pull.
        """
        gap = other._gap(theirs)
        if gap is None:
            return y, self
        row = np.argsort(other.place[0])
        entry: FloatArray = np.interp(self.place[0], other.place[0][row], -gap.distance[row])
        inside, out = np.maximum(entry, 0.0), y.copy()
        limit = self.punch.friction * self.friction.stick * inside
        if pressed and self.punch.adhesion > 0.0:
            inside = np.where(self.punch.under_face(self.place), entry, inside)
        out[self.own[len(self.place) + 1]] = inside
        return out, replace(self, pressed=pressed, friction=self.friction.with_limit(limit))

    @property
    def follows_pressure(self) -> bool:
        """Coulomb's limits do."""
        return self.punch.friction > 0.0

    @property
    def touches_by_point(self) -> bool:
        """A sphere does."""
        return self.punch.face <= 0.0

    def corrected(self, y: FloatArray, press: float) -> ToolContact | None:
        """The contact that fits a state with a press in N, where this one does not; None where it does.

        It comes off where the punch pulls more than it holds; the friction limit follows the pressure.
        """
        touch = self.touch(y)
        if touch is None:
            return None
        if self.pressed and self.punch.adhesion > 0.0 and press < -self.punch.adhesion:
            return replace(self, pressed=False)
        limit = self.punch.friction * np.maximum(touch.push, 0.0)
        friction = self.friction.following(limit, max(abs(press), self.peak))
        return None if friction is None else replace(self, friction=friction)

    def fitted(self, y: FloatArray) -> ToolContact:
        """The contact whose friction limits are those of unknowns y (n,)."""
        touch = None if self.punch.friction == 0.0 else self.touch(y)
        if touch is None:
            return self
        limit = self.punch.friction * np.maximum(touch.push, 0.0)
        return replace(self, friction=self.friction.with_limit(limit))

    @property
    def settled(self) -> FloatArray:
        """Whether the punch has pressed and the axis' node is joined, and the friction limits in N: (2 + m,)."""
        return np.concatenate(([self.pressed, self.joined], self.friction.limit))

    def as_settled(self, chosen: FloatArray) -> ToolContact:
        """The contact with these."""
        pressed, joined = bool(chosen[0]), bool(chosen[1])
        return replace(self, pressed=pressed, joined=joined, friction=self.friction.with_limit(chosen[2:]))

    def active(self, y: FloatArray) -> BoolArray | None:
        """Which nodes (m,) touch at unknowns y (n,)."""
        gap = self._gap(y)
        return None if gap is None else self._touching(y[self.own[len(self.place) + 1]], gap)

    def _gap(self, y: FloatArray) -> Gap | None:
        """The gap at unknowns y (n,); None where a node is deep inside the punch."""
        c, u = len(self.place), np.append(y, 0.0)[self.own]
        place = self.place + u[:c]
        place[-1] -= u[c]
        return self.punch.gap(place)

    def _touching(self, multiplier: FloatArray, gap: Gap) -> BoolArray:
        """Which nodes (m,) multipliers (m,) in m and gap have touch."""
        touches = in_touch(multiplier, gap.distance)
        if self.axis is not None and self.joined:
            middle, beside = self.axis
            touches[middle] |= touches[beside]
        return touches

    @property
    def is_beyond(self) -> bool:
        """Once the node on the axis is joined to the next one."""
        return self.joined

    def beyond_limits(self) -> ToolContact | None:
        """With the node on the axis joined to the next one, where there is an axis."""
        return None if self.axis is None or self.joined else replace(self, joined=True)

    def lets_go(self, press: float) -> str:
        """A pull by more than adhesion holds has no equilibrium, and none that has not pressed before holds any."""
        held = self.punch.adhesion if self.pressed else 0.0
        if press >= -held - ROUND_OFF * max(self.peak, held):
            return ""
        return f"the tool lets go of the tissue: it is pulled by more than {held:.4g} N, which is what adhesion holds"

    def is_sound(self, y: FloatArray) -> bool:
        """Whether the surface keeps out of the punch between its nodes, too; in axial symmetry only."""
        if self.axis is None:
            return True
        row, u = np.argsort(self.place[0]), np.append(y, 0.0)[self.own]
        place = (self.place + u[:2])[:, row]
        place[1] -= u[2]
        odd = len(row) - 1 + len(row) % 2
        first, middle, last = place[:, : odd - 2 : 2], place[:, 1 : odd - 1 : 2], place[:, 2:odd:2]
        quarter = [(3.0 * near + 6.0 * middle - far) / 8.0 for near, far in ((first, last), (last, first))]
        gap = self.punch.gap(np.concatenate(quarter, axis=1))
        return gap is not None and float(gap.distance.min()) >= -MOST_ENTRY * self.punch.edge_radius

    def holding(self, active: BoolArray | None) -> ToolContact:
        """The contact with these nodes in touch, whatever the state."""
        return replace(self, held=active)

    def at_press(self, share: float) -> ToolContact | None:
        """The contact with a share of the friction limits; None without friction."""
        if self.punch.friction == 0.0:
            return None
        return replace(self, friction=self.friction.with_limit(share * self.friction.limit))


def with_punch(rate: FloatArray) -> FloatArray:
    """By node and punch, (c + 1, m), of a derivative by the node's place, (c, m)."""
    return np.concatenate((rate, -rate[-1:]))


def bend_with_punch(gap: Gap) -> FloatArray:
    """Second derivative of the distance by node and punch, its upper triangle row by row."""
    order, sign = _bend_order(len(gap.normal))
    out: FloatArray = sign * gap.bend[order]
    return out


@cache
def _bend_order(c: int) -> tuple[IntArray, FloatArray]:
    """Which derivative by the node's place is that by node and punch, and its sign (pairs, 1)."""
    i, j = np.triu_indices(c + 1)
    packed = np.zeros((c, c), dtype=np.int64)
    packed[np.triu_indices(c)] = np.arange(c * (c + 1) // 2)
    sign = np.where((i == c) != (j == c), -1.0, 1.0)
    return packed[np.minimum(i, c - 1), np.minimum(j, c - 1)], sign[:, None]


def _apply(metric: FloatArray, values: FloatArray) -> FloatArray:
    """Matrix (t, t, m) times values (t, ..., m)."""
    if len(metric) == 1:
        return values
    out: FloatArray = np.einsum("abm,b...m->a...m", metric, values)
    return out


def _undo(metric: FloatArray, values: FloatArray) -> FloatArray:
    """Values (t, m) divided by a symmetric matrix (t, t, m)."""
    if len(metric) == 1:
        return values
    out: FloatArray = np.linalg.solve(metric.T, values.T[..., None]).astype(np.float64)[..., 0].T
    return out
