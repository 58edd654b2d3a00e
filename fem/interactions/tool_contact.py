"""Nodes of the surface against a rigid punch: a multiplier a node, more of them with friction; adhesion.

The multiplier x of a node is a length: its force is k x, k the node's penalty. In touch g = -x, so a node enters the
punch by about 1e-5 of the punch's radius where the pressure equals the surface layer's shear modulus; out of touch
x = 0. A node touches where x >= share * g, share a small number: the primal-dual active set (M. Hintermueller, K. Ito
and K. Kunisch, SIAM J. Optim. 13 (2002) 865), with the symmetric potential -k x g - k x^2 / 2.

Friction has a multiplier for each direction on the punch (see :mod:`fem.interactions.active_set`); its limit is given
within one Newton run, and runs follow each other until it fits the pressure. With adhesion the nodes of the flat
face are held both ways once the punch has pressed, until it pulls more than its adhesion.

A node has c displacements, the vertical one last: two in axial symmetry, three in three dimensions.
"""

from __future__ import annotations

import copy
import itertools
from dataclasses import dataclass, fields, replace
from functools import cache, cached_property

import numpy as np

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.scatter import Numbering, Scatter, widened
from fem.assembly.system import Evaluation, System
from fem.interactions.active_set import rub
from fem.interactions.punch import Gap, Punch
from fem.materials.element_laws import ElementLaws

STIFFNESS = 1e5  # penalty in shear moduli of the surface layer over the punch's radius
SHARE = 1e-3  # of the penalty, by which a gap counts against a multiplier
SETTLED = 1e-6  # change of all friction limits, over the press, that ends these runs
LOOSE = 1e-12  # stiffness of a punch in the air, in penalties


@dataclass(frozen=True)
class Touch:
    """Contact at one state: forces on (node, punch, multipliers) and their derivative.

    Attributes
    ----------
    force
        Internal forces (c + 2, m) in N, with friction (2 c + 1, m): against the motion of node and punch; those of the
        multipliers are what their equations leave, times k.
    stiffness
        In N/m, in the order of :attr:`Contact.entries`.
    anchor
        Path (c - 1, m) in m on the punch at which friction would be zero.
    push
        Force (m,) in N of punch and node on each other.
    press
        Force in N of the punch on the tissue, downwards.
    """

    force: FloatArray
    stiffness: FloatArray
    anchor: FloatArray
    push: FloatArray
    press: float


@dataclass(frozen=True)
class Contact:
    """Candidate nodes and what they remember.

    Attributes
    ----------
    punch
        The punch.
    place
        Nodes (c, m) at rest, in m.
    penalty
        Stiffness k (m,) of each node against the punch in N/m.
    unknowns
        Unknowns (c + 2, m): displacements of the node, -1 where fixed, of the punch, multiplier; with friction
        (2 c + 1, m): its multipliers.
    anchor
        Path (c - 1, m) in m on the punch at which friction is zero.
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
        c = len(self.place)
        u = np.append(y, 0.0)[self.unknowns]
        place = self.place + u[:c]
        place[-1] -= u[c]
        gap = self.punch.gap(place)
        if gap is None:
            return None
        active = ((u[c + 1] >= SHARE * gap.distance) | self._glued) * self.penalty
        push, rate = active * u[c + 1], with_punch(gap.normal)
        left = -active * gap.distance - self.penalty * u[c + 1]
        force = np.concatenate((-push * rate, left[None]))
        stiffness = np.concatenate((-push * bend_with_punch(gap), -active * rate, -self.penalty[None]))
        touch = Touch(force, stiffness, gap.path, push, -float(force[c].sum()))
        return touch if self.punch.friction == 0.0 else self._with_friction(gap, u[c + 2 :], touch)

    def _with_friction(self, gap: Gap, drawn: FloatArray, touch: Touch) -> Touch:
        """With the friction multipliers (c - 1, m) in m."""
        c, k, metric = len(self.place), self.penalty, self.punch.metric(self.anchor)
        slid = _apply(metric, gap.path - self.anchor)
        rubbed = rub(drawn, slid, self.limit, k)
        rates = [with_punch(rate) for rate in _apply(metric, gap.along)]
        force, stiffness = touch.force.copy(), touch.stiffness.copy()
        for drag, rate in zip(rubbed.drag, rates, strict=True):
            force[: c + 1] += drag * rate
        if rubbed.turning is not None:
            i, j = np.triu_indices(c + 1)
            for a, b in itertools.product(range(c - 1), repeat=2):
                stiffness[: len(i)] += rubbed.turning[a, b] * rates[a][i] * rates[b][j]
        more = [part for rate in rates for part in (rubbed.sticks * k * rate, -k[None])]
        force = np.concatenate((force, rubbed.left))
        press = -float(force[c].sum())
        return Touch(
            force, np.concatenate((stiffness, *more)), gap.path - _undo(metric, rubbed.drag / k), touch.push, press
        )

    @cached_property
    def entries(self) -> tuple[tuple[int, int], ...]:
        """Which unknowns each row of a touch's stiffness couples."""
        moving = range(len(self.place) + 1)
        pairs = list(itertools.combinations_with_replacement(moving, 2))
        for multiplier in range(len(moving), len(self.unknowns)):
            pairs += [*((i, multiplier) for i in moving), (multiplier, multiplier)]
        return tuple(pairs)

    @property
    def tool(self) -> int:
        """Unknown of the punch's displacement."""
        return int(self.unknowns[len(self.place), 0])

    @property
    def _glued(self) -> BoolArray:
        """Nodes (m,) that are held both ways."""
        held = self.punch.under_face(self.place)
        return held if self.pressed and self.punch.adhesion > 0.0 else np.zeros_like(held)

    def after(self, touch: Touch) -> Contact:
        """What is remembered after a state with this contact."""
        press = touch.press
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


