"""Specimens bounded by a surface: reading, checking and repairing it, filling it with tetrahedra."""

from fem.mesh.surface.checking import check_surface
from fem.mesh.surface.mesh import SurfaceMesh
from fem.mesh.surface.model import Surface
from fem.mesh.surface.quality import MeshQuality
from fem.mesh.surface.reading import read_surface
from fem.mesh.surface.specimen import build_surface_mesh

__all__ = ["MeshQuality", "Surface", "SurfaceMesh", "build_surface_mesh", "check_surface", "read_surface"]
