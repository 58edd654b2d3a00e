"""Tables of an elastic base: force over depth, motion of the lower face, and what a wider tool changes in them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy.interpolate import CubicSpline

from benchmark.discovery.discovery_result import Array
from benchmark.files import Support, Tissue, Tool

POINTS = 500
FIELDS = 5
STEP = 0.06
"""Relative step of the tool's radius by which the base is differentiated."""
MARGIN = 1.25
"""The base reaches this much deeper than the trials."""


@dataclass(frozen=True, eq=False)
class BaseLaw:
    """Tables of a base.

    A bonded lower face does not move, so markers under it stay where they are.

    Attributes
    ----------
    depth : (k,) m from 0, evenly spaced
    force : (k,)
        N at modulus factor 1.
    force_by_radius : (2, k)
        First and second order of the force in the relative change of the tool's radius, N.
    radius : (q,) m
    outward, sink : (FIELDS, k) and (FIELDS, q) each
        Motion of the lower face as a sum of courses over depth times shapes over radius, m.
    outward_by_radius : two of the same
        First and second order of the outward motion in the tool's radius.
    note : str
        What a reader must know of it.
    """

    depth: Array
    force: Array
    force_by_radius: Array
    radius: Array
    outward: tuple[Array, Array] | None = None
    sink: tuple[Array, Array] | None = None
    outward_by_radius: tuple[tuple[Array, Array], ...] = ()
    note: str = ""


BaseLaws: TypeAlias = Callable[[Tissue, Tool, Support, float], BaseLaw]
"""The base of one set-up to a depth, m."""


def resized(tool: Tool, change: float) -> Tool:
    """The tool with its radius changed by a share of it."""
    return tool.model_copy(update={"radius": tool.radius * (1.0 + change)})


def orders(less: Array, told: Array, more: Array) -> tuple[Array, Array]:
    """First and second order in the tool's radius of what was computed with radii smaller, as told, and larger."""
    return 0.5 * (more - less) / STEP, 0.5 * (more - 2.0 * told + less) / STEP**2


def reduced(levels: Array, table: Array, grid: Array) -> tuple[Array, Array]:
    """A table (levels, q) at depths (levels,) as courses over a grid (FIELDS, k) times shapes (FIELDS, q)."""
    left, sizes, right = np.linalg.svd(table, full_matrices=False)
    courses = CubicSpline(levels, left[:, :FIELDS] * sizes[:FIELDS])(grid)
    return np.ascontiguousarray(courses.T), np.ascontiguousarray(right[:FIELDS])
