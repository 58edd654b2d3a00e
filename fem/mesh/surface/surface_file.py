"""A triangulated surface, and the files it is read from: STL, OBJ, PLY and VTK by pyvista.

Light to import: the libraries are loaded by the first file. What could crash the reader is read apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.errors import FemError, require_one_of
from fem.mesh.surface.own_process import read_apart, read_triangles

UNITS = {"um": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 25.4e-3}
SUFFIXES = (".stl", ".obj", ".ply", ".vtk", ".vtp")


@dataclass(frozen=True, eq=False)
class Surface:
    """A triangulated surface, z upwards.

    Attributes
    ----------
    points
        Positions (P, 3) in m.
    triangles
        Corners (T, 3), counter-clockwise seen from outside.
    remarks
        What was repaired, in words.
    source
        Where it came from, for messages; "" if it was made in code.
    """

    points: FloatArray
    triangles: IntArray
    remarks: tuple[str, ...] = ()
    source: str = ""

    @property
    def label(self) -> str:
        """What messages call it."""
        return f"surface {self.source}".rstrip()

    @property
    def corners(self) -> FloatArray:
        """Corner positions (T, 3, 3) of each triangle in m."""
        out: FloatArray = self.points[self.triangles]
        return out

    @property
    def area_vectors(self) -> FloatArray:
        """Outward normals (T, 3) as long as the triangles' areas, in m2."""
        a, b, c = self.corners.transpose(1, 0, 2)
        out: FloatArray = 0.5 * np.cross(b - a, c - a)
        return out

    @property
    def volume(self) -> float:
        """Enclosed volume in m3, negative if the triangles look inwards."""
        return float(np.einsum("ti,ti->", self.corners.mean(axis=1), self.area_vectors) / 3.0)

    @property
    def size(self) -> FloatArray:
        """Extents (3,) of the bounding box in m."""
        used = self.points[np.unique(self.triangles)]
        out: FloatArray = used.max(axis=0) - used.min(axis=0)
        return out


def read_surface(path: str | Path, unit: str) -> Surface:
    """Read a surface; what it is worth is for :func:`check_surface` to say.

    Parameters
    ----------
    path
        STL, OBJ, PLY or VTK file.
    unit
        Unit of its coordinates: "um", "mm", "cm", "m" or "inch".

    Raises
    ------
    FemError
        If the file cannot be read as a surface or has no triangles.
    """
    require_one_of("surface_unit", unit, UNITS)
    file = Path(path)
    if file.suffix.lower() not in SUFFIXES:
        raise FemError(f"surface {file}: the suffix {file.suffix!r} is not one of {', '.join(SUFFIXES)}")
    if not file.is_file() or file.stat().st_size == 0:
        raise FemError(f"surface {file}: {'is empty' if file.is_file() else 'there is no such file'}")
    points, corners = read_triangles(file) if file.suffix.lower() == ".stl" else read_apart(file)
    if not np.isfinite(points).all():
        raise FemError(f"surface {file}: has a point that is no finite number")
    if corners.min() < 0 or corners.max() >= len(points):
        raise FemError(f"surface {file}: has a face that names a point which is not there")
    return Surface(UNITS[unit] * points, corners, source=str(file))
