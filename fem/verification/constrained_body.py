"""A solid body of any three-dimensional mesh with nodal forces, prescribed displacements and linear constraints.

For comparison with cases of other codes, which are no press of a tool: their mesh, their elements, dead loads. The
unknowns are what is neither held, nor prescribed, nor eliminated by a constraint: u = T q + s g at the share s of the
load. The volumetric energy may be theirs, K/2 (ln J)^2 of the element's mean volume, instead of K/2 (J - 1)^2.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

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
        """Displacements (3, N) in m under the full load, brought up in equal steps.

        Raises
        ------
        ArithmeticError
            If a step finds no equilibrium.
        """
        chosen, goal = self._reduced
        y, pressure = self.system.rest()
        q = np.zeros(chosen.shape[1])
        for step in range(1, steps + 1):
            share = step / steps
            q, pressure = self._step(chosen @ q + share * goal, pressure, share * self.force.ravel(), q)
        y = chosen @ q + goal
        return np.asarray(y.reshape(3, -1))

    def _step(
        self, y: FloatArray, pressure: FloatArray, load: FloatArray, q: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Free displacements (m,) and pressures in equilibrium, from displacements that fit the supports."""
        chosen = self._reduced[0]
        for _ in range(MOST_CORRECTIONS):
            state = self.system.evaluate(y, pressure)
            if state is None:
                break
            left = chosen.T @ (load - state.residual)
            change = np.atleast_1d(spla.spsolve(sp.csc_array(chosen.T @ self._tangent(state) @ chosen), left))
            dy = chosen @ change
            pressure = self.system.pressure_after(state, dy)
            y, q = y + dy, q + change
            if np.abs(change).max(initial=0.0) <= TOLERANCE * max(float(np.abs(y).max()), TOLERANCE):
                return q, pressure
        raise ArithmeticError("no equilibrium is found: the steps are too long, or the body is not held")

    def _tangent(self, state: Evaluation) -> sp.csr_array:
        scatter, count = self.system.scatter, self.system.numbering.count
        upper = sp.csr_array((self.system.tangent(state), scatter.indices, scatter.indptr), shape=(count, count))
        return sp.csr_array(upper + sp.triu(upper, 1).T)
