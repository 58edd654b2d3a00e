"""Graded meshes of layered specimens; those of bodies from a surface are in :mod:`fem.mesh.surface`."""

from typing import TypeAlias

from fem.mesh.block import build_block
from fem.mesh.disc_grid import DiscGrid
from fem.mesh.grading import Feature, Sizing, graded_line
from fem.mesh.quads import Mesh
from fem.mesh.solid import SolidMesh
from fem.mesh.structured import Fan, build_mesh

AnyMesh: TypeAlias = Mesh | SolidMesh

__all__ = [
    "AnyMesh",
    "DiscGrid",
    "Fan",
    "Feature",
    "Mesh",
    "Sizing",
    "SolidMesh",
    "build_block",
    "build_mesh",
    "graded_line",
]
