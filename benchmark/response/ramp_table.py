"""A ramp interpolated: force and lower face over depth, as told and with a set-up parameter changed, and the camera.

Smooth (cubic) between few load steps, for fits whose trials have few thousand rows; `elastic_table` has the same on a
fine even grid, for fits that evaluate it thousands of times.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from benchmark.response.force_curve import Array, ForceCurve, ResponseError


@dataclass(frozen=True)
class CameraView:
    """A camera at right angles to the resting face.

    Attributes
    ----------
    distance : float
        To the resting face, m; infinite where it is not known, so that nothing grows as it comes near.
    centre : (float, float)
        Where its axis meets the face, m on the plane of the tracks.
    """

    distance: float = np.inf
    centre: tuple[float, float] = (0.0, 0.0)

    def seen(self, places: Array, sunk: Array) -> Array:
        """Where places (..., 2) in m that have sunk by (...) m seem to lie on the resting plane."""
        grown = np.ones_like(sunk) if np.isinf(self.distance) else self.distance / (self.distance - sunk)
        return np.asarray(self.centre + (places - self.centre) * grown[..., None])

    def true(self, seen: Array, sunk: Array) -> Array:
        """Where places really are that seem to lie at `seen` (..., 2) on the resting plane; the inverse of `seen`."""
        shrunk = np.ones_like(sunk) if np.isinf(self.distance) else (self.distance - sunk) / self.distance
        return np.asarray(self.centre + (seen - self.centre) * shrunk[..., None])


EVERYWHERE = CameraView()
"""Of a camera that is too far to see anything grow."""


@dataclass(frozen=True)
class FaceField:
    """Displacement of a sheet's lower face over depth and distance from the tool axis, by cubic splines; SI.

    Attributes
    ----------
    depth : (k,) array
        Increasing from 0, k >= 4.
    radius : (m,) array
        Increasing from 0, m >= 4.
    outward, sunk : (k, m) array

    Raises
    ------
    ResponseError
        Shapes that do not fit each other.
    """

    depth: Array
    radius: Array
    outward: Array
    sunk: Array

    def __post_init__(self) -> None:
        shape = (len(self.depth), len(self.radius))
        if self.outward.shape != shape or self.sunk.shape != shape or min(shape) < 4:
            raise ResponseError(
                f"lower face: outward {self.outward.shape} and sunk {self.sunk.shape} need the shape {shape}, each at "
                "least 4"
            )

    def __call__(self, depth: Array, radius: Array) -> tuple[Array, Array]:
        """Outward and sunk, (n, m) m, at depths (n,) and radii (m,) m; beyond the ends as at them."""
        at_radii = self._over_radius(np.clip(radius, 0.0, self.radius[-1]))
        over_depth = scipy.interpolate.CubicSpline(self.depth, at_radii)
        outward, sunk = np.moveaxis(over_depth(np.clip(depth, 0.0, self.depth[-1])), 1, 0)
        return outward, sunk

    def markers(self, rest: Array, axis: Array, depth: Array, view: CameraView) -> Array:
        """Where a camera sees the markers.

        Parameters
        ----------
        rest : (m, 2) array
            Where they rest, m.
        axis : (2,) array
            Where the tool's axis meets the face, m.
        depth : (n,) array
            Below contact, m; in the air nothing moves.
        view : CameraView

        Returns
        -------
        (n, m, 2) array
            m.
        """
        arm = rest - axis
        radius = np.hypot(arm[:, 0], arm[:, 1])
        outward, sunk = self(depth, radius)
        places = rest + arm * (outward / np.maximum(radius, 1e-9))[..., None]
        return view.seen(places, sunk)

    @cached_property
    def _over_radius(self) -> Any:
        """Both fields over the radius, for each depth: (k, 2, m) at radii (m,)."""
        fields = np.stack([self.outward, self.sunk], axis=1)
        return scipy.interpolate.CubicSpline(self.radius, fields, axis=2)


@dataclass(frozen=True)
class Neighbour:
    """The same press with one set-up parameter multiplied by `factor` (above 1): its force and its lower face."""

    factor: float
    curve: ForceCurve
    face: FaceField

    def share(self, log_ratio: float) -> float:
        """How far on the way to the neighbour a parameter is, by the logarithm of its ratio to the file's."""
        return log_ratio / math.log(self.factor)


@dataclass(frozen=True)
class RampTable:
    """A model's answer to one tool and support, and how set-up parameters change it.

    Changes are logarithms of a parameter's ratio to the file's, by its key. The force goes with a power of the
    parameter, the face linearly with the logarithm.

    Attributes
    ----------
    curve, face
        Force and lower face of the specimen as its file has it.
    by : mapping of key to Neighbour
        Keys as in `--set`, and "thickness" for that of all layers together.
    view : CameraView
        The camera.
    """

    curve: ForceCurve
    face: FaceField
    by: Mapping[str, Neighbour] = field(default_factory=dict)
    view: CameraView = EVERYWHERE

    @property
    def reach(self) -> float:
        """Deepest depth that all curves cover, m."""
        return min([self.curve.reach, *(each.curve.reach for each in self.by.values())])

    def force(self, below: Array, changes: Mapping[str, float]) -> Array:
        """Elastic force (n,) N at stiffness factor 1, at depths below contact, m."""
        depth = np.minimum(below, self.reach)
        told = force = self.curve(depth)
        for key, change in changes.items():
            if change != 0.0:
                ratio = np.divide(self.by[key].curve(depth), told, out=np.ones_like(told), where=told > 0.0)
                force = force * ratio ** self.by[key].share(change)
        return np.asarray(force)

    def markers(self, rest: Array, axis: Array, below: Array, changes: Mapping[str, float]) -> Array:
        """Where the camera sees the markers, (n, m, 2) m; see `FaceField.markers`."""
        told = seen = self.face.markers(rest, axis, below, self.view)
        for key, change in changes.items():
            if change != 0.0:
                moved = self.by[key].face.markers(rest, axis, below, self.view)
                seen = seen + self.by[key].share(change) * (moved - told)
        return np.asarray(seen)
