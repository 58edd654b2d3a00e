"""The discrete equations of a body under a rigid punch that touches its surface.

The last unknowns are the punch's displacement and the multipliers of the nodes (see :mod:`fem.contact.touching`).
"""

from __future__ import annotations

import copy
from dataclasses import dataclass, fields, replace

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.assembly import ElementGeometry, ElementLaws, Evaluation, Numbering, Scatter, System
from fem.assembly.pattern import widened
from fem.contact.touching import LOOSE, Contact, Touch


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
