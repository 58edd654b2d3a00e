"""The equations of a mesh whose conditions are known, for every geometry."""

from __future__ import annotations

import numpy as np

from fem.arrays import BoolArray, FloatArray
from fem.assembly import ElementGeometry, System, build_scatter, element_laws, number_unknowns
from fem.contact import Conditions
from fem.linear_solver import make_solver
from fem.mesh import AnyMesh
from fem.problem import Problem
from fem.solving import Equilibrium


def set_up(
    problem: Problem,
    mesh: AnyMesh,
    geometry: ElementGeometry,
    fixed: BoolArray,
    conditions: Conditions,
    linear_solver: str,
) -> Equilibrium:
    """Equations, linear solver, unit load and depth probe.

    Parameters
    ----------
    problem
        What was asked.
    mesh, geometry
        The mesh and its geometry at the Gauss points.
    fixed
        Displacements (components, N) that are zero.
    conditions
        Conditions of the contact; what it holds is in `fixed` already.
    linear_solver
        See :func:`fem.prepare`.
    """
    numbering = number_unknowns(fixed, conditions.tied)
    laws = element_laws(tuple(layer.material for layer in problem.layers), mesh.layer)
    scatter = build_scatter(mesh.elements, numbering)
    solver = make_solver(linear_solver, scatter.indptr, scatter.indices)
    nodal = np.zeros(fixed.shape)
    nodal[-1] = conditions.load
    load: FloatArray = numbering.reduce(nodal)
    probe = int(numbering.unknown[-1, mesh.interfaces[0][0]])
    return Equilibrium(System(geometry, laws, numbering, scatter, _stabilisation(problem)), solver, load, probe)


def _stabilisation(problem: Problem) -> float:
    """Small strain needs none."""
    return problem.discretisation.stabilisation if problem.kinematics == "finite" else 0.0