@dataclass(frozen=True)
class TouchedEvaluation(Evaluation):
    """The equations at one state with the contact at it."""

    touch: Touch


class ContactSystem(System):
    """Residual and tangent with the contact.

    Parameters
    ----------
    geometry, laws, numbering, scatter, stabilisation
        See :class:`fem.assembly.System`; the last unknowns are the contact's.
    contact
        Nodes that may touch the punch.
    """

    def __init__(
        self,
        geometry: ElementGeometry,
        laws: ElementLaws,
        numbering: Numbering,
        scatter: Scatter,
        stabilisation: float,
        contact: Contact,
    ) -> None:
        u, tool = contact.unknowns, contact.tool
        rows, columns = (np.concatenate([*(u[k] for k in side), [tool]]) for side in zip(*contact.entries, strict=True))
        self._free = np.flatnonzero((rows >= 0) & (columns >= 0))
        wide, self._place = widened(scatter, numbering.count, rows[self._free], columns[self._free])
        super().__init__(geometry, laws, numbering, wide, stabilisation)
        self.contact = contact
        self._loose = LOOSE * float(contact.penalty.sum())

    @property
    def remembers(self) -> bool:
        """Whether a state depends on the states before it."""
        return super().remembers or self.contact.punch.friction > 0.0

    def evaluate(self, y: FloatArray, pressure: FloatArray) -> Evaluation | None:
        """Equations at unknowns y (n,) and pressure coefficients; None also where a node is deep inside the punch."""
        touch = self.contact.touch(y)
        body = None if touch is None else super().evaluate(y, pressure)
        if touch is None or body is None:
            return None
        residual = body.residual + self._sum(touch.force)
        found = {field.name: getattr(body, field.name) for field in fields(body)}
        return TouchedEvaluation(**{**found, "residual": residual}, touch=touch)

    def tangent(self, state: Evaluation) -> FloatArray:
        """Upper triangle (nnz,) of the tangent; a punch in the air keeps a trace of stiffness."""
        out = super().tangent(state)
        if isinstance(state, TouchedEvaluation):
            entries = np.append(state.touch.stiffness.ravel(), self._loose)[self._free]
            np.add.at(out, self._place, entries)
        return out

    def accepted(self, y: FloatArray) -> ContactSystem:
        """The equations after a step that ends at unknowns y (n,)."""
        touch = self.contact.touch(y)
        other = super().accepted(y)
        if touch is None or not isinstance(other, ContactSystem):
            raise ArithmeticError("an accepted state cannot be evaluated")
        other = copy.copy(other)
        other.contact = self.contact.after(touch)
        return other

    def corrected(self, y: FloatArray, press: float) -> ContactSystem | None:
        """The equations whose contact fits a state with unknowns y (n,) and a press in N; None if this one does."""
        touch = self.contact.touch(y)
        contact = None if touch is None else self.contact.corrected(touch, press)
        return None if contact is None else self._with(contact)

    def lightened(self, share: float) -> ContactSystem | None:
        """The equations with a share of the friction limits; None without friction."""
        if self.contact.punch.friction == 0.0:
            return None
        return self._with(replace(self.contact, limit=share * self.contact.limit))

    def _with(self, contact: Contact) -> ContactSystem:
        other = copy.copy(self)
        other.contact = contact
        return other

    def _sum(self, force: FloatArray) -> FloatArray:
        total: FloatArray = np.zeros(self.numbering.count + 1)
        np.add.at(total, self._unknowns, force)
        return total[:-1]

    @property
    def _unknowns(self) -> IntArray:
        return self.contact.unknowns
