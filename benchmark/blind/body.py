"""The elastic body that is truly pressed: the FEM's press, bent by what the session does not tell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from benchmark.blind.arrays import Array
from benchmark.blind.specimens import RADIUS_FACTORS, PressTable, Specimen, press_table

REFERENCE_DEPTH = 2e-3


@dataclass(frozen=True)
class Shape:
    """How the true body differs from the one that the session tells of.

    Attributes
    ----------
    modulus : float
        Factor on all moduli.
    radius : float
        Factor on the tool's radius, 0.9 to 1.1.
    exponent : float
        Added to the exponent of force over depth.
    width : float
        Factor on the width of the lower face's displacement field.
    """

    modulus: float = 1.0
    radius: float = 1.0
    exponent: float = 0.0
    width: float = 1.0


@dataclass(frozen=True)
class Body:
    """A specimen with its true shape."""

    specimen: Specimen
    shape: Shape = Shape()

    def force(self, depth: Array) -> Array:
        """Elastic force (n,) N at depth (n,) m; zero in air."""
        table = press_table(self.specimen)
        pressed = np.clip(depth, 0.0, table.depth[-1])
        curve = CubicSpline(table.depth, self._at_radius(table.force))
        bend = (np.clip(pressed, 1e-3 * REFERENCE_DEPTH, None) / REFERENCE_DEPTH) ** self.shape.exponent
        out: Array = self.shape.modulus * curve(pressed) * bend
        return out

    def lower_face(self, depth: Array, radius: Array) -> tuple[Array, Array]:
        """Outward motion and sinking (n, m) m of lower-face points at radius (m,) m from the axis."""
        table = press_table(self.specimen)
        pressed = np.clip(depth, 0.0, table.depth[-1])
        points = radius / self.shape.width
        outward = _curves(table, self._at_radius(table.outward), points)(pressed)
        sinking = _curves(table, self._at_radius(table.sinking), points)(pressed)
        return outward, sinking

    def _at_radius(self, rows: Array) -> Array:
        """A table's value at the true tool radius, quadratic through the three that were computed."""
        a, b, c = RADIUS_FACTORS
        x = self.shape.radius
        weights = (
            (x - b) * (x - c) / ((a - b) * (a - c)),
            (x - a) * (x - c) / ((b - a) * (b - c)),
            (x - a) * (x - b) / ((c - a) * (c - b)),
        )
        out: Array = np.tensordot(weights, rows, axes=1)
        return out


def _curves(table: PressTable, rows: Array, points: Array) -> CubicSpline:
    """Curves over depth at points (m,) of the lower face."""
    return CubicSpline(table.depth, CubicSpline(table.radius, rows, axis=1)(points))
