"""From undistorted points to metres on the marker plane and back, with the perspective of markers that sink.

The camera looks at the plane at right angles from the distance D = scale fx. A marker that has sunk towards the
camera by w is seen at x_n = X / (D - w): taken for one on the plane, it seems to lie at X D / (D - w), outwards of
its true place. Where w is known this is undone exactly.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError
from bench_hw.vision.camera.model import Camera, FloatArray, Plane


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
