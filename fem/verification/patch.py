"""Patch tests: a uniform strain or displacement gradient must come out exactly on a distorted mesh.

Small strain, sigma = 2 mu eps + lambda tr(eps) I (Hooke). In the plane the mesh is loaded by its tractions on the
border. Round: u_r = e_r r, u_z = e_z z. Plane: a ring far from the axis with u_r = e x, u_z = g x + e_z z. In three
dimensions a linear displacement on the border must go on inside: the body is a unit cube of each element with
displacements prescribed all round. The mesh of tetrahedra has straight sides by construction and is not distorted.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import skfem

from fem.arrays import BoolArray, FloatArray, IntArray
from fem.assembly.elements import make_elements
from fem.assembly.scatter import build_scatter, number_unknowns
from fem.assembly.solid import SOLID_ELEMENTS, solid_geometry
from fem.assembly.system import System, make_system
from fem.linear_solver import make_solver
from fem.materials import LinearElastic, Material
from fem.materials.element_laws import element_laws
from fem.mesh.solid import SolidMesh
from fem.mesh.surface.specimen import quadratic
from fem.verification.body import PLANE_PERCENT, RING, Body, distorted_square, free_of_ties, worst
from fem.verification.case import Case, Quantity

YOUNGS_MODULUS = 1e5
POISSON_RATIOS = (0.3, 0.4999)
RADIAL, AXIAL, SHEAR = 1e-3, -2.3e-3, 1.7e-3
ALLOWED_PERCENT = 1e-6
SOURCE = "uniform strain, Hooke's law (patch test of Irons)"
COUNT, SEED = 4, 7
KINDS = (("hex27", 0.3), ("hex27", 0.4999), ("hex20", 0.3), ("tet10", 0.3), ("tet10", 0.4999))
GRADIENT = 1e-2 * np.array([[1.0, 2.0, -1.0], [0.5, -2.0, 3.0], [1.0, 1.0, 1.0]])  # its trace is zero
SOLID_COUNT, BEND = 2, 0.05
SOLID_SOURCE = "uniform displacement gradient (patch test of Irons)"


def cases() -> tuple[Case, ...]:
    """A round and a plane patch at two Poisson's ratios."""
    return tuple(
        Case(f"patch_{name}/nu_{nu:g}", SOURCE, partial(function, nu))
        for name, function in (("axisymmetric", axisymmetric), ("plane_strain", plane_strain))
        for nu in POISSON_RATIOS
    )


def axisymmetric(poisson_ratio: float) -> tuple[Quantity, ...]:
    """Cylinder under radial and axial tractions: the strains."""
    mesh, material = distorted_square(COUNT, SEED), LinearElastic(YOUNGS_MODULUS, poisson_ratio)
    body = Body(mesh, material, np.stack((mesh.axis, mesh.base)), free_of_ties(mesh))
    stress = _hooke(material, np.array([RADIAL, 0.0, RADIAL, 0.0, AXIAL]))
    load = body.traction(mesh.border, stress[[0, 1]]) + body.traction(mesh.top, stress[[3, 4]])
    H, unknowns = body.gradient(body.solve_linear(load)), body.numbering.count
    return (
        Quantity("radial", RADIAL, worst(H[0], RADIAL), "", ALLOWED_PERCENT, unknowns),
        Quantity("hoop", RADIAL, worst(H[2], RADIAL), "", ALLOWED_PERCENT, unknowns),
        Quantity("axial", AXIAL, worst(H[4], AXIAL), "", ALLOWED_PERCENT, unknowns),
    )


def plane_strain(poisson_ratio: float) -> tuple[Quantity, ...]:
    """Block held without constraint of its strain, under normal and shear tractions: the strains."""
    mesh, material = distorted_square(COUNT, SEED, RING), LinearElastic(YOUNGS_MODULUS, poisson_ratio)
    left = np.asarray(mesh.nodes[:, 0] == mesh.nodes[:, 0].min())
    corner = left & mesh.base
    body = Body(mesh, material, np.stack((left, corner)), free_of_ties(mesh))
    stress = _hooke(material, np.array([RADIAL, 0.5 * SHEAR, 0.0, 0.5 * SHEAR, AXIAL]))
    load = body.traction(mesh.border, stress[[0, 3]]) + body.traction(mesh.top, stress[[1, 4]])
    load = load - body.traction(mesh.base, stress[[1, 4]]) - body.traction(left, stress[[0, 3]])
    H, unknowns = body.gradient(body.solve_linear(load)), body.numbering.count
    return (
        Quantity("normal_x", RADIAL, worst(H[0], RADIAL), "", PLANE_PERCENT, unknowns),
        Quantity("normal_z", AXIAL, worst(H[4], AXIAL), "", PLANE_PERCENT, unknowns),
        Quantity("shear", SHEAR, worst(H[1] + H[3], SHEAR), "", PLANE_PERCENT, unknowns),
    )


