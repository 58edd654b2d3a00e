"""One case through this project's solver: `python -m tests.performance.peers.ours case.npz result.npz`."""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import fem
from fem.analysis.equilibrium import Equilibrium
from fem.analysis.newton import NewtonSettings
from fem.analysis.stepping import Stepper
from fem.assembly.axisymmetric import gauss_geometry
from fem.assembly.element_geometry import ElementGeometry
from fem.assembly.elements import make_elements
from fem.assembly.scatter import build_scatter, number_unknowns
from fem.assembly.system import make_system
from fem.linear_solver import make_solver
from fem.materials.element_laws import element_laws
from fem.mesh.quads import Mesh
from fem.mesh.solid import SolidMesh
from fem.threads import suited_threads
from tests.performance.peers.case import LAYERS, POISSON, Case, load_case


def hexahedra(case: Case) -> ElementGeometry:
    """hex20 with 8 Gauss points."""
    from fem.assembly.solid import solid_geometry  # the axisymmetric case does without

    sets = (np.zeros(len(case.nodes), dtype=np.bool_),) * 5
    rows = (np.array([0]),), np.array([0])
    return solid_geometry(SolidMesh(case.nodes, case.elements, "hex20", case.layer, (0.0, 0.0), 1, *sets, *rows))


def quadrilaterals(case: Case) -> ElementGeometry:
    """Axisymmetric Q2 with one constant pressure."""
    sets = (np.zeros(len(case.nodes), dtype=np.bool_),) * 4
    full = gauss_geometry(Mesh(case.nodes, case.elements, case.layer, *sets, (np.array([0]),), ()))
    return replace(full, pressure=full.pressure[:1], pressure_transform=full.pressure_transform[:1, :1])


def equations(case: Case) -> Equilibrium:
    """The equations with the peers' elements."""
    linear = case.kind == "linear"
    geometry = hexahedra(case) if linear else quadrilaterals(case)
    law: type = fem.LinearElastic if linear else fem.NeoHookean
    laws = element_laws(tuple(law(E, POISSON) for _, E in LAYERS), case.layer)
    numbering = number_unknowns(case.fixed, np.zeros(len(case.nodes), dtype=np.bool_))
    scatter = build_scatter(case.elements, numbering)
    solver = make_solver("auto", scatter.indptr, scatter.indices)
    nodal = np.zeros(case.fixed.shape)
    nodal[-1] = case.load
    return Equilibrium(
        make_system(make_elements(geometry, laws), numbering, scatter), solver, numbering.reduce(nodal), 0
    )


def solve(case: Case) -> np.ndarray:
    """Nodal displacements (N, dim) in m under the full load."""
    problem = equations(case)
    if case.kind == "linear":
        from fem.analysis.linear import unit_state  # the other case does without

        return problem.system.numbering.expand(unit_state(problem)[0].y).T
    stepper = Stepper(problem, "force", 1.0, NewtonSettings())
    for step in range(1, case.steps + 1):
        advance = stepper.advance(step / case.steps)
        if advance.reason:
            raise SystemExit(advance.reason)
    return problem.system.numbering.expand(advance.state.y).T


if __name__ == "__main__":
    the_case = load_case(Path(sys.argv[1]))
    start = time.perf_counter()
    with suited_threads(the_case.unknowns):
        displacement = solve(the_case)
    np.savez(sys.argv[2], displacement=displacement, seconds=time.perf_counter() - start)
