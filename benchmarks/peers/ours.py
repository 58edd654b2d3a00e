"""One case through this project's solver: `python -m benchmarks.peers.ours case.npz result.npz`."""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import fem
from benchmarks.peers.case import LAYERS, POISSON, Case, load_case
from fem.assembly import System, build_scatter, element_laws, gauss_geometry, number_unknowns, solid_geometry
from fem.linear_run import unit_state
from fem.linear_solver import make_solver
from fem.mesh import Mesh, SolidMesh
from fem.solving import Equilibrium, NewtonSettings, Stepper
from fem.threads import suited_threads


def equations(case: Case) -> Equilibrium:
    """The equations with the peers' elements: hex20 reduced, or Q2 with one constant pressure."""
    nothing = np.zeros(len(case.nodes), dtype=np.bool_)
    if case.kind == "linear":
        law: type = fem.LinearElastic
        sets = (nothing,) * 5
        mesh = SolidMesh(
            case.nodes, case.elements, "hex20", case.layer, (0.0, 0.0), 1, *sets, (np.array([0]),), np.array([0])
        )
        geometry = solid_geometry(mesh)
    else:
        law = fem.NeoHookean
        full = gauss_geometry(Mesh(case.nodes, case.elements, case.layer, *(nothing,) * 4, (np.array([0]),)))
        geometry = replace(full, pressure=full.pressure[:1], pressure_transform=full.pressure_transform[:1, :1])
    laws = element_laws(tuple(law(E, POISSON) for _, E in LAYERS), case.layer)
    numbering = number_unknowns(case.fixed, nothing)
    scatter = build_scatter(case.elements, numbering)
    solver = make_solver("auto", scatter.indptr, scatter.indices)
    nodal = np.zeros(case.fixed.shape)
    nodal[-1] = case.load
    return Equilibrium(System(geometry, laws, numbering, scatter), solver, numbering.reduce(nodal), 0)


def solve(case: Case) -> np.ndarray:
    """Nodal displacements (N, dim) in m under the full load."""
    problem = equations(case)
    if case.kind == "linear":
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
