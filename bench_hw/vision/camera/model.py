"""The camera model: a matrix, five distortion coefficients, and the plane in which the markers lie.

Pixels are OpenCV's: (0, 0) is the middle of the first pixel, x to the right, y down. "Normalised" means divided by
the distance along the optical axis; "undistorted pixels" are normalised points through the matrix alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.camera.inverse import undistort

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Plane:
    """The plane of the resting markers, parallel to the picture.

    Parameters
    ----------
    scale : float
        m per undistorted pixel along x.
    scale_std : float
        Standard deviation of `scale`, m per pixel.
    origin : tuple of 2 floats
        Where the plane's origin is seen, undistorted pixels.
    """

    scale: float
    scale_std: float
    origin: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Quality:
    """How good a calibration is.

    Parameters
    ----------
    views : int
        Pictures of the board that were used.
    reprojection_rms : float
        Distance between found and computed corners, pixels; it contains the noise of the corners and is no
        measure of how well the camera is known.
    map_error_rms : float
        Error of the map from pixels to undistorted pixels, judged by views that were held out, pixels.
    """

    views: int
    reprojection_rms: float
    map_error_rms: float


@dataclass(frozen=True, slots=True)
class Camera:
    """A calibrated camera.

    Parameters
    ----------
    size : tuple of 2 ints
        Width and height of its pictures, pixels.
    focal : tuple of 2 floats
        fx, fy, pixels.
    centre : tuple of 2 floats
        cx, cy, pixels.
    distortion : tuple of 5 floats
        k1, k2, p1, p2, k3 of OpenCV's model.
    plane : Plane, optional
        None where no picture of the marker plane was taken: then nothing can be said in metres.
    quality : Quality, optional
        None for a camera that was not calibrated here.
    """

    size: tuple[int, int]
    focal: tuple[float, float]
    centre: tuple[float, float]
    distortion: tuple[float, float, float, float, float]
    plane: Plane | None = None
    quality: Quality | None = None

    @property
    def matrix(self) -> FloatArray:
        """The camera matrix, shape (3, 3)."""
        (fx, fy), (cx, cy) = self.focal, self.centre
        return np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])

    def to_normalised(self, pixels: FloatArray) -> FloatArray:
        """Take the matrix off pixels (..., 2); what was distorted stays distorted."""
        return np.asarray((pixels - np.asarray(self.centre)) / np.asarray(self.focal))

    def to_pixels(self, normalised: FloatArray) -> FloatArray:
        """Put the matrix on normalised points (..., 2)."""
        return np.asarray(normalised * np.asarray(self.focal) + np.asarray(self.centre))

    def undistorted(self, pixels: FloatArray) -> FloatArray:
        """Turn pixels (..., 2) into undistorted normalised points; NaN where the distortion has no inverse."""
        return undistort(self.to_normalised(pixels), self.distortion)

    def straightened(self, pixels: FloatArray) -> FloatArray:
        """Turn pixels (..., 2) into undistorted pixels; NaN where the distortion has no inverse."""
        return self.to_pixels(self.undistorted(pixels))
