"""Markers on a sheet's lower face as a fit of parameters takes them: mean motion away from the axis, ring by ring.

The markers of a set-up are put into rings of about as many by their distance from the tool's axis. A ring's mean
hardly feels where the camera stood; what it still does is a zero of each trial's own. What the model says of a ring
follows from its lower face and the camera's perspective.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmark.identification.sheet_model import FilmedTrial
from benchmark.models.model_result import LowerFace
from benchmark.response.differentiated_ramp import at_places
from benchmark.response.force_curve import Array
from benchmark.response.ramp_table import CameraView

RINGS = 3
CENTRAL = 0.1
"""Markers nearer to the axis than this share of the farthest one's distance have no direction."""
LEAST_MARKERS = 2 * RINGS
SAME_PLACE = 0.3
"""Trials whose markers rest apart by more than this share of the nearest neighbour's distance saw other markers."""
MOST_FRAMES = 250
TRUST = 0.01
"""Standard deviation of the model's size of each ring's motion, a share, independent between rings and presses.

Codes differ by 0.2 % in the field; the rest is for the grid's scale and the camera's distance. First choice.
"""


@dataclass(frozen=True, eq=False)
class MarkerRows:
    """What a trial's film shows.

    Attributes
    ----------
    depth : (f,) array
        Of the actuator, m.
    moved : (f, s) array
        Mean displacement of each ring away from the axis as the camera sees it, m.
    count : (f,) array
        Frames in each row.
    """

    depth: Array
    moved: Array
    count: Array

    def up_to(self, depth: float) -> MarkerRows | None:
        """The rows that are no deeper, m; None where too few are left."""
        kept = self.depth <= depth
        return MarkerRows(self.depth[kept], self.moved[kept], self.count[kept]) if kept.sum() >= LEAST_MARKERS else None


@dataclass(frozen=True, eq=False)
class MarkerRings:
    """The rings of a set-up.

    Attributes
    ----------
    rest : (m, 2) array
        Where markers rest, m from the tool's axis.
    weights : (s, m) array
        Which markers are a ring; rows have the sum 1.
    view : CameraView
        Its centre is from the tool's axis, too.
    """

    rest: Array
    weights: Array
    view: CameraView

    def seen(self, face: LowerFace, depth: Array) -> Array:
        """(k, s) m of each ring over depths (k,) of a lower face, m."""
        return np.asarray(self._moved(*self._at(face, depth)) @ self.weights.T)

    def changes(self, face: LowerFace, outward: Array, sunk: Array, depth: Array) -> Array:
        """(k, s) change of `seen` with that of the face, whose tables (levels, q) are `outward` and `sunk`."""
        radius = self._radius
        (out, deep), (more, deeper) = (
            self._at(face, depth),
            (at_places(face, one, radius, depth) for one in (outward, sunk)),
        )
        if np.isinf(self.view.distance):
            return np.asarray(more @ self.weights.T)
        left = self.view.distance - deep
        grown = self.view.distance / left
        arm = radius - self._unit @ np.asarray(self.view.centre) + out
        return np.asarray((grown * more + grown / left * deeper * arm) @ self.weights.T)

    @property
    def _radius(self) -> Array:
        return np.hypot(self.rest[:, 0], self.rest[:, 1])

    @property
    def _unit(self) -> Array:
        return np.asarray(self.rest / self._radius[:, None])

    def _at(self, face: LowerFace, depth: Array) -> tuple[Array, Array]:
        """Outward and sunk (k, m) at the markers."""
        return at_places(face, face.outward, self._radius, depth), at_places(face, face.sunk, self._radius, depth)

    def _moved(self, outward: Array, sunk: Array) -> Array:
        """(k, m) displacement away from the axis, as the camera sees it."""
        places = self.rest + self._unit * outward[..., None]
        return np.asarray(np.sum((self.view.seen(places, sunk) - self.rest) * self._unit, axis=-1))


def rings_of(
    films: Sequence[FilmedTrial], axes: Sequence[tuple[float, float]], view: CameraView
) -> tuple[MarkerRings, tuple[MarkerRows | None, ...]] | None:
    """The rings of a set-up, and what each of its films shows of them; None with too few markers.

    Parameters
    ----------
    films : sequence of FilmedTrial
    axes : sequence of (float, float)
        Where the tool's axis meets the face in each, m on the plane of the tracks.
    view : CameraView
    """
    arms = [film.rest - np.asarray(axis) for film, axis in zip(films, axes, strict=True)]
    count = max(len(one) for one in arms)
    usual = np.median([one for one in arms if len(one) == count], axis=0)
    near = SAME_PLACE * _nearest(usual)
    alike = [len(one) == count and bool((np.hypot(*(one - usual).T) < near).all()) for one in arms]
    radius = np.hypot(*usual.T)
    used = radius > CENTRAL * radius.max()
    if used.sum() < LEAST_MARKERS:
        return None
    weights = np.zeros((RINGS, int(used.sum())))
    for ring, members in enumerate(np.array_split(np.argsort(radius[used], kind="stable"), RINGS)):
        weights[ring, members] = 1.0 / len(members)
    x, y = np.asarray(view.centre) - np.mean(axes, axis=0)
    rings = MarkerRings(usual[used], weights, CameraView(view.distance, (float(x), float(y))))
    rows = (_rows(film, arm, used, rings) if same else None for film, arm, same in zip(films, arms, alike, strict=True))
    return rings, tuple(rows)


def _nearest(places: Array) -> float:
    """The smallest distance of two markers (m, 2), m."""
    apart = np.hypot(*(places[:, None] - places).transpose(2, 0, 1))
    return float((apart + np.diag(np.full(len(places), np.inf))).min())


def _rows(film: FilmedTrial, arms: Array, used: Array, rings: MarkerRings) -> MarkerRows | None:
    """A film's rows, means of neighbouring frames where there are many; frames that miss a marker are left out."""
    unit = arms[used] / np.hypot(*arms[used].T)[:, None]
    moved = np.sum((film.places[:, used] - film.rest[used]) * unit, axis=-1) @ rings.weights.T
    whole = np.isfinite(moved).all(axis=1)
    if whole.sum() < LEAST_MARKERS:
        return None
    depth, moved = film.depth[whole], moved[whole]
    starts = np.arange(0, len(depth), -(-len(depth) // MOST_FRAMES))
    count = np.diff(np.append(starts, len(depth))).astype(np.float64)
    means = (np.add.reduceat(each, starts, axis=0) for each in (depth, moved))
    depth, moved = next(means) / count, next(means) / count[:, None]
    return MarkerRows(depth, moved, count)
