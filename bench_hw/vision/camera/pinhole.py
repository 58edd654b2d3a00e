"""The pinhole camera: a matrix, five distortion coefficients, where they can be inverted, and the plane of the markers.

Pixels are OpenCV's: (0, 0) is the middle of the first pixel, x to the right, y down. "Normalised" means divided by
the distance along the optical axis; "undistorted pixels" are normalised points through the matrix alone.

The camera looks at the marker plane at right angles from the distance D = scale fx. A marker that has sunk towards the
camera by w is seen at x_n = X / (D - w): taken for one on the plane, it seems to lie at X D / (D - w), outwards of
its true place. Where w is known this is undone exactly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError
from bench_hw.vision.camera.distortion import undistort

FloatArray = NDArray[np.float64]
_GRID_STEP = 4


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


def plane_of(camera: Camera) -> Plane:
    """Give the camera's marker plane.

    Raises
    ------
    InputError
        It has none.
    """
    if camera.plane is None:
        raise InputError(
            "the camera has no mm_per_px, so nothing can be said in millimetres; "
            "allowed: a camera.toml from `calibrate --plane IMAGE`, or `--pixels`"
        )
    return camera.plane


def distance_of(camera: Camera) -> float:
    """Give the distance D of the marker plane from the camera, m; raises as `plane_of`."""
    return plane_of(camera).scale * camera.focal[0]


def to_plane(camera: Camera, normalised: FloatArray, sunk: FloatArray | float = 0.0) -> FloatArray:
    """Turn undistorted points into places on the marker plane.

    Parameters
    ----------
    camera : Camera
        With a plane.
    normalised : ndarray, shape (..., 2)
        Undistorted, normalised; NaN where not known.
    sunk : ndarray, shape (...), or float
        How far each marker has sunk towards the camera, m; NaN where not known.

    Returns
    -------
    ndarray, shape (..., 2)
        m, x right and y down in the picture, from the plane's origin: X = (D - w) x_n - D x_n0.

    Raises
    ------
    InputError
        The camera has no plane, or a marker has sunk to the camera or beyond.
    """
    distance = distance_of(camera)
    depth = distance - np.asarray(sunk, dtype=np.float64)
    if np.any(depth <= 0.0):
        raise InputError(
            f"a marker has sunk by {float(np.nanmax(sunk)) * 1e3:g} mm; "
            f"allowed: less than the camera's distance, {distance * 1e3:g} mm"
        )
    return np.asarray(depth[..., None] * normalised - distance * _origin(camera))


def from_plane(camera: Camera, places: FloatArray, sunk: FloatArray | float = 0.0) -> FloatArray:
    """Give the undistorted normalised points (..., 2) at which places (..., 2), m, on the plane are seen."""
    distance = distance_of(camera)
    depth = np.asarray(distance - np.asarray(sunk, dtype=np.float64))
    seen: NDArray[np.float64] = (places + distance * _origin(camera)) / depth[..., None]
    return seen


def _origin(camera: Camera) -> FloatArray:
    return camera.to_normalised(np.asarray(plane_of(camera).origin))


@dataclass(frozen=True, slots=True)
class InvertibleDomain:
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


def survey_domain(camera: Camera) -> InvertibleDomain:
    """Find out where a camera's distortion can be inverted, on a grid of 4 pixels that includes the border."""
    width, height = camera.size
    x = np.unique(np.append(np.arange(0, width, _GRID_STEP), width - 1))
    y = np.unique(np.append(np.arange(0, height, _GRID_STEP), height - 1))
    pixels = np.stack(np.meshgrid(x, y), axis=-1).astype(np.float64)
    inside = invertible(camera, pixels)
    outside = pixels[~inside] - np.asarray(camera.centre)
    nearest = float(np.hypot(outside[:, 0], outside[:, 1]).min()) if len(outside) else float("inf")
    return InvertibleDomain(float(inside.mean()), nearest)


def invertible(camera: Camera, pixels: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Say which pixels (..., 2) have an undistorted place; shape (...)."""
    return np.asarray(np.isfinite(camera.undistorted(pixels)).all(axis=-1))
