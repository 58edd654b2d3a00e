"""The marker grid as it was printed: where each marker rests, by how much they scatter, how well the scale is known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import f as f_distribution

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import Array
from benchmark.discovery.trials.rows import RawTrial
from benchmark.files import Camera

FAR = 4.5
"""A marker farther off the others' grid than so many standard deviations says nothing of scale and scatter."""
ROUNDS = 5
DISTORTED = 1e-6
"""Of a grid's size: markers on one ring differ by less, and show no distortion beside their scale."""
CENTRED = 0.02
"""Of the error of a grid's centre: a frame whose origin lies nearer was laid through the markers' middle."""
PLANE_FREEDOM = 6
"""Degrees of freedom that a plane not quite parallel to the camera's must leave to be fitted."""


@dataclass(frozen=True, eq=False)
class PrintedGrid:
    """A sheet's markers at rest.

    Attributes
    ----------
    places : (m, 2)
        Resting places round the tool axis, m: what was measured, less its translation and its scale.
    origin : (2,)
        Where the camera sees the nominal tool axis, m: zero where its frame's origin is that, else at the middle of the
        markers.
    scatter : float
        Standard deviation of the print along x and along y, m; 0 where tracking hides it.
    scale, scale_error : float
        Of the measured grid relative to the nominal one, and its standard error from the print; 1 and 0 where the
        nominal grid is trusted.
    lens, lens_error : float
        Radial distortion at rest, relative at the outermost marker, and its standard error from print and tracking.
    centre_error : float
        Standard error of that place along x and along y, m: from the print where it is the markers' middle; 0 where the
        nominal grid is trusted.
    """

    places: Array
    origin: Array
    scatter: float
    scale: float
    scale_error: float
    lens: float = 0.0
    lens_error: float = np.inf
    centre_error: float = 0.0

    @property
    def exact(self) -> bool:
        """Whether the nominal grid is trusted."""
        return self.scatter == 0.0

    @property
    def remark(self) -> str:
        """What a reader must know of it; "" for nothing."""
        if self.exact:
            return ""
        return (
            f"markers scatter by {1e3 * self.scatter:.2g} mm round their grid: each is followed from its own resting "
            f"place, and the grid's scale is known to {100 * self.scale_error:.2g} %"
        )


def resting_places(trials: Sequence[RawTrial], seen: NDArray[np.bool_]) -> Array:
    """(R, m, 2) mean places of the markers (mask) before contact, m, in each trial that has frames then."""
    return np.array([place for raw in trials if (place := _before_contact(raw, seen)) is not None]).reshape(
        -1, int(seen.sum()), 2
    )


def _before_contact(raw: RawTrial, seen: NDArray[np.bool_]) -> Array | None:
    if raw.markers is None or raw.frames is None:
        return None
    still = _in_air(raw, raw.frames)
    return np.asarray(raw.markers[still][:, seen].mean(axis=0)) if still.any() else None


def _in_air(raw: RawTrial, frames: Array) -> NDArray[np.bool_]:
    """Frames (f,), s, before contact, as far from it as there are enough.

    Where a depth counts from the force that a sensor first shows, the tool presses a soft sheet before it is zero;
    where it begins, and in the farther half of its way, it surely touches nothing.
    """
    touching = np.flatnonzero(raw.depth > 0.0)
    before = frames < raw.time[touching[0]] if touching.size else np.ones(frames.size, dtype=bool)
    depth = np.interp(frames, raw.time, raw.depth)
    far = (before & (depth < share * raw.depth[0]) for share in criteria.FAR_AIR)
    return next((each for each in far if each.sum() >= criteria.REST_FRAMES), before)


def printed_grid(camera: Camera, nominal: Array, rests: Array) -> PrintedGrid:
    """Fit the nominal grid (m, 2) to resting places (R, m, 2), m.

    A turn, a translation and a scale are the camera's and the grid's placing; what is left of a plane fit is the print
    scatter, where it is more than trials at rest differ by (an F test) or `camera` tells it.
    """
    stated = camera.scale_uncertainty or 0.0
    plain = PrintedGrid(nominal, np.zeros(2), 0.0, 1.0, stated)
    if len(rests) < (2 if camera.print_scatter is None else 1):
        return plain
    mean = rests.mean(axis=0)
    usual = _usual(nominal, mean)
    scale, origin, _ = _similar(nominal, mean, usual)
    variance, freedom = _off_plane(nominal, mean, usual)
    tracking, known = _tracking(rests)
    if camera.print_scatter is not None:
        scatter = camera.print_scatter
    elif variance <= tracking * f_distribution.ppf(criteria.PRINT_LEVEL, freedom, known):
        lens, lens_error = _distortion(nominal, mean, usual, tracking)
        return replace(plain, lens=lens, lens_error=lens_error)
    else:
        scatter = float(np.sqrt(variance - tracking))
    centred = nominal[usual] - nominal[usual].mean(axis=0)
    error = float(np.hypot(scatter / np.sqrt(np.sum(centred**2)), stated))
    lens, lens_error = _distortion(nominal, mean, usual, tracking + scatter**2)
    origin, centre_error = _tool_axis(rests, origin, scatter / float(np.sqrt(usual.sum())))
    return PrintedGrid((mean - origin) / scale, origin, scatter, scale, error, lens, lens_error, centre_error)


