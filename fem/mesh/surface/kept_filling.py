"""The mesher's tetrahedra kept in a file: it is slow, and never makes the same mesh twice."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fem.arrays import FloatArray, IntArray
from fem.errors import CheckpointError
from fem.kept_file import fingerprint, read_kept, write_kept
from fem.mesh.surface.filling import Refinement, fill
from fem.mesh.surface.model import Surface

FORMAT = "fem tetrahedra 1"


def kept_filling(
    surface: Surface, depths: FloatArray, refinement: Refinement, keep: Path | None
) -> tuple[FloatArray, IntArray, IntArray]:
    """Tetrahedra of a checked surface, from a file where it holds those of the same surface, depths and lengths.

    Parameters
    ----------
    surface, depths, refinement
        See :func:`fem.mesh.surface.filling.fill`.
    keep
        The file; one that is not there, damaged or another's is replaced. None keeps nothing.

    Returns
    -------
    tuple of ndarray
        Points (P, 3) in m, tetrahedra (E, 4) of positive volume, layer (E,) of each.

    Raises
    ------
    FemError
        If the surface cannot be filled, or the file not written.
    """
    if keep is None:
        return fill(surface, depths, refinement)
    lengths = (refinement.radius, refinement.fine, refinement.coarse, refinement.growth)
    owner = fingerprint(lengths, (surface.points, surface.triangles, np.asarray(depths), refinement.place))
    try:
        found = read_kept(keep, FORMAT, owner)
    except CheckpointError:
        found = None
    if found is not None:
        return found["points"], found["tetrahedra"], found["layer"]
    points, tetrahedra, layer = fill(surface, depths, refinement)
    write_kept(keep, FORMAT, owner, {"points": points, "tetrahedra": tetrahedra, "layer": layer})
    return points, tetrahedra, layer
