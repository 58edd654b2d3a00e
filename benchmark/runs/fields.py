"""Fields of the continuum as VTU files for ParaView and its kin."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from bench_hw.errors import how_to_get
from benchmark.models import FieldSnapshot, LastState
from reports import write_text


def missing_vtk() -> str | None:
    """What to install before fields can be written or drawn; None where it is there."""
    return None if find_spec("pyvista") is not None else how_to_get("pyvista")


def save_grid(snapshot: FieldSnapshot, path: Path) -> None:
    """Write a snapshot as VTU, whole or not at all: VTK's own files are cut, or VTK crashes, where a disk is full."""
    import pyvista
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    grid = pyvista.UnstructuredGrid(
        {snapshot.cell_type: np.asarray(snapshot.cells)}, np.asarray(snapshot.points, dtype=float)
    )
    for name, values in snapshot.point_data.items():
        grid.point_data[name] = values
    for name, values in snapshot.cell_data.items():
        grid.cell_data[name] = values
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    writer.WriteToOutputStringOn()
    if not writer.Write():
        raise OSError(f"{path.name}: VTK could not write the fields")
    write_text(path, writer.GetOutputString())


LAST = "last.vtu"
"""The last state of equilibrium of a run that stopped early."""


def write_last(folder: Path, last: LastState | None) -> None:
    """Write the last state of equilibrium into `folder`, where there is one."""
    if last is not None and last.field is not None and missing_vtk() is None:
        folder.mkdir(parents=True, exist_ok=True)
        save_grid(last.field, folder / LAST)


def write_fields(folder: Path, snapshots: Sequence[FieldSnapshot]) -> list[Path]:
    """Write one `step_NNNN.vtu` a snapshot into `folder` and return the paths; steps count from 1; none without VTK."""
    if not snapshots or missing_vtk() is not None:
        return []
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for snapshot in snapshots:
        path = folder / f"step_{snapshot.step + 1:04d}.vtu"
        save_grid(snapshot, path)
        paths.append(path)
    return paths
