"""Rays from the middle of a marker outwards, and the grey levels along them."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.markers.model import FloatArray, Picture

Float32Array = NDArray[np.float32]

_INNERMOST, _INK_UP_TO, _OUTERMOST = 0.3, 0.6, 1.5
"""Where the samples begin, up to where they count as ink, and where they end, in marker radii."""
_LEAST_REACH = 4.0
_OUTER_WIDTH = 1.25
_SMOOTHING = 0.8
_RAYS = (40, 96)


@dataclass(frozen=True, eq=False, slots=True)
class RayFan:
    """Where to sample around a marker of some radius; the same for all markers of a grid.

    Parameters
    ----------
    marker_radius : float
        The radius it is made for, pixels.
    directions : ndarray, shape (2, rays)
        Cosine and sine of the rays' angles, evenly spread.
    radii : ndarray, shape (samples,)
        Evenly spaced distances from the middle, pixels.
    filters : ndarray, shape (samples, smooth + 2)
        Takes profiles to smoothed profiles, and in the last two columns to the mean of the ink and of the paper.
        Smoothed by a Gaussian about as wide as an edge is blurred: the smoothed profile of a symmetric edge crosses
        half its height where the edge is, whatever the blur, and no other linear filter of the same reach finds it
        with less noise (it is the matched one).
    smooth_radii : ndarray, shape (smooth,)
        Distances of the smoothed samples, pixels.
    paper_radius : float
        Mean distance of the samples of the paper, pixels.
    """

    marker_radius: float
    directions: FloatArray
    radii: FloatArray
    filters: Float32Array
    smooth_radii: FloatArray
    paper_radius: float

    @property
    def step(self) -> float:
        """Distance of two samples, pixels."""
        return float(self.radii[1] - self.radii[0])


def ray_fan(radius: float, spacing: float) -> RayFan:
    """Lay out rays for markers of a radius and a spacing, both in pixels."""
    step = float(np.clip(radius / 20.0, 0.5, 1.0))
    outermost = max(_OUTERMOST * radius, radius + _LEAST_REACH)
    outermost = max(min(outermost, spacing - 1.2 * radius - 1.0), radius + _LEAST_REACH)
    radii = np.arange(_INNERMOST * radius, outermost, step)
    rays = int(np.clip(8 * round(2.0 * np.pi * radius / 8.0), *_RAYS))
    angle = np.arange(rays) * (2.0 * np.pi / rays)
    width = max(_SMOOTHING, step)
    half = int(np.ceil(2.5 * width / step))
    kernel = np.exp(-0.5 * (np.arange(-half, half + 1) * step / width) ** 2)
    smooth = len(radii) - 2 * half
    ink, paper = max(1, int(np.count_nonzero(radii <= _INK_UP_TO * radius))), max(2, round(_OUTER_WIDTH / step))
    filters = np.zeros((len(radii), smooth + 2), np.float32)
    for column in range(smooth):
        filters[column : column + 2 * half + 1, column] = kernel / kernel.sum()
    filters[:ink, smooth], filters[-paper:, smooth + 1] = 1.0 / ink, 1.0 / paper
    return RayFan(
        marker_radius=radius,
        directions=np.stack([np.cos(angle), np.sin(angle)]),
        radii=radii,
        filters=filters,
        smooth_radii=radii[half : len(radii) - half],
        paper_radius=float(radii[-paper:].mean()),
    )


def sample(grey: Picture, centres: FloatArray, fan: RayFan) -> Float32Array:
    """Sample a picture along the rays of some markers.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture.
    centres : ndarray, shape (m, 2)
        Middles of the fans, pixels.
    fan : RayFan
        The rays.

    Returns
    -------
    ndarray of float32, shape (m, rays, samples)
        Grey levels between pixels by bilinear interpolation; black outside the picture.
    """
    offsets = (fan.directions[:, :, None] * fan.radii).reshape(2, -1).astype(np.float32)
    reach = float(fan.radii[-1])
    columns, rows = (_window(centres[:, axis], reach, grey.shape[1 - axis]) for axis in (0, 1))
    part = grey[rows[0] : rows[1], columns[0] : columns[1]].astype(np.float32)
    middles = (centres - (columns[0], rows[0])).astype(np.float32)
    x, y = (middles[:, axis, None] + offsets[axis] for axis in (0, 1))
    values = cv2.remap(part, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
    return np.asarray(values, dtype=np.float32).reshape(len(centres), -1, len(fan.radii))


def _window(middles: FloatArray, reach: float, size: int) -> tuple[int, int]:
    """The part of the picture that is needed, a pixel wider than the samples, at least one pixel."""
    first = int(np.clip(np.floor(middles.min() - reach) - 1, 0, size - 1))
    return first, int(np.clip(np.ceil(middles.max() + reach) + 2, first + 1, size))
