"""The marker grid and the combinations of markers in which effects show themselves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.discovery.result import Array
from benchmark.discovery.study import Layout
from benchmark.files import Camera

RINGS = 3
CENTRAL = 0.2
"""Markers nearer to the axis than this share of the spacing have no direction."""


def grid(camera: Camera) -> Array:
    """(rows * columns, 2) nominal positions in m, row by row, round the grid's centre."""
    columns = (np.arange(camera.marker_columns) - 0.5 * (camera.marker_columns - 1)) * camera.marker_spacing
    rows = (np.arange(camera.marker_rows) - 0.5 * (camera.marker_rows - 1)) * camera.marker_spacing
    y, x = np.meshgrid(rows, columns, indexing="ij")
    return np.column_stack([x.ravel(), y.ravel()])


def layout(rest: Array, spacing: float) -> Layout:
    """Combinations for markers at rest positions (m, 2): by ring, tangential, translations and cos 2 theta."""
    radius = np.hypot(rest[:, 0], rest[:, 1])
    outside = radius > CENTRAL * spacing
    unit = np.divide(rest, radius[:, None], out=np.zeros_like(rest), where=outside[:, None])
    around = np.column_stack([-unit[:, 1], unit[:, 0]])
    angle = 2.0 * np.arctan2(rest[:, 1], rest[:, 0])
    rows: list[tuple[str, str, Array]] = []
    for number, ring in enumerate(_rings(radius, outside), start=1):
        rows.append((f"radial_{number}", "marker_radial", unit * ring[:, None] / ring.sum()))
    rows.append(("tangential", "marker_tangential", around * outside[:, None] / outside.sum()))
    ones = np.ones(len(rest)) / len(rest)
    rows.append(("x", "marker_x", np.column_stack([ones, 0.0 * ones])))
    rows.append(("y", "marker_y", np.column_stack([0.0 * ones, ones])))
    rows.append(("cos_2", "marker_radial", _free_of_mean(unit * np.cos(angle)[:, None] * outside[:, None], unit)))
    names, channels, weights = zip(*rows, strict=True)
    return Layout(rest, np.array(weights), tuple(names), tuple(channels))


def _rings(radius: Array, outside: np.ndarray) -> Sequence[Array]:
    """Masks (m,) of up to three rings with about equally many markers."""
    levels = np.unique(np.round(radius[outside], 6))
    groups = np.array_split(levels, min(RINGS, levels.size))
    return [(outside & (radius >= g[0] - 1e-6) & (radius <= g[-1] + 1e-6)).astype(float) for g in groups]


def _free_of_mean(pattern: Array, unit: Array) -> Array:
    """Pattern (m, 2) without its part along a uniform radial motion, on the scale of a mean."""
    pattern = pattern - unit * np.sum(pattern * unit) / max(np.sum(unit * unit), 1e-30)
    return np.asarray(pattern / max(len(pattern), 1))
