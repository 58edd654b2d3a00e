"""Fields of the continuum as VTU files for ParaView and its kin."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmark.models import FieldSnapshot


def write_fields(folder: Path, snapshots: Sequence[FieldSnapshot]) -> list[Path]:
    """Write one `step_NNNN.vtu` a snapshot into `folder` and return the paths; steps count from 1."""
    if not snapshots:
        return []
    import pyvista

    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for snapshot in snapshots:
        grid = pyvista.UnstructuredGrid(
            {snapshot.cell_type: np.asarray(snapshot.cells)}, np.asarray(snapshot.points, dtype=float)
        )
        for name, values in snapshot.point_data.items():
            grid.point_data[name] = values
        for name, values in snapshot.cell_data.items():
            grid.cell_data[name] = values
        path = folder / f"step_{snapshot.step + 1:04d}.vtu"
        grid.save(path)
        paths.append(path)
    return paths
