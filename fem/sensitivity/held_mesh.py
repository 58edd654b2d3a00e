"""The mesh of a changed problem with the topology of the mesh as told.

Radii move linearly between the axis, where the tool's face ends, the tool's radius, the rim of the hole and the outer
border, which stays; depths move linearly between the layers' faces. The lines of a mesh go through these places, so its
elements stay straight.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import numpy as np

from fem.arrays import FloatArray
from fem.errors import NotDifferentiableError
from fem.mesh.quads import Mesh
from fem.mesh.solid import AnyMesh
from fem.problem.problem import Problem

AnyOf = TypeVar("AnyOf", bound=AnyMesh)


def moved_mesh(mesh: AnyOf, told: Problem, changed: Problem) -> AnyOf:
    """The mesh of a problem as told with its nodes where those of the changed one are; itself if nothing moves.

    Raises
    ------
    NotDifferentiableError
        The mesh cannot follow the change.
    """
    nodes = mesh.nodes.copy()
    places, moved = (_depths(problem, mesh) for problem in (told, changed))
    if not np.array_equal(places, moved):
        if told.geometry == "surface":
            raise NotDifferentiableError("thickness: the mesh of a body from a surface cannot follow it")
        nodes[:, -1] = -np.interp(-nodes[:, -1], places, moved)
    places, moved = (_radii(problem, mesh) for problem in (told, changed))
    if not np.array_equal(places, moved):
        if isinstance(mesh, Mesh):
            nodes[:, 0] = np.interp(nodes[:, 0], places, moved)
        elif not (told.touches and told.support == changed.support):
            raise NotDifferentiableError(
                f"geometry = {told.geometry!r}: its mesh cannot follow another radius of a tool that is tied, or of a "
                "hole"
            )
    return mesh if np.array_equal(nodes, mesh.nodes) else replace(mesh, nodes=nodes)


def _depths(problem: Problem, mesh: AnyMesh) -> FloatArray:
    """Depths (L + 1,) in m of the layers' faces; an endless layer ends where the mesh does."""
    thickness = np.array([layer.thickness for layer in problem.layers])
    depths = np.concatenate(([0.0], np.cumsum(thickness)))
    if problem.support.kind == "half_space" or problem.geometry == "surface":
        depths[-1] = -mesh.nodes[:, -1].min()
    return _increasing(depths)


def _radii(problem: Problem, mesh: AnyMesh) -> FloatArray:
    """Radii in m of what the mesh's radial lines go through."""
    tool = problem.tool
    if problem.support.specimen_radius is not None:
        return np.array([0.0, problem.support.specimen_radius])
    face = tool.radius - tool.edge_radius if problem.touches and tool.edge_radius is not None else 0.0
    inner = [face] if face > 0.0 else []
    rim = [] if problem.support.hole_radius is None else [problem.support.hole_radius]
    return _increasing(np.array([0.0, *inner, tool.radius, *rim, float(mesh.specimen_distance.max())]))


def _increasing(places: FloatArray) -> FloatArray:
    if not (np.diff(places) > 0.0).all():
        raise NotDifferentiableError(
            "the mesh cannot follow this change: tool, rim of the hole, border or layers would meet"
        )
    return places
