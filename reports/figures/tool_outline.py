"""A round tool as it is drawn and called: flat, with a rounded edge, or a sphere; upright or tilted."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, degrees, pi, sin

import numpy as np

from reports.figures.arrays import Floats
from reports.formatting import format_number

ARC = 24
"""Points of a rounded edge."""


@dataclass(frozen=True)
class ToolShape:
    """Radius and edge radius in mm (0: sharp, as large as the radius: a sphere), and the tilt of the axis in rad."""

    radius_mm: float
    edge_radius_mm: float = 0.0
    tilt: float = 0.0

    @property
    def words(self) -> str:
        """The shape in words."""
        edge = format_number(float(self.edge_radius_mm), 3, trim=True)
        end = "flat" if self.edge_radius_mm == 0.0 else f"flat, its edge rounded to {edge} mm"
        if self.edge_radius_mm == self.radius_mm:
            end = "spherical"
        return end if self.tilt == 0.0 else f"{end}, tilted by {format_number(degrees(self.tilt), 3, trim=True)}°"

    def outline(self, height: float) -> Floats:
        """Corners (n, 2) of a tool of this height that just touches the surface: x and depth, both mm."""
        edge, flat = self.edge_radius_mm, self.radius_mm - self.edge_radius_mm
        angles = np.linspace(0.0, 0.5 * pi, ARC) if edge > 0.0 else np.zeros(1)
        right = np.column_stack([flat + edge * np.sin(angles), edge * (np.cos(angles) - 1.0)])
        if edge == 0.0:
            right = np.array([[self.radius_mm, 0.0]])
        top = np.array([[self.radius_mm, -max(height, edge)]])
        half = np.vstack([right, top])
        corners = np.vstack([half, (half * [-1.0, 1.0])[::-1]])
        turn = np.array([[cos(self.tilt), -sin(self.tilt)], [sin(self.tilt), cos(self.tilt)]])
        turned = corners @ turn.T
        return np.asarray(turned - [0.0, turned[:, 1].max()])
