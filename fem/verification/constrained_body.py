"""A solid body of any three-dimensional mesh with nodal forces, prescribed displacements and linear constraints.

For comparison with cases of other codes, which are no press of a tool: their mesh, their elements, dead loads. The
unknowns are what is neither held, nor prescribed, nor eliminated by a constraint: u = T q + s g at the share s of the
load. The volumetric energy may be theirs, K/2 (ln J)^2 of the element's mean volume, instead of K/2 (J - 1)^2. Rigid
surfaces may touch nodes by a penalty, with Lagrange multipliers that are augmented from solve to solve (J. C. Simo and
T. A. Laursen, An augmented Lagrangian treatment of contact problems involving friction, Computers & Structures 42,
1992, without the friction).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.assembly.elements import Elements, ElementState, make_elements
from fem.assembly.scatter import build_scatter, number_unknowns
from fem.assembly.solid import solid_geometry
from fem.assembly.system import Evaluation, System, make_system
from fem.materials import Material
from fem.materials.element_laws import element_laws
from fem.mesh.solid import SolidMesh

TOLERANCE, MOST_CORRECTIONS = 1e-12, 60
MOST_AUGMENTATIONS, MOST_HALVINGS = 1000, 6


@dataclass(frozen=True)
class Constraint:
    """One displacement that is a sum of others.

    Attributes
    ----------
    component, node
        Of the displacement that is eliminated.
    terms
        Component, node and factor of each other one.
    """

    component: int
    node: int
    terms: tuple[tuple[int, int, float], ...]

    @property
    def nodes(self) -> tuple[int, ...]:
        """Every node in it."""
        return self.node, *(node for _, node, _ in self.terms)


@dataclass(frozen=True)
class ContactForces:
    """What a contact does at one state.

    Attributes
    ----------
    force
        On the body (3 N,), N.
    stiffness
        Its derivative by the displacements with the sign turned (3 N, 3 N), N/m.
    pressure
        Of each node that can touch (n,), Pa; where it is no equilibrium's, what the multiplier would become.
    """

    force: FloatArray
    stiffness: sp.csr_array
    pressure: FloatArray


class Contact(Protocol):
    """What touches nodes."""

    @property
    def count(self) -> int:
        """Nodes n that can touch."""

    def touch(self, u: FloatArray, share: float, multiplier: FloatArray) -> ContactForces:
        """What it does at displacements (3, N) in m and the share of the load, with multipliers (n,) in Pa."""

    def settled(self, multiplier: FloatArray, pressure: FloatArray, times: int) -> bool:
        """Whether multipliers (n,) that were augmented so many times may stay, though the pressures (n,) differ."""


@dataclass(frozen=True)
class _State:
    """An equilibrium: its share of the load, displacements (3 N,), pressures of elements, multipliers of contacts."""

    share: float
    y: FloatArray
    pressure: FloatArray
    multipliers: tuple[FloatArray, ...]


@dataclass(frozen=True)
class LogarithmicElements(Elements):
    """Elements of one constant pressure each whose volumetric energy is K/2 (ln J)^2 of their mean volume."""

    def wanted_pressure(self, volume_change: FloatArray) -> FloatArray:
        """Pressure coefficients (1, E): K ln J / J, with the root of the volume that the shapes are scaled by."""
        root = 1.0 / self.geometry.pressure[:, 0]
        mean = volume_change / root
        out: FloatArray = root * self.field_modulus * np.log1p(mean) / (1.0 + mean)
        return out

    def pressure_slope(self, state: ElementState) -> FloatArray:
        """K (1 - ln J) / J^2, (E,) in Pa."""
        weight = self.geometry.weight
        mean = (weight * state.deformation.J).sum(axis=0) / weight.sum(axis=0)
        out: FloatArray = self.field_modulus * (1.0 - np.log(mean)) / mean**2
        return out


@dataclass(frozen=True)
class ConstrainedBody:
    """A mesh with its materials, supports and full load.

    Attributes
    ----------
    nodes
        Positions (N, 3) in m.
    elements
        Node numbers (n, E) in scikit-fem's order.
    element
        Kind, one of :data:`fem.assembly.solid.SOLID_ELEMENTS`.
    part
        Material of each element (E,).
    materials
        One a part.
    held
        Displacements (3, N) that are zero.
    moved
        Displacements (3, N) that are prescribed, m; NaN where they are not.
    force
        Nodal forces (3, N) in N.
    constraints
        Displacements that are sums of others, none of them eliminated.
    logarithmic
        Whether the volumetric energy is K/2 (ln J)^2.
    contacts
        What touches it.
    """

    nodes: FloatArray
    elements: IntArray
    element: str
    part: IntArray
    materials: tuple[Material, ...]
    held: BoolArray
    moved: FloatArray
    force: FloatArray
    constraints: tuple[Constraint, ...] = ()
    logarithmic: bool = False
    contacts: tuple[Contact, ...] = ()

    @cached_property
    def system(self) -> System:
        """Residual and tangent of all displacements."""
        count = len(self.nodes)
        nobody = np.zeros(count, dtype=np.bool_)
        sets, rows = (nobody,) * 5, ((np.array([0]),), np.array([0]))
        mesh = SolidMesh(self.nodes, self.elements, self.element, self.part, (0.0, 0.0), 1, *sets, *rows)
        numbering = number_unknowns(np.zeros((3, count), dtype=np.bool_), nobody)
        elements = make_elements(solid_geometry(mesh), element_laws(self.materials, self.part))
        if self.logarithmic:
            elements = LogarithmicElements(elements.geometry, elements.laws, elements.point_modulus)
        return make_system(elements, numbering, build_scatter(self.elements, numbering))

    @cached_property
    def free(self) -> BoolArray:
        """Displacements (3, N) that are solved for: neither held, nor prescribed, nor eliminated."""
        out: BoolArray = ~self.held & np.isnan(self.moved)
        for one in self.constraints:
            out[one.component, one.node] = False
        return out

    @cached_property
    def _reduced(self) -> tuple[sp.csr_array, FloatArray]:
        """T (3 N, m) and g (3 N,)."""
        goal = np.where(self.held | np.isnan(self.moved), 0.0, self.moved)
        places = np.flatnonzero(self.free.ravel())
        chosen = sp.lil_array((self.free.size, len(places)))
        chosen[places, np.arange(len(places))] = 1.0
        count = len(self.nodes)
        for one in self.constraints:
            row = one.component * count + one.node
            for component, node, factor in one.terms:
                chosen[[row]] += factor * chosen[[component * count + node]]
                goal[one.component, one.node] += factor * goal[component, node]
        return sp.csr_array(chosen), goal.ravel()

    def press(self, steps: int) -> FloatArray:
        """Displacements (3, N) in m under the full load, brought up in equal steps, halved where none is found.

        Raises
        ------
        ArithmeticError
            If a step finds no equilibrium.
        """
        y, pressure = self.system.rest()
        state = _State(0.0, y, pressure, tuple(np.zeros(one.count) for one in self.contacts))
        for step in range(1, steps + 1):
            state = self._brought(state, step / steps, MOST_HALVINGS)
        return np.asarray(state.y.reshape(3, -1))

    def _brought(self, state: _State, share: float, halvings: int) -> _State:
        try:
            return self._step(state, share)
        except ArithmeticError:
            if halvings == 0:
                raise
        half = self._brought(state, 0.5 * (state.share + share), halvings - 1)
        return self._brought(half, share, halvings - 1)

    def _step(self, state: _State, share: float) -> _State:
        """The equilibrium at a share, the multipliers augmented until the contacts are content."""
        for times in range(MOST_AUGMENTATIONS):
            state, touches = self._equilibrium(state, share)
            settled = tuple(
                one.settled(multiplier, touch.pressure, times)
                for one, multiplier, touch in zip(self.contacts, state.multipliers, touches, strict=True)
            )
            if all(settled):
                return state
            told = zip(settled, state.multipliers, touches, strict=True)
            state = replace(state, multipliers=tuple(m if stays else touch.pressure for stays, m, touch in told))
        raise ArithmeticError("the multipliers of a contact do not settle: its penalty is too small")

    def _equilibrium(self, state: _State, share: float) -> tuple[_State, tuple[ContactForces, ...]]:
        """Displacements and pressures in equilibrium with these multipliers, by Newton; the supports move first."""
        (chosen, goal), load = self._reduced, share * self.force.ravel()
        y, pressure, jump = state.y, state.pressure, (share - state.share) * goal
        for _ in range(MOST_CORRECTIONS):
            found = self.system.evaluate(self._numbered(y), pressure)
            if found is None:
                break
            touches = self._touches(y, share, state.multipliers)
            tangent = sum((touch.stiffness for touch in touches), self._tangent(found))
            inner = found.residual[self._unknown]
            left = chosen.T @ (load + sum(touch.force for touch in touches) - inner - tangent @ jump)
            change = np.atleast_1d(spla.spsolve(sp.csc_array(chosen.T @ tangent @ chosen), left))
            dy = chosen @ change + jump
            pressure, y = self.system.pressure_after(found, self._numbered(dy)), y + dy
            if not jump.any() and np.abs(change).max(initial=0.0) <= TOLERANCE * max(float(np.abs(y).max()), TOLERANCE):
                return _State(share, y, pressure, state.multipliers), self._touches(y, share, state.multipliers)
            jump = np.zeros_like(jump)
        raise ArithmeticError("no equilibrium is found: the steps are too long, or the body is not held")

    def _touches(self, y: FloatArray, share: float, multipliers: tuple[FloatArray, ...]) -> tuple[ContactForces, ...]:
        u = y.reshape(3, -1)
        return tuple(one.touch(u, share, m) for one, m in zip(self.contacts, multipliers, strict=True))

    @cached_property
    def _unknown(self) -> IntArray:
        """Number (3 N,) in the equations of each displacement, component by component."""
        return self.system.numbering.unknown.ravel()

    def _numbered(self, y: FloatArray) -> FloatArray:
        """Displacements (3 N,) as the equations number them."""
        out = np.empty_like(y)
        out[self._unknown] = y
        return out

    def _tangent(self, state: Evaluation) -> sp.csr_array:
        scatter, count = self.system.scatter, self.system.numbering.count
        upper = sp.csr_array((self.system.tangent(state), scatter.indices, scatter.indptr), shape=(count, count))
        return sp.csr_array(upper + sp.triu(upper, 1).T)[self._unknown][:, self._unknown]
