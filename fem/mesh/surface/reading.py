"""Surface files: STL, OBJ, PLY and VTK, read by pyvista."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from fem.checks import require_one_of
from fem.errors import FemError
from fem.mesh.surface.model import Surface

UNITS = {"um": 1e-6, "mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 25.4e-3}
SUFFIXES = (".stl", ".obj", ".ply", ".vtk", ".vtp")


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
    import pyvista

    try:
        with warnings.catch_warnings():  # what the reader has to say ends in the error below
            warnings.simplefilter("ignore", UserWarning)
            data = pyvista.read(file)
        polygons = data if isinstance(data, pyvista.PolyData) else data.extract_surface(algorithm="dataset_surface")
        triangles = polygons.triangulate().clean(tolerance=1e-9)
    except (ValueError, RuntimeError, OSError, AttributeError) as error:
        raise FemError(f"surface {file}: cannot be read ({error})") from error
    if triangles.n_cells == 0 or triangles.faces.size == 0:
        raise FemError(f"surface {file}: has no triangles")
    corners = np.asarray(triangles.faces).reshape(-1, 4)[:, 1:].astype(np.int64)
    return Surface(UNITS[unit] * np.asarray(triangles.points, dtype=np.float64), corners, source=str(file))
