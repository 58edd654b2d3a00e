"""A snapshot of the continuum as a VTU file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmark.models.result import FieldSnapshot


def save_grid(snapshot: FieldSnapshot, path: Path) -> None:
    """Write a snapshot as VTU."""
    import pyvista

    grid = pyvista.UnstructuredGrid(
        {snapshot.cell_type: np.asarray(snapshot.cells)}, np.asarray(snapshot.points, dtype=float)
    )
    for name, values in snapshot.point_data.items():
        grid.point_data[name] = values
    for name, values in snapshot.cell_data.items():
        grid.cell_data[name] = values
    grid.save(path)
