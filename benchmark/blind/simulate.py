"""One trial without noise: reported motion, hidden effects and body to force and seen markers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmark.blind.body.true_body import TrueBody
from benchmark.blind.hidden import Hidden
from benchmark.blind.motion import Array, ReportedMotion

ROUNDS = 60
SETTLED = 1e-7
LENS_REACH = 15e-3


@dataclass(frozen=True)
class FaceMarkers:
    """Markers on the lower face, numbered row by row round the nominal tool axis.

    Attributes
    ----------
    rows, columns : int
    spacing : float
        m.
    off : tuple of (x, y)
        How far each is printed off the grid, m; empty where they are exact.
    lens : float
        Radial distortion: by which share places `LENS_REACH` from the middle look farther out.
    """

    rows: int = 3
    columns: int = 6
    spacing: float = 6e-3
    off: tuple[tuple[float, float], ...] = ()
    lens: float = 0.0

    def positions(self) -> tuple[Array, Array]:
        """Resting x and y (markers,) m."""
        x = self.spacing * (np.arange(self.columns) - 0.5 * (self.columns - 1))
        y = self.spacing * (np.arange(self.rows) - 0.5 * (self.rows - 1))
        off: Array = np.array(self.off) if self.off else np.zeros((self.rows * self.columns, 2))
        return np.tile(x, self.rows) + off[:, 0], np.repeat(y, self.columns) + off[:, 1]

    def through_lens(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Where the camera sees places (f, markers) m."""
        if self.lens == 0.0:
            return x, y
        farther = 1.0 + self.lens * (x**2 + y**2) / LENS_REACH**2
        return x * farther, y * farther


@dataclass(frozen=True, eq=False)
class Signals:
    """What force sensor and camera report.

    Attributes
    ----------
    force : (n,) N
        At the motion's times.
    x, y : (f, markers) m, or None without a camera
        At the motion's frames.
    """

    force: Array
    x: Array | None
    y: Array | None

    def minus(self, other: Signals) -> Signals:
        """Their difference."""
        x = None if self.x is None or other.x is None else self.x - other.x
        y = None if self.y is None or other.y is None else self.y - other.y
        return Signals(self.force - other.force, x, y)


def simulate(
    body: TrueBody, grid: FaceMarkers | None, moved: ReportedMotion, effects: Sequence[Hidden], gain: float = 1.0
) -> Signals:
    """Simulate one trial.

    Parameters
    ----------
    body : TrueBody
    grid : FaceMarkers or None
        None where no camera sees the lower face.
    moved : ReportedMotion
        As the actuator reports it.
    effects : sequence of Hidden
        In any order.
    gain : float
        Factor on this trial's elastic force.
    """
    depth, force = _press(body, moved, effects, gain)
    x, y = (None, None) if grid is None else _seen(body, grid, moved, effects, depth)
    for effect in effects:
        force = effect.reading(moved.time, moved.depth, force)
    return Signals(force, x, y)


def _press(body: TrueBody, moved: ReportedMotion, effects: Sequence[Hidden], gain: float) -> tuple[Array, Array]:
    """True depth and contact force (n,) in balance with the rig; what gives way depends on the force."""
    force = np.zeros_like(moved.depth)
    for _ in range(ROUNDS if any(effect.gives_way for effect in effects) else 1):
        depth, before = moved.depth, force
        for effect in effects:
            depth = effect.travel(moved.time, depth, force)
        force = _contact_force(body, moved, effects, gain, depth)
        if np.abs(force - before).max() < SETTLED:
            break
    return depth, force


def _contact_force(
    body: TrueBody, moved: ReportedMotion, effects: Sequence[Hidden], gain: float, depth: Array
) -> Array:
    """Force (n,) N between tool and specimen at the tool's depth (n,) m."""
    strained = depth
    for effect in effects:
        strained = effect.indent(moved.time, strained)
    elastic = gain * body.force(strained)
    pushes = ((gain if effect.stiffens else 1.0) * effect.push(moved.time, strained, elastic) for effect in effects)
    pushed = elastic + sum(pushes, np.zeros_like(elastic))
    touching = np.where(strained > 0.0, np.clip(pushed, 0.0, None), 0.0)  # a tool that lifts off cannot pull
    return touching + sum((effect.pull(moved.time, strained) for effect in effects), np.zeros_like(elastic))


def _seen(
    body: TrueBody, grid: FaceMarkers, moved: ReportedMotion, effects: Sequence[Hidden], depth: Array
) -> tuple[Array, Array]:
    """Seen marker positions (f, markers) m."""
    strained = depth
    for effect in effects:
        strained = effect.indent(moved.time, strained)
    strained = np.clip(strained, 0.0, None)
    for effect in effects:
        strained = effect.surface(moved.time, depth, strained)
    frames = moved.frames
    for effect in effects:
        frames = effect.instants(frames)
    followed = np.interp(frames, moved.time, strained)
    x, y, sinking = _face(body, grid, effects, followed)
    for effect in effects:
        x, y = effect.sight(x, y, sinking)
    return grid.through_lens(x, y)


def _face(body: TrueBody, grid: FaceMarkers, effects: Sequence[Hidden], followed: Array) -> tuple[Array, Array, Array]:
    """True marker positions and sinking (f, markers) m at the depth (f,) m that the lower face follows.

    A slid face that is pulled back past its rest moves the other way: the field is odd in depth.
    """
    x0, y0 = grid.positions()
    centres = np.array([effect.centre() for effect in effects]).reshape(-1, 2).sum(axis=0)
    across, along = x0 - centres[0], y0 - centres[1]
    radius = np.hypot(across, along)
    outward, sinking = body.lower_face(np.abs(followed), radius)
    sign = np.sign(followed)[:, None]
    away = np.where(radius > 0.0, radius, 1.0)
    ux, uy = sign * outward * across / away, sign * outward * along / away
    for effect in effects:
        along_x, along_y = effect.grip(x0, y0, followed)
        ux, uy = ux * along_x, uy * along_y
    return x0 + ux, y0 + uy, sign * sinking
