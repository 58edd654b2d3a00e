"""The set-up of a three-dimensional model on its mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fem.arrays import FloatArray
from fem.assembly.solid_geometry import solid_geometry
from fem.contact.solid import solid_conditions
from fem.equations import set_up
from fem.mesh import SolidMesh
from fem.model import Model
from fem.problem import Problem
from fem.solid_fields import SolidFieldRecovery
from fem.solving import NewtonSettings
from fem.supports import SUPPORT_MODELS


def solid_model(problem: Problem, mesh: SolidMesh, linear_solver: str, warnings: tuple[str, ...]) -> Model:
    """Model of a problem on a three-dimensional mesh."""
    tool = problem.tool
    conditions = solid_conditions(mesh, problem)
    support = SUPPORT_MODELS[problem.support.kind].fixed(mesh, problem)
    lateral = support | conditions.held
    fixed = np.stack((lateral | mesh.mirror_x, lateral | mesh.mirror_y, support))
    geometry = solid_geometry(mesh)
    equilibrium = set_up(problem, mesh, geometry, fixed, conditions, linear_solver)
    if tool.tilt != 0.0 and conditions.punch is None:
        turned = _turn(mesh, tool.tilt) * conditions.tied
        equilibrium = replace(equilibrium, system=equilibrium.system.displaced(mesh.elements, turned))
    system = equilibrium.system
    recovery = SolidFieldRecovery(mesh, system.laws, geometry, system.point_modulus, problem.kinematics == "finite")
    return Model(problem, mesh, equilibrium, recovery, NewtonSettings(), warnings)


def _turn(mesh: SolidMesh, tilt: float) -> FloatArray:
    """Displacements (3, N) in m of a turn of the top face by `tilt` about the tool's centre, upper end to +x."""
    x = mesh.nodes[:, 0] - mesh.axis_point[0]
    return np.stack(((np.cos(tilt) - 1.0) * x, np.zeros_like(x), -np.sin(tilt) * x))
