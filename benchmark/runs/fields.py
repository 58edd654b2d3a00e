"""Fields of the continuum as VTU files for ParaView and its kin."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchmark.models import FieldSnapshot
from benchmark.picture import save_grid


def write_fields(folder: Path, snapshots: Sequence[FieldSnapshot]) -> list[Path]:
    """Write one `step_NNNN.vtu` a snapshot into `folder` and return the paths; steps count from 1."""
    if not snapshots:
        return []
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for snapshot in snapshots:
        path = folder / f"step_{snapshot.step + 1:04d}.vtu"
        save_grid(snapshot, path)
        paths.append(path)
    return paths
