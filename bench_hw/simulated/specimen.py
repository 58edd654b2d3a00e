"""What lies under the tool: the history of depth in, force and marker positions out.

Anything callable like `Specimen` can be put under the virtual bench. `SheetSpecimen` is a simple one, made to exercise
the bench and not to be a model of tissue. `swinging` and `pressed_sheet` load a device simulated on its own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
PERIOD = 4.0
"""Period of the slow swing, s."""


@dataclass(frozen=True, slots=True)
class Response:
    """What a specimen does, for the rows it was asked for.

    Parameters
    ----------
    force : ndarray (rows, 3)
        Force of the specimen on the tool, N: sideways x and y, and press (positive pushes the tool back).
    markers : ndarray (rows, markers, 3)
        Markers on the lower face, m: x, y, and how far each has sunk towards the camera.
    """

    force: FloatArray
    markers: FloatArray


class Specimen(Protocol):
    """Any physics under the tool."""

    def __call__(self, time: FloatArray, depth: FloatArray, start: int) -> Response:
        """Answer a history of depth.

        Parameters
        ----------
        time : ndarray (n,)
            Instants since the bench was switched on, increasing, s.
        depth : ndarray (n,)
            Depth of the tool's face below the specimen's resting surface, m; negative in air.
        start : int
            The answer is wanted for rows `start` to n - 1; the rows before are history, of which a bench keeps the
            last seconds alone: what must be known of longer ago is the specimen's to remember.

        Returns
        -------
        Response
            For n - start rows.
        """
        ...


@runtime_checkable
class LaidAnew(Protocol):
    """A specimen that does not lie twice alike."""

    def laid_anew(self, rng: np.random.Generator) -> tuple[Specimen, float]:
        """The specimen for the next press, and how far its surface is from the usual place, m."""
        ...


@dataclass(frozen=True, slots=True)
class MarkerGrid:
    """Markers in rows and columns around the tool axis, numbered row by row.

    Parameters
    ----------
    rows, columns : int
        Layout; columns along x, rows along y.
    spacing : float
        Distance of neighbours, m.
    """

    rows: int = 3
    columns: int = 6
    spacing: float = 8e-3

    def positions(self) -> FloatArray:
        """Resting positions (rows * columns, 2), m, the grid's centre at the origin; not to be written to."""
        return _grid_positions(self)


@lru_cache(maxsize=16)
def _grid_positions(grid: MarkerGrid) -> FloatArray:
    x = (np.arange(grid.columns) - (grid.columns - 1) / 2.0) * grid.spacing
    y = (np.arange(grid.rows) - (grid.rows - 1) / 2.0) * grid.spacing
    positions = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    positions.flags.writeable = False
    return positions


@dataclass(frozen=True, slots=True)
class SheetSpecimen:
    """A sheet over a hole that stiffens with depth and resists speed (synthetic, not a tissue).

    Force k d (1 + d / d_s) + c d' while pressed, never negative. The lower face sinks like a clamped plate,
    w(r) = s d (1 - (r / R)^2)^2, and its markers move outwards by half the thickness times the slope.

    Parameters
    ----------
    stiffness : float
        k, N/m.
    stiffening_depth : float
        d_s, depth at which the stiffness by secant has doubled, m.
    damping : float
        c, N s/m.
    hole_radius : float
        R, m.
    thickness : float
        m.
    sinking : float
        s, deflection of the lower face at the centre per depth of the tool.
    grid : MarkerGrid
        Where the markers are at rest.
    """

    stiffness: float = 600.0
    stiffening_depth: float = 6e-3
    damping: float = 20.0
    hole_radius: float = 30e-3
    thickness: float = 4e-3
    sinking: float = 0.9
    grid: MarkerGrid = MarkerGrid()

    def __call__(self, time: FloatArray, depth: FloatArray, start: int) -> Response:
        """Answer a history of depth; only the row before `start` matters of what was."""
        first = max(start - 1, 0)
        pressed = np.maximum(depth[first:], 0.0)
        speed = np.diff(depth[first:]) / np.diff(time[first:])
        if first == start:
            speed = np.concatenate([[0.0], speed])
        pressed = pressed[start - first :]
        press = self.stiffness * pressed * (1.0 + pressed / self.stiffening_depth) + self.damping * speed
        force = np.zeros((len(pressed), 3))
        force[:, 2] = np.where(pressed > 0.0, np.maximum(press, 0.0), 0.0)
        return Response(force, self._markers(pressed))

    def session_keys(self) -> dict[str, dict[str, object]]:
        """What a session file says of this specimen: its support and its markers."""
        return {
            "support": {"kind": "hole", "hole_radius": f"{self.hole_radius * 1e3:g} mm"},
            "camera": {
                "marker_rows": self.grid.rows,
                "marker_columns": self.grid.columns,
                "marker_spacing": f"{self.grid.spacing * 1e3:g} mm",
            },
        }

    def _markers(self, pressed: FloatArray) -> FloatArray:
        rest = self.grid.positions()
        share = np.clip(1.0 - (np.hypot(*rest.T) / self.hole_radius) ** 2, 0.0, None)
        sunk = self.sinking * pressed[:, None] * share**2
        slope = self.sinking * pressed[:, None] * 4.0 / self.hole_radius**2 * share
        moved = rest * (1.0 + 0.5 * self.thickness * slope)[..., None]
        return np.concatenate([moved, sunk[..., None]], axis=-1)


def swinging(peak: float) -> Callable[[FloatArray], FloatArray]:
    """Give a press force that swings between 0 and `peak` (N) every four seconds; instants (n,) to (n, 3)."""

    def load(instants: FloatArray) -> FloatArray:
        force = np.zeros((len(instants), 3))
        force[:, 2] = peak * _swing(instants)
        return force

    return load


def pressed_sheet(depth: float = 2e-3) -> Callable[[float], FloatArray]:
    """Give the markers (m, 3), m, of a sheet pressed between 0 and `depth` (m) every four seconds."""
    specimen = SheetSpecimen()

    def markers(time: float) -> FloatArray:
        instants = np.array([time])
        answer: FloatArray = specimen(instants, depth * _swing(instants), 0).markers[0]
        return answer

    return markers


def _swing(instants: FloatArray) -> FloatArray:
    return np.asarray(0.5 - 0.5 * np.cos(2.0 * np.pi / PERIOD * instants))
