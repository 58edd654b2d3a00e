"""Graded meshes of layered specimens."""

from fem.mesh.grading import Feature, Sizing, graded_line
from fem.mesh.quads import Mesh
from fem.mesh.structured import Fan, build_mesh

__all__ = ["Fan", "Feature", "Mesh", "Sizing", "build_mesh", "graded_line"]
