"""Dark compact spots by an adaptive threshold: coarse, fast, and proof against uneven light.

Where they lie is good to a twentieth of a pixel; the edges' work begins there (see `radial`).
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.markers.model import Blobs, FloatArray, Picture

SMALLEST_AREA = 20.0
"""Square pixels: below a radius of 2.5 pixels there is no edge to measure."""
LOWEST_CONTRAST = 20.0
"""Grey levels between paper and ink; less is no marker but noise or shade."""
_THRESHOLD_SHARE = 0.2
_LEAST_OFFSET = 6.0
_FILL = (0.55, 0.95)
_LONGEST_SIDES = 1.8


def contrast_of(grey: Picture) -> float:
    """Give how far the darkest spots lie below the bright part of a picture, grey levels."""
    dark, bright = np.percentile(grey[::2, ::2], (0.5, 90.0))
    return float(bright - dark)


def find_blobs(grey: Picture, block: int, contrast: float, areas: tuple[float, float] | None = None) -> Blobs:
    """Find dark spots about as wide as high that do not touch the picture's border.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture.
    block : int
        Side of the square whose mean a pixel is compared with, pixels; at least three marker radii.
    contrast : float
        Between paper and ink, grey levels: a pixel counts as dark a fifth of it below the mean.
    areas : tuple of 2 floats, optional
        Least and greatest area, square pixels.

    Returns
    -------
    Blobs
        In the order of their labels (by their uppermost pixel).
    """
    smooth = cv2.GaussianBlur(grey, (5, 5), 0)
    offset = max(_LEAST_OFFSET, _THRESHOLD_SHARE * contrast)
    mode, kind = cv2.ADAPTIVE_THRESH_MEAN_C, cv2.THRESH_BINARY_INV
    dark = cv2.adaptiveThreshold(smooth, 255, mode, kind, block | 1, offset)
    _, _, stats, centroids = cv2.connectedComponentsWithStats(dark, connectivity=4)
    box, area = stats[1:, :4].astype(np.float64), stats[1:, cv2.CC_STAT_AREA].astype(np.float64)
    low, high = areas or (SMALLEST_AREA, grey.size / 16.0)
    good = (area >= low) & (area <= high) & _compact(box, area) & _inside(box, grey.shape)
    return Blobs(np.asarray(centroids[1:][good], dtype=np.float64), area[good])


def _compact(box: FloatArray, area: FloatArray) -> NDArray[np.bool_]:
    """Neither long nor ragged nor hollow: a disc fills 0.785 of its box."""
    width, height = box[:, 2], box[:, 3]
    fill = area / (width * height)
    sides = np.maximum(width, height) / np.minimum(width, height)
    return (fill > _FILL[0]) & (fill < _FILL[1]) & (sides < _LONGEST_SIDES)


def _inside(box: FloatArray, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    left, top, width, height = box.T
    return np.asarray((left > 0) & (top > 0) & (left + width < shape[1]) & (top + height < shape[0]))
