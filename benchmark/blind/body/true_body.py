"""The true body of a blind session: its elastic force and the motion of its lower face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from benchmark.blind.body.presses import CHANGE, DEEPEST, RADIUS_FACTORS, Press, PressTable, changed_press, press_table
from benchmark.blind.body.specimens import ToldSpecimen
from benchmark.blind.motion import Array

REFERENCE_DEPTH = 2e-3


@dataclass(frozen=True)
class TrueShape:
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
class TrueBody:
    """A specimen with its true shape.

    Attributes
    ----------
    specimen : ToldSpecimen
    shape : TrueShape
    family, clamp : str
        As `press_table` takes them.
    setup : tuple of (key, relative change)
        Changes of the specimen as `changed_press` takes them.
    deepest : float
        Depth to which it is pressed, m.
    """

    specimen: ToldSpecimen
    shape: TrueShape = TrueShape()
    family: str = "first"
    clamp: str = "plate"
    setup: tuple[tuple[str, float], ...] = ()
    deepest: float = DEEPEST

    @property
    def table(self) -> PressTable:
        """Its presses."""
        return press_table(self.specimen, self.family, self.clamp, self.deepest)

    def force(self, depth: Array) -> Array:
        """Elastic force (n,) N at depth (n,) m; zero in air."""
        table = self.table
        pressed = np.clip(depth, 0.0, table.depth[-1])
        rows = self._at_radius(table.force)
        for key, change in self.setup:
            other = self._changed(key).force
            ratio = np.append(1.0, other[1:] / table.force[1, 1:])
            rows = rows * ratio ** (np.log1p(change) / np.log1p(CHANGE))
        curve = CubicSpline(table.depth, rows)
        bend = (np.clip(pressed, 1e-3 * REFERENCE_DEPTH, None) / REFERENCE_DEPTH) ** self.shape.exponent
        out: Array = self.shape.modulus * curve(pressed) * bend
        return out

    def lower_face(self, depth: Array, radius: Array) -> tuple[Array, Array]:
        """Outward motion and sinking (n, m) m of lower-face points at radius (m,) m from the axis."""
        table = self.table
        pressed = np.clip(depth, 0.0, table.depth[-1])
        points = radius / self.shape.width
        outward, sinking = self._at_radius(table.outward), self._at_radius(table.sinking)
        for key, change in self.setup:
            other = self._changed(key)
            outward = outward + change / CHANGE * (other.outward - table.outward[1])
            sinking = sinking + change / CHANGE * (other.sinking - table.sinking[1])
        return _curves(table, outward, points)(pressed), _curves(table, sinking, points)(pressed)

    def _changed(self, key: str) -> Press:
        return changed_press(self.specimen, self.family, self.clamp, key, self.deepest)

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
