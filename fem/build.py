"""The set-up of a model: mesh, numbering, equations and linear solver."""

from __future__ import annotations

import numpy as np

from fem.arrays import FloatArray
from fem.assembly import System, build_scatter, element_laws, gauss_geometry, number_unknowns
from fem.contact import CONTACT_MODELS, Conditions
from fem.errors import FemError
from fem.layout import lay_out
from fem.linear_solver import make_solver
from fem.mesh import Mesh
from fem.model import Model
from fem.problem import Problem
from fem.solving import Equilibrium, NewtonSettings
from fem.supports import SUPPORT_MODELS


def build_model(problem: Problem, linear_solver: str) -> Model:
    """See :func:`fem.prepare`."""
    contact = CONTACT_MODELS.get(problem.tool.contact)
    if contact is None:
        raise FemError(
            f"tool.contact = {problem.tool.contact!r}: not available in this solver; "
            f"available are {', '.join(sorted(CONTACT_MODELS))}"
        )
    warnings = contact.check(problem)
    mesh = lay_out(problem)
    equilibrium = _equilibrium(problem, mesh, contact.conditions(mesh, problem), linear_solver)
    return Model(problem, mesh, equilibrium, NewtonSettings(), warnings)


def _equilibrium(problem: Problem, mesh: Mesh, conditions: Conditions, linear_solver: str) -> Equilibrium:
    support = SUPPORT_MODELS[problem.support.kind].fixed(mesh, problem)
    fixed = np.stack((support | mesh.axis | conditions.held, support))
    numbering = number_unknowns(fixed, conditions.tied)
    geometry = gauss_geometry(mesh)
    laws = element_laws(tuple(layer.material for layer in problem.layers), mesh.layer)
    scatter = build_scatter(mesh.elements, numbering)
    solver = make_solver(linear_solver, scatter.indptr, scatter.indices)
    load: FloatArray = numbering.reduce(np.stack((np.zeros(len(mesh.nodes)), conditions.load)))
    probe = int(numbering.unknown[1, mesh.interfaces[0][0]])
    return Equilibrium(System(geometry, laws, numbering, scatter, _stabilisation(problem)), solver, load, probe)


def _stabilisation(problem: Problem) -> float:
    """Small strain needs none."""
    return problem.discretisation.stabilisation if problem.kinematics == "finite" else 0.0
