"""Graded meshes of layered specimens; those of bodies from a surface are in :mod:`fem.mesh.surface`."""