def _tool_axis(rests: Array, middle: Array, error: float) -> tuple[Array, float]:
    """Where the camera sees the nominal tool axis (2,), m, and its standard error, m, from the markers' middle.

    A session's frame has its origin there. It is taken at its word where the middle is no farther from it than the
    print lets it be, as far as the camera stands still from trial to trial. A frame that lies elsewhere, or whose
    origin is the middle of the markers itself, tells the axis by that middle alone.
    """
    stands = rests.mean(axis=1)
    moved = float(np.sqrt(np.mean(np.var(stands, axis=0)) / len(stands)))
    away = np.abs(middle)
    if moved < error and (away <= FAR * error).all() and (away > CENTRED * error).any():
        return np.zeros(2), moved
    return middle, error


def _distortion(nominal: Array, mean: Array, usual: NDArray[np.bool_], variance: float) -> tuple[float, float]:
    """Radial distortion of the grid (m, 2) at rest, relative at the outermost marker, and its standard error.

    It is what grows with the cube of the radius beside a turn, a translation and a scale; places have the `variance`
    along one axis.
    """
    square = np.sum(nominal**2, axis=1)
    turned = np.column_stack([-nominal[:, 1], nominal[:, 0]])
    moves = [*(np.tile(axis, (len(nominal), 1)) for axis in np.eye(2)), nominal, turned]
    similar = np.column_stack([move[usual].ravel() for move in moves])
    cubic = (nominal * (square / max(float(square.max()), 1e-300))[:, None])[usual].ravel()
    cubic = cubic - similar @ np.linalg.lstsq(similar, cubic, rcond=None)[0]
    size = float(cubic @ cubic)
    if size <= DISTORTED**2 * float(square[usual].sum()):
        return 0.0, np.inf
    return float(cubic @ mean[usual].ravel()) / size, float(np.sqrt(variance / size))


def _similar(nominal: Array, mean: Array, usual: NDArray[np.bool_]) -> tuple[float, Array, Array]:
    """Scale, translation (2,) and distances (m,) of the grid (m, 2) scaled, turned and moved to its usual markers."""
    grid, seen = (each[:, 0] + 1j * each[:, 1] for each in (nominal, mean))
    middle, there = grid[usual].mean(), seen[usual].mean()
    turned = np.vdot(grid[usual] - middle, seen[usual] - there) / np.sum(np.abs(grid[usual] - middle) ** 2)
    origin = there - turned * middle
    return float(abs(turned)), np.array([origin.real, origin.imag]), np.abs(seen - origin - turned * grid)


def _usual(nominal: Array, mean: Array) -> NDArray[np.bool_]:
    """Markers (m,) that are no farther off the grid than the others scatter."""
    usual = np.ones(len(nominal), dtype=bool)
    for _ in range(ROUNDS):
        off = _similar(nominal, mean, usual)[2]
        near = off <= FAR * np.median(off) / np.sqrt(np.log(4.0))
        if near.sum() < criteria.LEAST_MARKERS or (near == usual).all():
            break
        usual = near
    return usual


def _off_plane(nominal: Array, mean: Array, usual: NDArray[np.bool_]) -> tuple[float, int]:
    """Variance (m2, along one axis) of the usual markers round a plane of the grid, and its degrees of freedom."""
    count = int(usual.sum())
    if 2 * count - 6 < PLANE_FREEDOM:
        return float(np.sum(_similar(nominal, mean, usual)[2][usual] ** 2)) / (2 * count - 4), 2 * count - 4
    plane = np.column_stack([np.ones(count), nominal[usual]])
    rest = mean[usual] - plane @ np.linalg.lstsq(plane, mean[usual], rcond=None)[0]
    return float(np.sum(rest**2)) / (2 * count - 6), 2 * count - 6


def _tracking(rests: Array) -> tuple[float, int]:
    """Variance (m2, along one axis) of a marker's mean place by what trials at rest differ in, and its freedom.

    Where the camera stood in each trial is left out.
    """
    own = rests - rests.mean(axis=1, keepdims=True)
    freedom = (len(rests) - 1) * 2 * (rests.shape[1] - 1)
    return float(np.sum((own - own.mean(axis=0)) ** 2)) / max(freedom, 1) / len(rests), max(freedom, 1)
