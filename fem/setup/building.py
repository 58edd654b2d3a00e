"""The set-up of a model by its geometry; what three dimensions need is loaded with the first such model."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from fem.analysis.model import Model
from fem.analysis.newton import NewtonSettings
from fem.arrays import FloatArray
from fem.assembly.axisymmetric import gauss_geometry
from fem.assembly.solid import solid_geometry
from fem.errors import FemError
from fem.mesh.quads import split_interfaces
from fem.mesh.solid import SolidMesh
from fem.problem.problem import Problem
from fem.results.fields import FieldRecovery
from fem.setup.contacts import CONTACT_MODELS
from fem.setup.equations import set_up
from fem.setup.items import sliding_nodes
from fem.setup.layout import lay_out
from fem.setup.supports import SUPPORT_MODELS


def build_model(problem: Problem, linear_solver: str, mesh_file: Path | None = None) -> Model:
    """See :func:`fem.prepare`."""
    contact = CONTACT_MODELS.get(problem.tool.contact)
    if contact is None:
        raise FemError(
            f"tool.contact = {problem.tool.contact!r}: not available in this solver; "
            f"available are {', '.join(sorted(CONTACT_MODELS))}"
        )
    warnings = contact.check(problem)
    if problem.geometry == "axisymmetric":
        return _axisymmetric_model(problem, linear_solver, warnings)
    return _solid_model(problem, linear_solver, warnings, mesh_file)


def _solid_model(problem: Problem, linear_solver: str, warnings: tuple[str, ...], mesh_file: Path | None) -> Model:
    from fem.setup.building import solid_model
    from fem.setup.layout_solid import lay_out_block, lay_out_surface

    if problem.surface is None:
        return solid_model(problem, lay_out_block(problem), linear_solver, warnings)
    mesh = lay_out_surface(problem, problem.surface, mesh_file)
    return solid_model(problem, mesh, linear_solver, (*warnings, *mesh.remarks))


def _axisymmetric_model(problem: Problem, linear_solver: str, warnings: tuple[str, ...]) -> Model:
    slipping = [layer for layer, limit in enumerate(problem.shear_limits) if limit is not None]
    mesh = split_interfaces(lay_out(problem), slipping)
    conditions = CONTACT_MODELS[problem.tool.contact].conditions(mesh, problem)
    support = SUPPORT_MODELS[problem.support.kind].fixed(mesh, problem)
    radial = (support & ~sliding_nodes(mesh, problem)) | mesh.axis | conditions.held
    geometry = gauss_geometry(mesh)
    equilibrium = set_up(problem, mesh, geometry, np.stack((radial, support)), conditions, linear_solver)
    elements = equilibrium.system.elements
    recovery = FieldRecovery(mesh, elements.laws, geometry, elements.point_modulus, problem.kinematics == "finite")
    return Model(problem, mesh, equilibrium, recovery, NewtonSettings(), warnings)


def solid_model(problem: Problem, mesh: SolidMesh, linear_solver: str, warnings: tuple[str, ...]) -> Model:
    """Model of a problem on a three-dimensional mesh."""
    tool = problem.tool
    conditions = CONTACT_MODELS[tool.contact].conditions(mesh, problem)
    support = SUPPORT_MODELS[problem.support.kind].fixed(mesh, problem)
    lateral = support | conditions.held
    fixed = np.stack((lateral | mesh.mirror_x, lateral | mesh.mirror_y, support))
    geometry = solid_geometry(mesh)
    equilibrium = set_up(problem, mesh, geometry, fixed, conditions, linear_solver)
    if tool.tilt != 0.0 and conditions.punch is None:
        turned = _turn(mesh, tool.tilt) * conditions.tied
        equilibrium = replace(equilibrium, system=equilibrium.system.displaced(mesh.elements, turned))
    elements = equilibrium.system.elements
    recovery = FieldRecovery(mesh, elements.laws, geometry, elements.point_modulus, problem.kinematics == "finite")
    return Model(problem, mesh, equilibrium, recovery, NewtonSettings(), warnings)


def _turn(mesh: SolidMesh, tilt: float) -> FloatArray:
    """Displacements (3, N) in m of a turn of the top face by `tilt` about the tool's centre, upper end to +x."""
    x = mesh.nodes[:, 0] - mesh.axis_point[0]
    return np.stack(((np.cos(tilt) - 1.0) * x, np.zeros_like(x), -np.sin(tilt) * x))
