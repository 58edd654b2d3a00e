"""Graded meshes of layered specimens."""

from typing import TypeAlias

from fem.mesh.block import build_block
from fem.mesh.disc_grid import DiscGrid
from fem.mesh.grading import Feature, Sizing, graded_line
from fem.mesh.quads import Mesh
from fem.mesh.solid import SolidMesh
from fem.mesh.structured import Fan, build_mesh
from fem.mesh.surface import MeshQuality, Surface, SurfaceMesh, build_surface_mesh, check_surface, read_surface

AnyMesh: TypeAlias = Mesh | SolidMesh

__all__ = [
    "AnyMesh",
    "DiscGrid",
    "Fan",
    "Feature",
    "Mesh",
    "MeshQuality",
    "Sizing",
    "SolidMesh",
    "Surface",
    "SurfaceMesh",
    "build_block",
    "build_mesh",
    "build_surface_mesh",
    "check_surface",
    "graded_line",
    "read_surface",
]
