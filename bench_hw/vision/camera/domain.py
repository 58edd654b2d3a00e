"""Where in its picture a camera's distortion can be inverted at all."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.camera.model import Camera

_GRID_STEP = 4


@dataclass(frozen=True, slots=True)
class Domain:
    """The part of a picture in which pixels have undistorted places.

    Parameters
    ----------
    fraction : float
        Of the picture's area.
    nearest : float
        Distance of the nearest pixel without an inverse from the principal point, pixels; infinite if there is
        none.
    """

    fraction: float
    nearest: float

    @property
    def whole(self) -> bool:
        """Whether the whole picture can be undistorted."""
        return self.fraction == 1.0

    def __str__(self) -> str:
        if self.whole:
            return "the distortion can be inverted in the whole picture"
        return (
            f"the distortion folds over: it has no inverse in {100 * (1 - self.fraction):.2g} % of the picture, "
            f"from {self.nearest:.0f} px off the principal point on"
        )


def survey_domain(camera: Camera) -> Domain:
    """Find out where a camera's distortion can be inverted, on a grid of 4 pixels that includes the border."""
    width, height = camera.size
    x = np.unique(np.append(np.arange(0, width, _GRID_STEP), width - 1))
    y = np.unique(np.append(np.arange(0, height, _GRID_STEP), height - 1))
    pixels = np.stack(np.meshgrid(x, y), axis=-1).astype(np.float64)
    inside = invertible(camera, pixels)
    outside = pixels[~inside] - np.asarray(camera.centre)
    nearest = float(np.hypot(outside[:, 0], outside[:, 1]).min()) if len(outside) else float("inf")
    return Domain(float(inside.mean()), nearest)


def invertible(camera: Camera, pixels: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Say which pixels (..., 2) have an undistorted place; shape (...)."""
    return np.asarray(np.isfinite(camera.undistorted(pixels)).all(axis=-1))
