"""The equations: residual and tangent on the unknowns, summed over elements and items.

Shapes of elements are those of :mod:`fem.assembly.elements`: k displacements and p pressures in each.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.assembly.elements import Elements, ElementState
from fem.assembly.item import EquationItem, ItemForces
from fem.assembly.scatter import Numbering, Scatter, widened
from fem.linear_solver.iterative import ElementTangent

GAUSS_POINTS = 5  # on the way from one state to another


@dataclass(frozen=True)
class Evaluation:
    """The equations at one state.

    Attributes
    ----------
    elements
        Forces of the elements.
    responses
        Those of the items.
    residual
        Their sum (n,) in N on the unknowns.
    """

    elements: ElementState
    responses: tuple[ItemForces, ...]
    residual: FloatArray


@dataclass(frozen=True)
class System:
    """Residual and tangent of elements and items.

    Attributes
    ----------
    elements
        The elements.
    numbering, scatter
        Unknowns, and the sums into them with the pattern of the tangent.
    items
        What acts besides the elements.
    places
        For each item the place of each of its entries in the tangent; see :func:`make_system`.
    offset
        Prescribed displacements (k, E) in m on top of those of the unknowns, or None.
    """

    elements: Elements
    numbering: Numbering
    scatter: Scatter
    items: tuple[EquationItem, ...] = ()
    places: tuple[IntArray, ...] = ()
    offset: FloatArray | None = None

    @property
    def remembers(self) -> bool:
        """Whether a state depends on the states before it."""
        return self.elements.memory is not None or any(item.remembers for item in self.items)

    @property
    def kinked(self) -> bool:
        """Whether the forces have kinks; see :class:`fem.assembly.item.EquationItem`."""
        return any(item.kinked for item in self.items)

    @property
    def follows_pressure(self) -> bool:
        """Whether an item has limits that are guessed; see :class:`fem.assembly.item.EquationItem`."""
        return any(item.follows_pressure for item in self.items)

    @property
    def touches_by_point(self) -> bool:
        """Whether an item begins at a point; see :class:`fem.assembly.item.EquationItem`."""
        return any(item.touches_by_point for item in self.items)

    def element_displacement(self, y: FloatArray) -> FloatArray:
        """Nodal displacements of each element (k, E) in m at the unknowns y (n,)."""
        u = self.scatter.gather(y)
        return u if self.offset is None else u + self.offset

    def rest(self) -> tuple[FloatArray, FloatArray]:
        """Unknowns (n,) and pressure coefficients (p, E) at rest."""
        return np.zeros(self.numbering.count), self.elements.rest_pressure

    def evaluate(self, y: FloatArray, pressure: FloatArray) -> Evaluation | None:
        """Equations at unknowns y (n,) and pressure coefficients (p, E).

        Returns
        -------
        Evaluation or None
            None where an element is turned inside out (J <= 0), an item has no answer or a value is not finite.
        """
        responses = self._responses(y)
        state = None if responses is None else self.elements.evaluate(self.element_displacement(y), pressure)
        if responses is None or state is None:
            return None
        residual = self.scatter.vector(state.force)
        for item, response in zip(self.items, responses, strict=True):
            np.add.at(residual, item.unknowns, response.force)
        return Evaluation(state, responses, residual) if np.isfinite(residual).all() else None

    def _responses(self, y: FloatArray) -> tuple[ItemForces, ...] | None:
        found = []
        for item in self.items:
            response = item.respond(y)
            if response is None:
                return None
            found.append(response)
        return tuple(found)

    def tangent(self, state: Evaluation) -> FloatArray:
        """Upper triangle (nnz,) of the tangent, the pressure condensed."""
        out = self.scatter.matrix_of_parts(self.elements.stiffness_parts(state.elements))
        for places, response in zip(self.places, state.responses, strict=True):
            np.add.at(out, places, response.stiffness)
        return out

    def element_tangent(self, state: Evaluation) -> ElementTangent:
        """The tangent of equations without items, element by element."""
        elements, at = self.elements, state.elements
        matrices, rest = elements.soft_matrices(at)
        return ElementTangent(matrices, at.coupling, rest, elements.laws.shear_modulus, lambda: self.tangent(state))

    def pressure_after(self, state: Evaluation, dy: FloatArray) -> FloatArray:
        """Pressure coefficients (p, E) after a Newton increment dy (n,) of the unknowns."""
        return self.elements.pressure_after(state.elements, self.scatter.gather(dy))

    def linear_pressure(self, rest: Evaluation, y: FloatArray) -> FloatArray:
        """Pressure coefficients (p, E) at small displacements y (n,)."""
        return self.elements.linear_pressure(rest.elements, self.element_displacement(y))

    def linear_force(self, rest: Evaluation, y: FloatArray) -> FloatArray:
        """Nodal forces (k, E) in N of small displacements y (n,), from the moduli at rest."""
        return self.elements.linear_force(rest.elements, self.element_displacement(y))

    def linear_residual(self, rest: Evaluation, y: FloatArray) -> FloatArray:
        """Forces (n,) of small displacements y (n,), from the moduli and the items at rest."""
        out = self.scatter.vector(self.linear_force(rest, y))
        for item, response in zip(self.items, rest.responses, strict=True):
            (rows, columns), values = item.entries, response.stiffness
            mirrored = np.where(rows == columns, 0.0, values)
            np.add.at(out, rows, values * y[columns])
            np.add.at(out, columns, mirrored * y[rows])
        return out

    def reaction(self, element_force: FloatArray, responses: tuple[ItemForces, ...] = ()) -> float:
        """Upward force in N of the support on the specimen, from element forces (k, E) and the items' responses.

        Internal forces in z add up to zero over all nodes, so what the support returns is minus the sum over the
        nodes that may move; an item may pull on fixed nodes as well.
        """
        last = -len(element_force) // len(self.numbering.unknown)
        vertical = element_force[last:][self.scatter.element_unknowns[last:] < self.numbering.count]
        return float(-vertical.sum()) + sum(response.support for response in responses)

    def advanced(self, duration: float) -> System:
        """The equations of a step that takes `duration` s from the last accepted state."""
        elements = self.elements.advanced(duration)
        return self if elements is self.elements else replace(self, elements=elements)

    def accepted(self, y: FloatArray) -> System:
        """The equations after a step that ends at unknowns y (n,); evaluated there they give its forces."""
        if self.elements.memory is None and not self.items:
            return self
        elements = self.elements.accepted(self.element_displacement(y))
        return replace(self, elements=elements, items=tuple(item.accepted(y) for item in self.items))

    def met(self, y: FloatArray) -> FloatArray:
        """The unknowns (n,) with the items' own as the displacements among them have it."""
        for item in self.items:
            y = item.met(y)
        return y

    def eased(self, share: float) -> System | None:
        """The equations with a share of what stiffness friction has below its limits; None where it has none."""
        return self._with([item.eased(share) for item in self.items])

    def tightened(self, y: FloatArray, share: float) -> FloatArray:
        """The eased equations' unknowns (n,) with points that stick where these equations have the same friction."""
        for item in self.items:
            y = item.tightened(y, share)
        return y

    def led(self, y: FloatArray) -> System:
        """The equations after a way from rest to unknowns y (n,) that are known from another mesh."""
        return replace(self, items=tuple(item.led(y) for item in self.items)) if self.items else self

    def pressed_as(
        self, y: FloatArray, other: System, theirs: FloatArray, *, pressed: bool
    ) -> tuple[FloatArray, System]:
        """Unknowns y (n,) and equations with the pressure of another mesh's at its unknowns (m,), item by item."""
        items = list(self.items)
        for n, (mine, their) in enumerate(zip(self.items, other.items, strict=True)):
            y, items[n] = mine.pressed_as(y, their, theirs, pressed=pressed)
        return y, replace(self, items=tuple(items))

    def corrected(self, y: FloatArray, press: float) -> System | None:
        """The equations that fit a state with unknowns y (n,) and a press in N; None if these do."""
        return self._with([item.corrected(y, press) for item in self.items])

    def fitted(self, y: FloatArray) -> System:
        """The equations whose limits are exactly those of a state with unknowns y (n,)."""
        return replace(self, items=tuple(item.fitted(y) for item in self.items)) if self.items else self

    @property
    def settled(self) -> FloatArray:
        """What `corrected` has chosen (k,), item by item; as many in all states."""
        return np.concatenate([np.zeros(0), *(item.settled for item in self.items)])

    def as_settled(self, chosen: FloatArray) -> System:
        """The equations with what `corrected` had chosen (k,) in an earlier run."""
        if not self.items:
            return self
        parts = np.split(chosen, np.cumsum([len(item.settled) for item in self.items])[:-1])
        return replace(self, items=tuple(item.as_settled(part) for item, part in zip(self.items, parts, strict=True)))

    def holding(self, other: System, y: FloatArray) -> System:
        """The equations with the points acting that act in those of another system at unknowns y (n,)."""
        if not self.items:
            return self
        held = (mine.holding(theirs.active(y)) for mine, theirs in zip(self.items, other.items, strict=True))
        return replace(self, items=tuple(held))

    def at_press(self, share: float) -> System | None:
        """The equations to begin with under a share of the last press, above 1 under more; None if they are these."""
        return self._with([item.at_press(share) for item in self.items])

    def _with(self, others: list[EquationItem | None]) -> System | None:
        if all(other is None for other in others):
            return None
        return replace(self, items=tuple(other or item for other, item in zip(others, self.items, strict=True)))

    @property
    def is_beyond(self) -> bool:
        """Whether they may be followed over limit points."""
        return any(item.is_beyond for item in self.items)

    def beyond_limits(self) -> System | None:
        """The equations that may be followed over limit points; None if they are these, or may not."""
        return self._with([item.beyond_limits() for item in self.items])

    def taken(self, start: FloatArray, end: FloatArray) -> float:
        """Energy in J that elements without a memory take on the way from unknowns y (n,) to others.

        Their forces have a potential, so any way will do: the straight one, by Gauss's rule. NaN where that turns an
        element inside out.
        """
        total, way = 0.0, self.scatter.gather(end - start)
        for place, weight in zip(*np.polynomial.legendre.leggauss(GAUSS_POINTS), strict=True):
            y = start + 0.5 * (1.0 + place) * (end - start)
            state = self.elements.evaluate(self.element_displacement(y), self.elements.rest_pressure)
            if state is None:
                return np.nan
            total += 0.5 * weight * float(np.sum(state.force * way))
        return total

    def lets_go(self, press: float) -> str:
        """Why a press in N cannot be held, whatever the state, or ""."""
        return next((why for why in (item.lets_go(press) for item in self.items) if why), "")

    def is_sound(self, y: FloatArray) -> bool:
        """Whether all items are at unknowns y (n,); see :meth:`fem.assembly.item.EquationItem.is_sound`."""
        return all(item.is_sound(y) for item in self.items)

    def warnings(self, y: FloatArray) -> tuple[str, ...]:
        """What a person must know of the accepted state y (n,)."""
        return tuple(text for text in (item.warning(y) for item in self.items) if text)

    def displaced(self, elements: IntArray, prescribed: FloatArray) -> System:
        """The same equations with displacements (components, N) in m on top of the unknowns', elements (nodes, E)."""
        offset = np.concatenate([u[elements] for u in prescribed])
        return replace(self, numbering=replace(self.numbering, prescribed=prescribed), offset=offset)

    @property
    def is_displaced(self) -> bool:
        """Whether there are prescribed displacements."""
        return self.offset is not None

    def scaled(self, share: float) -> System:
        """The same equations with a share of the prescribed displacements."""
        nodal, offset = self.numbering.prescribed, self.offset
        if nodal is None or offset is None:
            return self
        return replace(self, numbering=replace(self.numbering, prescribed=share * nodal), offset=share * offset)

    @property
    def plain(self) -> System:
        """The same equations without prescribed displacements and with the items of small strain alone."""
        kept = [n for n, item in enumerate(self.items) if item.in_small_strain]
        if self.offset is None and len(kept) == len(self.items):
            return self
        return replace(
            self,
            numbering=replace(self.numbering, prescribed=None),
            offset=None,
            items=tuple(self.items[n] for n in kept),
            places=tuple(self.places[n] for n in kept),
        )


def make_system(
    elements: Elements, numbering: Numbering, scatter: Scatter, items: tuple[EquationItem, ...] = ()
) -> System:
    """The equations of elements and items, with a pattern that has the entries of both."""
    if not items:
        return System(elements, numbering, scatter)
    rows, columns = (np.concatenate(side) for side in zip(*(item.entries for item in items), strict=True))
    wide, place = widened(scatter, numbering.count, rows, columns)
    ends = np.cumsum([len(item.entries[0]) for item in items])[:-1]
    return System(elements, numbering, wide, items, tuple(np.split(place, ends)))