def _hooke(material: LinearElastic, strain: FloatArray) -> FloatArray:
    """Stress (rr, rz, tt, zr, zz) in Pa of small strains in the same order."""
    identity = np.array([1.0, 0.0, 1.0, 0.0, 1.0])
    shear = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio))
    lame = 2.0 * shear * material.poisson_ratio / (1.0 - 2.0 * material.poisson_ratio)
    out: FloatArray = 2.0 * shear * strain + lame * (strain @ identity) * identity
    return out


def solid_cases() -> tuple[Case, ...]:
    """Each element, nearly incompressible too where it has a pressure of its own."""
    return tuple(Case(f"patch_{name}/nu_{nu:g}", SOLID_SOURCE, partial(patch, name, nu)) for name, nu in KINDS)


def patch(element: str, poisson_ratio: float) -> tuple[Quantity, ...]:
    """Three components of the displacement gradient at the Gauss point where each is farthest off."""
    mesh = cube(element, SOLID_COUNT, 0.0 if element == "tet10" else BEND)
    exact = GRADIENT @ mesh.nodes.T
    system = equations(mesh, LinearElastic(1e5, poisson_ratio), np.tile(mesh.base, (3, 1)), 0.0)
    system = system.displaced(mesh.elements, exact * mesh.base)
    y = solve_linear(system, np.zeros(system.numbering.count))
    found = system.elements.geometry.gradient(system.element_displacement(y))
    return tuple(
        Quantity(name, GRADIENT[i, j], worst(found[3 * i + j], GRADIENT[i, j]), "", ALLOWED_PERCENT, len(y))
        for name, i, j in (("xx", 0, 0), ("yz", 1, 2), ("zx", 2, 0))
    )


def cube(element: str, n: int, bend: float = 0.0) -> SolidMesh:
    """Mesh of [0, 1] x [0, 1] x [-1, 0] m, its whole border marked as base and border.

    Parameters
    ----------
    element
        "hex27", "hex20" or "tet10".
    n
        Elements along a side (a tet10 mesh has six for each hexahedron).
    bend
        How far in m the nodes inside are moved, by smooth waves.
    """
    nodes, elements = _tetrahedra(n) if element == "tet10" else _hexahedra(element, n)
    x, y, z = nodes.T
    wave = np.sin(np.pi * x) * np.sin(np.pi * y) * np.sin(np.pi * z)
    outside = (np.abs(np.stack((x, 1 - x, y, 1 - y, z, 1 + z))) < 1e-12).any(axis=0)
    nobody = np.zeros(len(nodes), dtype=np.bool_)
    return SolidMesh(
        nodes + bend * np.stack((wave, wave, -wave), axis=1),
        elements,
        element,
        np.zeros(elements.shape[1], dtype=np.int64),
        axis_point=(0.0, 0.0),
        images=1,
        mirror_x=nobody,
        mirror_y=nobody,
        top=nobody,
        base=outside,
        border=outside,
        interfaces=(np.array([0]),),
        top_elements=np.array([0]),
    )


def _lines(n: int) -> list[FloatArray]:
    return [np.linspace(0.0, 1.0, n + 1), np.linspace(0.0, 1.0, n + 1), np.linspace(-1.0, 0.0, n + 1)]


def _tetrahedra(n: int) -> tuple[FloatArray, IntArray]:
    mesh = skfem.MeshTet.init_tensor(*_lines(n))
    points, corners = mesh.p.T, mesh.t.T.astype(np.int64)
    turned = np.linalg.det(points[corners[:, 1:]] - points[corners[:, :1]]) < 0.0
    corners[turned] = corners[turned][:, [0, 2, 1, 3]]
    return quadratic(points, corners)


def _hexahedra(element: str, n: int) -> tuple[FloatArray, IntArray]:
    """Mirrored in z: scikit-fem's grids are left-handed."""
    basis = skfem.Basis(skfem.MeshHex.init_tensor(*_lines(n)), SOLID_ELEMENTS[element].shapes, intorder=1)
    nodes = basis.doflocs * [[1], [1], [-1]] - [[0], [0], [1]]
    return nodes.T.copy(), basis.element_dofs.astype(np.int64)


def equations(mesh: SolidMesh, material: Material, fixed: BoolArray, stabilisation: float = 1.0) -> System:
    """Residual and tangent of one material with the displacements (3, N) in `fixed` prescribed."""
    numbering = number_unknowns(fixed, np.zeros(len(mesh.nodes), dtype=np.bool_))
    laws = element_laws((material,), mesh.layer)
    elements = make_elements(solid_geometry(mesh), laws, stabilisation)
    return make_system(elements, numbering, build_scatter(mesh.elements, numbering))


def solve_linear(system: System, load: FloatArray) -> FloatArray:
    """Unknowns (n,) in small strain under a load (n,) and the prescribed displacements."""
    plain = system.plain
    rest = plain.evaluate(*plain.rest())
    if rest is None:
        raise ArithmeticError("the mesh has an element without volume")
    solver = make_solver("superlu", system.scatter.indptr, system.scatter.indices)
    solver.factorise(plain.tangent(rest))
    y = np.zeros(len(load))
    for _ in range(3):
        missing = load - system.scatter.vector(system.linear_force(rest, y))
        y = y + solver.solve(missing[:, None])[:, 0]
    return y
