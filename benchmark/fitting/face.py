"""Where a camera sees the markers of a sheet that is pressed: the lower face of a model, and perspective."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from benchmark.fitting.curve import Array
from benchmark.fitting.errors import FittingError


@dataclass(frozen=True)
class View:
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


EVERYWHERE = View()
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
    FittingError
        Shapes that do not fit each other.
    """

    depth: Array
    radius: Array
    outward: Array
    sunk: Array

    def __post_init__(self) -> None:
        shape = (len(self.depth), len(self.radius))
        if self.outward.shape != shape or self.sunk.shape != shape or min(shape) < 4:
            raise FittingError(
                f"lower face: outward {self.outward.shape} and sunk {self.sunk.shape} need the shape {shape}, each at "
                "least 4"
            )

    def __call__(self, depth: Array, radius: Array) -> tuple[Array, Array]:
        """Outward and sunk, (n, m) m, at depths (n,) and radii (m,) m; beyond the ends as at them."""
        at_radii = self._over_radius(np.clip(radius, 0.0, self.radius[-1]))
        over_depth = scipy.interpolate.CubicSpline(self.depth, at_radii)
        outward, sunk = np.moveaxis(over_depth(np.clip(depth, 0.0, self.depth[-1])), 1, 0)
        return outward, sunk

    def markers(self, rest: Array, axis: Array, depth: Array, view: View) -> Array:
        """Where a camera sees the markers.

        Parameters
        ----------
        rest : (m, 2) array
            Where they rest, m.
        axis : (2,) array
            Where the tool's axis meets the face, m.
        depth : (n,) array
            Below contact, m; in the air nothing moves.
        view : View

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
