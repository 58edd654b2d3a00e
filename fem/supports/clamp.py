"""The plate round a hole on which the lower face of a sheet slides where the shear stress passes a limit."""

from __future__ import annotations

import numpy as np

from fem.arrays import BoolArray, FloatArray
from fem.assembly.scatter import Numbering
from fem.assembly.sliding import Sliding
from fem.mesh import Mesh
from fem.mesh.rows import ring_areas
from fem.problem import Problem
from fem.supports.hole import on_the_plate

STICK = 3e3  # stiffness against sliding below the limit, in shear moduli over the thickness of the lowest layer


def sliding_nodes(mesh: Mesh, problem: Problem) -> BoolArray:
    """Nodes (N,) that slide on the plate: all on it but those of the outer border."""
    if problem.support.clamp_shear_limit is None:
        return np.zeros(len(mesh.nodes), dtype=np.bool_)
    return on_the_plate(mesh, problem) & ~mesh.border


def clamp_sliding(mesh: Mesh, problem: Problem, numbering: Numbering) -> Sliding | None:
    """Friction between sheet and plate; None where the sheet does not slide."""
    limit = problem.support.clamp_shear_limit
    if limit is None:
        return None
    row = np.flatnonzero(on_the_plate(mesh, problem))
    row = row[np.argsort(mesh.nodes[row, 0])]
    moving = sliding_nodes(mesh, problem)[row]
    area: FloatArray = ring_areas(mesh.nodes[row, 0])[moving]
    last = problem.layers[-1]
    stick = STICK * last.material.shear_modulus / last.thickness * area
    return Sliding(numbering.unknown[0, row[moving]], stick, limit * area, np.zeros(len(area)))
