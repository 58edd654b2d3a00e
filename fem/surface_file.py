"""Reading of surface files. Light to import; the libraries are loaded by the first call."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fem.mesh.surface import Surface


def read_surface(path: str | Path, unit: str) -> Surface:
    """Read the surface of a body for `Problem.surface`; :func:`fem.prepare` checks it.

    Parameters
    ----------
    path
        STL, OBJ, PLY or VTK file, z upwards.
    unit
        Unit of its coordinates: "um", "mm", "cm", "m" or "inch".

    Raises
    ------
    FemError
        If the file cannot be read as a surface or has no triangles.
    """
    from fem.mesh.surface import read_surface as read

    return read(path, unit)
