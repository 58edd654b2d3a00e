"""A body of one material with loads of its own, for cases that are no press of a tool, and meshes of its section.

It uses the solver's element, assembly, Newton and linear solver on any mesh of quadrilaterals in (r, z). Plane strain
is axial symmetry far from the axis: a ring of radius `RING` (in widths of its section), whose curvature costs about
1/RING. Plane stress at small strain is plane strain of another material.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem.analysis.equilibrium import Equilibrium, State
from fem.analysis.newton import NewtonSettings, solve_newton
from fem.analysis.stepping import Stepper
from fem.arrays import BoolArray, FloatArray
from fem.assembly.axisymmetric import Geometry, gauss_geometry, point_geometry
from fem.assembly.elements import make_elements
from fem.assembly.scatter import Numbering, Scatter, build_scatter, number_unknowns
from fem.assembly.system import Evaluation, System, make_system
from fem.linear_solver import make_solver
from fem.materials import LinearElastic, Material
from fem.materials.components import AXISYMMETRIC
from fem.materials.deformation import Deformation
from fem.materials.element_laws import element_laws
from fem.materials.prony import PronyTerm
from fem.mesh.quads import Mesh, mesh_of_quads

RING = 1e6
PLANE_PERCENT = 2e-3  # what curvature and the round-off of the radius cost a ring, nearly incompressible too
SIDES = ((0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0))
CORNERS = np.array([[0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 1.0, 1.0]])
NEAR = 1e-6  # of the section's height: corners this near each other are one
SIMPSON = np.array([1.0, 4.0, 1.0]) / 6.0


def mapped_mesh(
    s: FloatArray, t: FloatArray, place: Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]
) -> Mesh:
    """Mesh of the grid lines s (n,) by t (m,), moved to (r, z) by `place`, which keeps the orientation."""
    rows = len(t)
    r, z = place(*(grid.ravel() for grid in np.meshgrid(s, t, indexing="ij")))
    corner = np.arange(rows * len(s)).reshape(-1, rows)[:-1, :-1].ravel()
    quads = np.stack((corner, corner + rows, corner + rows + 1, corner + 1))
    return mesh_of_quads(np.stack((r, z - z.max()), axis=1), quads, np.zeros(1))


def distorted_square(count: int, seed: int, start: float = 0.0) -> Mesh:
    """Unit square start <= r <= start + 1 of count x count quadrilaterals whose inner corners are off the grid."""
    line = np.linspace(0.0, 1.0, count + 1)
    generator = np.random.default_rng(seed)

    def place(s: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        inner = (s > 0.0) & (s < 1.0) & (t > 0.0) & (t < 1.0)
        shift = np.where(inner, generator.uniform(-0.25, 0.25, (2, len(s))) / count, 0.0)
        return start + s + shift[0], t + shift[1]

    return mapped_mesh(line, line, place)


def plane_stress_material(youngs_modulus: float, poisson_ratio: float) -> LinearElastic:
    """Material whose plane strain is the plane stress of the constants given.

    E (1 + 2 nu) / (1 + nu)^2 and nu / (1 + nu): stresses and displacements in the plane are the same (Timoshenko and
    Goodier, Theory of Elasticity, chapter 2).
    """
    whole = 1.0 + poisson_ratio
    return LinearElastic(youngs_modulus * (1.0 + 2.0 * poisson_ratio) / whole**2, poisson_ratio / whole)


@dataclass(frozen=True)
class Body:
    """A mesh with one material and its supports.

    Attributes
    ----------
    mesh
        The mesh.
    material
        The material of all elements.
    fixed
        Displacements that are zero, (2, N): radial, vertical.
    tied
        Nodes (N,) that share one vertical displacement.
    stabilisation
        See :func:`fem.assembly.elements.make_elements`.
    relaxation
        Prony terms of the material.
    """

    mesh: Mesh
    material: Material
    fixed: BoolArray
    tied: BoolArray
    stabilisation: float = 0.0
    relaxation: tuple[PronyTerm, ...] = ()

    @cached_property
    def numbering(self) -> Numbering:
        """The unknowns."""
        return number_unknowns(self.fixed, self.tied)

    @cached_property
    def scatter(self) -> Scatter:
        """The sums into the unknowns."""
        return build_scatter(self.mesh.elements, self.numbering)

    @cached_property
    def geometry(self) -> Geometry:
        """Geometry at the Gauss points."""
        return gauss_geometry(self.mesh)

    @cached_property
    def system(self) -> System:
        """Residual and tangent."""
        laws = element_laws((self.material,), self.mesh.layer, (self.relaxation,))
        return make_system(make_elements(self.geometry, laws, self.stabilisation), self.numbering, self.scatter)

    @property
    def points(self) -> FloatArray:
        """Gauss points (2, q, E) in m."""
        shapes = self.geometry.shapes
        value = shapes.radial[-shapes.count :]
        return np.stack([value @ x[self.mesh.elements] for x in self.mesh.nodes.T])

    def equilibrium(self, load: FloatArray, probe: int = 0) -> Equilibrium:
        """Equations under a load (n,) on the unknowns times a factor."""
        solver = make_solver("superlu", self.scatter.indptr, self.scatter.indices)
        return Equilibrium(self.system, solver, load, probe)

    def traction(self, on: BoolArray, traction: FloatArray) -> FloatArray:
        """Load (n,) of a traction (2,) in Pa on the sides whose three nodes are in `on` (N,)."""
        return self._side_load(on, lambda along: np.linalg.norm(along, axis=1) * traction[:, None])

    def pull(self, on: BoolArray, tension: float) -> FloatArray:
        """Load (n,) of a normal tension in Pa, outwards, on the sides whose three nodes are in `on` (N,)."""
        return self._side_load(on, lambda along: tension * np.stack((along[:, 1], -along[:, 0])))

    def _side_load(self, on: BoolArray, force: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """Load (n,) of `force` (2, S) per unit depth on straight sides (S, 2), counter-clockwise.

        Simpson's rule is exact for a constant traction: shape function times radius is cubic along a side.
        """
        nodal = np.zeros((2, len(self.mesh.nodes)))
        for side in SIDES:
            nodes = self.mesh.elements[list(side)]
            nodes = nodes[:, on[nodes].all(axis=0)]
            share = 2.0 * np.pi * self.mesh.nodes[nodes, 0] * SIMPSON[:, None]
            for component, part in enumerate(force(self.mesh.nodes[nodes[2]] - self.mesh.nodes[nodes[0]])):
                np.add.at(nodal[component], nodes, share * part)
        return self.numbering.reduce(nodal)

    def work_of(self, stress: FloatArray) -> FloatArray:
        """Load (n,) that does the work of a nominal stress (5, q, E) in Pa: int P : grad v."""
        geometry = self.geometry
        flat = geometry.pull_back(stress * geometry.weight).reshape(-1, stress.shape[2])
        split = 3 * geometry.shapes.count
        shapes = geometry.shapes
        return self.scatter.vector(np.concatenate((shapes.radial.T @ flat[:split], shapes.vertical.T @ flat[split:])))

    def solve_linear(self, load: FloatArray) -> FloatArray:
        """Unknowns (n,) of small displacements under a load (n,)."""
        problem, rest = self.equilibrium(load), self._rest()
        problem.factorise(rest)
        y = problem.solver.solve(load[:, None])[:, 0]
        left = load - self.scatter.vector(self.system.linear_force(rest, y))
        return y + problem.solver.solve(left[:, None])[:, 0]

    def solve_finite(self, load: FloatArray, steps: int = 1) -> FloatArray:
        """Unknowns (n,) under a dead load (n,), brought up in equal steps."""
        scale = float(np.linalg.norm(load))
        stepper = Stepper(self.equilibrium(load / scale), "force", 1e-3 * scale, NewtonSettings())
        for step in range(1, steps + 1):
            reached = stepper.advance(scale * step / steps)
            if reached.reason:
                raise ArithmeticError(reached.reason)
        return reached.state.y

    def solve_from(self, load: FloatArray, guess: FloatArray) -> FloatArray:
        """Unknowns (n,) under a dead load (n,), by Newton's method from a guess (n,)."""
        scale = float(np.linalg.norm(load))
        state = State(guess, self.system.rest()[1], scale)
        result = solve_newton(self.equilibrium(load / scale), state, "force", scale, scale, NewtonSettings())
        if not result.success:
            raise ArithmeticError(result.reason)
        return result.state.y

    def corner_stress(self, y: FloatArray, place: tuple[float, float]) -> FloatArray:
        """Small-strain stress (rr, rz, tt, zr, zz) in Pa at the corner nearest (r, z), mean over its elements."""
        rest = self._rest()
        geometry = point_geometry(self.mesh, self.geometry, CORNERS)
        H = geometry.gradient(self.scatter.gather(y))
        deformation = Deformation(AXISYMMETRIC, H)
        mean = np.einsum("ie,iqe->qe", self.system.pressure_after(rest, y), geometry.pressure)
        strain, trace = deformation.small_strain, H[AXISYMMETRIC.normal].sum(axis=0)
        stress = 2.0 * self.material.shear_modulus * strain
        stress[AXISYMMETRIC.normal] += mean - 2.0 / 3.0 * self.material.shear_modulus * trace
        value = geometry.shapes.radial[-geometry.shapes.count :]
        distance = np.hypot(
            *(value @ x[self.mesh.elements] - at for x, at in zip(self.mesh.nodes.T, place, strict=True))
        )
        near = distance <= distance.min() + NEAR * float(np.ptp(self.mesh.nodes[:, 1]))
        out: FloatArray = stress[:, near].mean(axis=1)
        return out

    def _rest(self) -> Evaluation:
        rest = self.system.evaluate(*self.system.rest())
        if rest is None:
            raise ArithmeticError("the mesh has an element without volume")
        return rest

    def gradient(self, y: FloatArray) -> FloatArray:
        """Displacement gradient (5, q, E) at the Gauss points of unknowns (n,)."""
        return self.geometry.gradient(self.scatter.gather(y))


def worst(values: FloatArray, reference: float) -> float:
    """The value that is farthest from the reference."""
    flat = np.ravel(values)
    return float(flat[np.argmax(np.abs(flat - reference))])


def free_of_ties(mesh: Mesh) -> BoolArray:
    """No node tied, (N,)."""
    return np.zeros(len(mesh.nodes), dtype=np.bool_)
