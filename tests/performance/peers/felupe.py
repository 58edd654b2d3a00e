"""One case through FElupe with Pardiso: `python -m tests.performance.peers.felupe case.npz result.npz`."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import felupe
import numpy as np
from scipy.sparse.linalg import spsolve

from tests.performance.peers.case import LAYERS, POISSON, Case, load_case

try:
    from pypardiso import spsolve as direct
except ImportError:
    direct = spsolve


def line(start: float, end: float, first: float, growth: float, largest: float, *, at_end: bool = False) -> np.ndarray:
    """Points from start to end, spaced by `first` at one end and more, by `growth` a length, away from it."""
    place = np.linspace(start, end, 4001)
    size = np.minimum(largest, first + growth * (end - place if at_end else place - start))
    steps = 0.5 * (1.0 / size[1:] + 1.0 / size[:-1]) * np.diff(place)
    count = np.concatenate([[0.0], np.cumsum(steps)])
    return np.interp(np.linspace(0.0, count[-1], max(1, int(np.ceil(count[-1]))) + 1), count, place)


def quads(r: np.ndarray, depth: np.ndarray, faces: np.ndarray) -> tuple[felupe.Mesh, np.ndarray]:
    """Nine-node cells (first axis z, second r) between lines over the radius and the depth, and the layer of each."""
    z = -np.unique(np.round(depth, 12))[::-1]
    fine_r, fine_z = (np.sort(np.concatenate([x, 0.5 * (x[1:] + x[:-1])])) for x in (r, z))
    points = np.stack([one.ravel() for one in np.meshgrid(fine_z, fine_r, indexing="ij")], axis=1)
    i, j = (2 * one.ravel() for one in np.meshgrid(np.arange(z.size - 1), np.arange(r.size - 1), indexing="ij"))
    order = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1))
    cells = np.stack([(i + a) * fine_r.size + j + b for a, b in order], axis=1)
    middle = -points[cells[:, 8], 0]
    return felupe.Mesh(points, cells, "quad9"), np.searchsorted(faces, middle) - 1


def solid(case: Case) -> tuple[felupe.FieldContainer, felupe.SolidBody]:
    """hex20 with 8 Gauss points, linear elastic."""
    cells = case.elements[case.vtk_order].T
    mesh = felupe.Mesh(case.nodes, cells, "hexahedron20")
    region = felupe.RegionQuadraticHexahedron(mesh, quadrature=felupe.GaussLegendre(order=1, dim=3))
    field = felupe.FieldContainer([felupe.Field(region, dim=3)])
    modulus = np.array([E for _, E in LAYERS])[case.layer]
    return field, felupe.SolidBody(felupe.LinearElastic(modulus, POISSON), field)


def axisymmetric(case: Case) -> tuple[felupe.FieldContainer, felupe.SolidBodyNearlyIncompressible]:
    """Q2 with one constant pressure; FElupe's first axis is z, its second r."""
    cells = case.elements.T[:, [0, 3, 2, 1, 7, 6, 5, 4, 8]]
    mesh = felupe.Mesh(case.nodes[:, ::-1].copy(), cells, "quad9")
    region = felupe.RegionBiQuadraticQuad(mesh)
    field = felupe.FieldContainer([felupe.FieldAxisymmetric(region, dim=2)])
    modulus = np.array([E for _, E in LAYERS])[case.layer]
    shear, bulk = modulus / (2 * (1 + POISSON)), modulus / (3 * (1 - 2 * POISSON))
    return field, felupe.SolidBodyNearlyIncompressible(felupe.NeoHooke(mu=shear), field, bulk=bulk)


def solve(case: Case) -> np.ndarray:
    """Nodal displacements (N, dim) in m under the full load, components in our order."""
    linear = case.kind == "linear"
    field, body = (solid if linear else axisymmetric)(case)
    fixed = case.fixed if linear else case.fixed[::-1]
    bounds = {
        f"axis {axis}": felupe.Boundary(
            field[0], mask=mask, skip=tuple(int(other != axis) for other in range(len(fixed)))
        )
        for axis, mask in enumerate(fixed)
    }
    held, free = felupe.dof.partition(field, bounds)
    loaded = np.flatnonzero(case.load)
    nodal = np.zeros((len(loaded), len(fixed)))
    for step in range(1, case.steps + 1):
        nodal[:, 2 if linear else 0] = case.load[loaded] * step / case.steps
        items = [body, felupe.PointLoad(field, loaded, nodal)]
        felupe.newtonraphson(
            items=items, dof0=held, dof1=free, ext0=np.zeros(len(held)), solver=direct, tol=1e-9, verbose=0
        )
    found: np.ndarray = field[0].values
    return found if linear else found[:, ::-1]


if __name__ == "__main__":
    the_case = load_case(Path(sys.argv[1]))
    start = time.perf_counter()
    displacement = solve(the_case)
    np.savez(sys.argv[2], displacement=displacement, seconds=time.perf_counter() - start)
