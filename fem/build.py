"""The set-up of a model by its geometry; what three dimensions need is loaded with the first such model."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from fem.assembly import gauss_geometry
from fem.contact import CONTACT_MODELS
from fem.equations import set_up
from fem.errors import FemError
from fem.fields import FieldRecovery
from fem.layout import lay_out
from fem.mesh.split import split_interfaces
from fem.model import Model
from fem.problem import Problem
from fem.solving import NewtonSettings
from fem.supports import SUPPORT_MODELS
from fem.supports.clamp import clamp_sliding, sliding_nodes


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
    from fem.layout_block import lay_out_block
    from fem.layout_surface import lay_out_surface
    from fem.setup_solid import solid_model

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
    sliding = clamp_sliding(mesh, problem, equilibrium.system.numbering)
    if sliding is not None:
        equilibrium = replace(equilibrium, system=equilibrium.system.rubbing(sliding))
    system = equilibrium.system
    recovery = FieldRecovery(mesh, system.laws, geometry, system.point_modulus, problem.kinematics == "finite")
    return Model(problem, mesh, equilibrium, recovery, NewtonSettings(), warnings)
