"""The mesh of a problem whose body is bounded by a surface."""

from __future__ import annotations

from pathlib import Path

from fem.mesh.surface import Surface, SurfaceMesh, build_surface_mesh
from fem.problem import Problem

DENSITY = {"coarse": 0.7, "default": 1.0, "fine": 1.5}


def lay_out_surface(problem: Problem, surface: Surface, keep: Path | None = None) -> SurfaceMesh:
    """Mesh of a problem with `geometry` "surface" (see :func:`fem.mesh.surface.build_surface_mesh`)."""
    thickness = tuple(layer.thickness for layer in problem.layers)
    tool = (*problem.tool.position, problem.tool.radius)
    return build_surface_mesh(surface, thickness, tool, DENSITY[problem.discretisation.density], keep)
