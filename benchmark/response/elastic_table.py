"""The elastic table of a set-up: force and lower face on a fine grid of depths, and how set-up parameters change them.

A derivative may come from differences of ramps or be computed directly; the table only keeps its orders. Keys are those
of `--set` (`tool.radius`, `dermis.youngs_modulus`, `support.hole_radius`...). Nothing here runs a model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from scipy.interpolate import CubicSpline

from benchmark.files import Support, Tissue, Tool
from benchmark.response.force_curve import Array

POINTS = 500
"""Depths of a table."""
TERMS = 5
"""Terms of a field."""


@dataclass(frozen=True, eq=False)
class SeparableField:
    """A field over depth and radius, m: the sum of amplitudes (c, k) over depth times shapes (c, q) over radius."""

    amplitudes: Array
    shapes: Array

    @property
    def table(self) -> Array:
        """(k, q) values at all depths and radii, m."""
        return np.asarray(self.amplitudes.T @ self.shapes)

    @staticmethod
    def of(levels: Array, table: Array, grid: Array) -> SeparableField:
        """The first terms of a table (levels, q) at depths (levels,), its amplitudes on a grid (k,) of depths."""
        left, sizes, right = np.linalg.svd(table, full_matrices=False)
        amplitudes = CubicSpline(levels, left[:, :TERMS] * sizes[:TERMS])(grid)
        return SeparableField(np.ascontiguousarray(amplitudes.T), np.ascontiguousarray(right[:TERMS]))

    def plus(self, parts: list[tuple[float, SeparableField]]) -> SeparableField:
        """Itself and factors times other fields on the same depths and radii."""
        amplitudes = [self.amplitudes, *(factor * other.amplitudes for factor, other in parts)]
        return SeparableField(
            np.concatenate(amplitudes), np.concatenate([self.shapes, *(other.shapes for _, other in parts)])
        )


@dataclass(frozen=True, eq=False)
class SetupDerivative:
    """What a set-up parameter changes, by the orders (first, second...) of its relative change.

    Attributes
    ----------
    force : (o, k) array
        N.
    outward, sink : tuple of SeparableField
        One an order, as many as are known; m.
    """

    force: Array
    outward: tuple[SeparableField, ...] = ()
    sink: tuple[SeparableField, ...] = ()


@dataclass(frozen=True, eq=False)
class ElasticTable:
    """Force and lower face over depth.

    A bonded lower face does not move, so markers under it stay where they are.

    Attributes
    ----------
    depth : (k,) array
        m from 0, evenly spaced.
    force : (k,) array
        N at modulus factor 1.
    radius : (q,) array
        m.
    outward, sink : SeparableField or None
        Motion of the lower face away from the axis and along the press.
    by : mapping of key to SetupDerivative
        Parameters act each by itself: there are no mixed terms.
    note : str
        What a reader must know of it.
    """

    depth: Array
    force: Array
    radius: Array
    outward: SeparableField | None = None
    sink: SeparableField | None = None
    by: Mapping[str, SetupDerivative] = field(default_factory=dict)
    note: str = ""

    def force_with(self, changes: Mapping[str, float]) -> Array:
        """(k,) N with parameters changed by shares of their values; a key that the table lacks changes nothing."""
        force = self.force
        for key, change in self._known(changes):
            for order, part in enumerate(self.by[key].force, start=1):
                force = force + change**order * part
        return force

    def outward_with(self, changes: Mapping[str, float]) -> SeparableField | None:
        """The outward motion with parameters changed, as `force_with`."""
        parts = [
            (change**order, part)
            for key, change in self._known(changes)
            for order, part in enumerate(self.by[key].outward, start=1)
        ]
        return None if self.outward is None else self.outward.plus(parts)

    def sink_with(self, changes: Mapping[str, float]) -> SeparableField | None:
        """The sinking with parameters changed, as `force_with`."""
        parts = [
            (change**order, part)
            for key, change in self._known(changes)
            for order, part in enumerate(self.by[key].sink, start=1)
        ]
        return self.sink if self.sink is None or not parts else self.sink.plus(parts)

    def _known(self, changes: Mapping[str, float]) -> list[tuple[str, float]]:
        return [(key, change) for key, change in changes.items() if key in self.by]


TableOf: TypeAlias = Callable[[Tissue, Tool, Support, float], ElasticTable]
"""The table of one set-up to a depth, m."""


def orders(less: Array, told: Array, more: Array, step: float) -> tuple[Array, Array]:
    """First and second order of what was computed with a parameter smaller by a share `step`, as told, and larger."""
    return 0.5 * (more - less) / step, 0.5 * (more - 2.0 * told + less) / step**2
