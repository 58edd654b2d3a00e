"""The lower face of an axisymmetric body: what a camera under it sees move, out of the fields of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmark.models.result import Array, ModelResult

_SAME = 1e-9


@dataclass(frozen=True)
class LowerFace:
    """Displacement of the lower face at each depth of a ramp; SI.

    Attributes
    ----------
    depth : (k,) array
        Of the press, m, increasing from 0.
    radius : (m,) array
        Distance from the tool axis before the press, m, increasing from 0.
    outward, sunk : (k, m) array
        Away from the axis and downwards, m.
    """

    depth: Array
    radius: Array
    outward: Array
    sunk: Array


def lower_face(result: ModelResult) -> LowerFace | None:
    """Take the lower face out of a depth ramp that kept every field; None where a step has none.

    Parameters
    ----------
    result : ModelResult
        Of an axisymmetric run prepared with `every_field`.
    """
    if not result.time.size or len(result.fields) != result.time.size:
        return None
    points = result.fields[0].points
    low = float(points[:, 2].min())
    rows = np.flatnonzero((points[:, 2] <= low + _SAME) & (np.abs(points[:, 1]) <= _SAME))
    rows = rows[np.argsort(points[rows, 0])]
    radius = points[rows, 0]
    moved = np.array([field.point_data["displacement_m"][rows] for field in result.fields])
    moved = np.concatenate([np.zeros((1, *moved.shape[1:])), moved])
    return LowerFace(np.append(0.0, result.depth), radius, moved[:, :, 0], -moved[:, :, 2])
