"""The edge of a marker on rays from its middle: where the smoothed grey level passes half way from ink to paper."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor
from typing import TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.markers.grid import FloatArray, IntArray, Picture

Float32Array = NDArray[np.float32]

_INNERMOST, _INK_UP_TO, _OUTERMOST = 0.3, 0.6, 1.5
"""Where the samples begin, up to where they count as ink, and where they end, in marker radii."""
_LEAST_REACH = 4.0
_OUTER_WIDTH = 1.25
_SMOOTHING = 0.8
_RAYS = (40, 96)
Level = TypeVar("Level", np.float32, np.float64)
RAY_CONTRAST = 0.5
"""A ray counts where ink and paper differ by this share of what is usual for its marker..."""
STRANGE_PAPER = 0.2
"""... and its paper is as bright as elsewhere around the marker, within this share of the contrast..."""
_SPREADS = 4.0
"""... or within so many usual deviations, if those are more."""
_EDGE_WIDTH = 3.0
"""Contrast over the slope of a smoothed edge, pixels: of a webcam's sharpness."""
_WHITE = 245.0
"""Paper brighter than this shows no noise: the ink's counts too."""
_BESIDE, _LEAST_RISE, _FARTHEST = 1.0, 1.0, 3.0
"""The slope beside an edge is taken over so many pixels, is at least so many grey levels over them, and is greatest
within so many pixels."""


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
    offsets : ndarray of float32, shape (2, rays * samples)
        The samples from the middle, x and y, pixels.
    """

    marker_radius: float
    directions: FloatArray
    radii: FloatArray
    filters: Float32Array
    smooth_radii: FloatArray
    paper_radius: float
    offsets: Float32Array

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
    directions = np.stack([np.cos(angle), np.sin(angle)])
    return RayFan(
        marker_radius=radius,
        directions=directions,
        radii=radii,
        filters=filters,
        smooth_radii=radii[half : len(radii) - half],
        paper_radius=float(radii[-paper:].mean()),
        offsets=(directions[:, :, None] * radii).reshape(2, -1).astype(np.float32),
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
    reach = float(fan.radii[-1])
    columns, rows = (_window(centres[:, axis], reach, grey.shape[1 - axis]) for axis in (0, 1))
    part = grey[rows[0] : rows[1], columns[0] : columns[1]].astype(np.float32)
    middles = (centres - (columns[0], rows[0])).astype(np.float32)
    x, y = (middles[:, axis, None] + fan.offsets[axis] for axis in (0, 1))
    values = cv2.remap(part, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT)
    return np.asarray(values, dtype=np.float32).reshape(len(centres), -1, len(fan.radii))


def _window(middles: FloatArray, reach: float, size: int) -> tuple[int, int]:
    """The part of the picture that is needed, a pixel wider than the samples, at least one pixel."""
    first = min(max(floor(middles.min() - reach) - 1, 0), size - 1)
    return first, min(max(ceil(middles.max() + reach) + 2, first + 1), size)


@dataclass(frozen=True, eq=False, slots=True)
class Edges:
    """Edges of some markers.

    Parameters
    ----------
    radius : ndarray, shape (m, rays)
        Distance of the edge from the fan's middle, pixels; of no meaning where there is none.
    there : ndarray of bool, shape (m, rays)
        Whether the ray goes from ink over an edge to paper.
    contrast : ndarray, shape (m,)
        Paper less ink, median over the rays, grey levels.
    tilt : ndarray, shape (m, 2)
        How the middle level between ink and paper changes from the middle of the marker to its edge towards x and
        y, grey levels: uneven light, which dims ink and paper alike, as the paper around the marker shows it.
    tilt_std : ndarray, shape (m,)
        Standard deviation of either number of `tilt`.
    noise : ndarray, shape (m,)
        Standard deviation of a radius as the noise of the paper lets it be expected, pixels; rough.
    steepest : ndarray, shape (m, rays / 2)
        Of every second ray, how far outwards of the edge the grey level rises most steeply, pixels: no light on ink and
        paper moves that; 0 where there is no edge, or the ray does not reach beyond it.
    """

    radius: FloatArray
    there: NDArray[np.bool_]
    contrast: FloatArray
    tilt: FloatArray
    tilt_std: FloatArray
    noise: FloatArray
    steepest: FloatArray


def find_edges(profiles: Float32Array, fan: RayFan, tilt: FloatArray) -> Edges:
    """Find the first crossing of the middle level on each ray.

    Parameters
    ----------
    profiles : ndarray of float32, shape (m, rays, samples)
        Grey levels along the rays.
    fan : RayFan
        The rays.
    tilt : ndarray, shape (m, 2)
        Known tilt of the middle level (as in `Edges`), so that uneven light does not shift the marker.
    """
    filtered = profiles @ fan.filters
    ink, paper = filtered[:, :, -2], filtered[:, :, -1]
    usual_ink, usual_paper = _medians(ink), _medians(paper)
    contrast = (usual_paper - usual_ink).astype(np.float64)
    slant = tilt @ fan.directions
    middle = 0.5 * (usual_paper + usual_ink)[:, None] + slant.astype(np.float32)
    at, before, after = _crossing(filtered, middle)
    there = (before < 0.0) & (after >= 0.0) & (contrast > 0.0)[:, None]
    strange = _strangeness(paper - slant)
    spread = 1.4826 * _medians(strange)
    there &= strange < np.maximum(STRANGE_PAPER * contrast, _SPREADS * spread)[:, None]
    there &= paper - ink > RAY_CONTRAST * contrast[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = fan.smooth_radii[at] - fan.step * before / (after - before)
    dimming = _dimming(usual_ink, usual_paper, fan)
    count = fan.directions.shape[1]
    seen_tilt = paper.astype(np.float64) @ fan.directions.T * (2.0 / count * dimming[:, None])
    tilt_std = spread * dimming * np.sqrt(2.0 / count)
    if usual_paper.max(initial=0.0) > _WHITE:
        spread = np.maximum(spread, 1.4826 * _medians(np.abs(ink - usual_ink[:, None])))
    noise = _EDGE_WIDTH * spread / np.maximum(contrast, 1.0)
    steepest, told = _steepest(filtered, at, (before, after), middle, contrast, fan)
    steepest = np.where(there[:, ::2] & told, steepest - radius[:, ::2], 0.0)
    return Edges(np.where(there, radius, 0.0), there, contrast, seen_tilt, tilt_std, noise, steepest)


def _crossing(filtered: Float32Array, middle: Float32Array) -> tuple[IntArray, FloatArray, FloatArray]:
    """Where smoothed profiles (m, rays, smooth + 2) first pass the middle level (m, rays), and by how much.

    The sample before, and how far it and the next one are above the level; (m, rays) each.
    """
    below = filtered[:, :, :-2] < middle[:, :, None]
    at = (below[:, :, :-1] > below[:, :, 1:]).argmax(axis=2)
    place = at + np.arange(0, filtered.size, filtered.shape[2]).reshape(at.shape)
    before, after = (filtered.take(place + ahead).astype(np.float64) - middle for ahead in (0, 1))
    return at, before, after


def _steepest(
    filtered: Float32Array,
    at: IntArray,
    beside: tuple[FloatArray, FloatArray],
    middle: Float32Array,
    contrast: FloatArray,
    fan: RayFan,
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """How far from the middle every second profile rises most steeply, pixels, and whether it reaches beyond.

    Profiles (m, rays, smooth + 2), `at`, `beside` and `middle` are those of `_crossing`.

    The slope of a blurred edge is a Gaussian about the edge: the logarithms of two slopes differ by their middle's
    distance from the edge times their own distance, over the square of its width, which is the contrast over the
    greatest slope and the root of 2 pi.
    """
    wide, last = max(1, round(_BESIDE / fan.step)), filtered.shape[2] - 3
    first = np.arange(0, filtered.size, 2 * filtered.shape[2]).reshape(len(at), -1)
    at, before, after = at[:, ::2], beside[0][:, ::2], beside[1][:, ::2]
    inner, outer = at - wide, at + (1 + wide)
    told = (inner >= 0) & (outer <= last)
    levels = filtered.take(first + np.stack([np.maximum(inner, 0), np.minimum(outer, last)])) - middle[:, ::2]
    rises = np.maximum(np.stack([before - levels[0], levels[1] - after]), _LEAST_RISE)
    logs = np.log(rises.astype(np.float32))
    slope = np.maximum((levels[1] - levels[0]).sum(axis=1) / at.shape[1], _LEAST_RISE) / (fan.step * (2 * wide + 1))
    square = (contrast / slope) ** 2 / (2.0 * np.pi)
    shift = (square / (fan.step * (wide + 1)))[:, None] * (logs[1] - logs[0])
    shift = np.minimum(np.maximum(shift, -_FARTHEST), _FARTHEST)
    return float(fan.smooth_radii[0]) + fan.step * (at + 0.5) + shift, told


def _strangeness(paper: FloatArray) -> FloatArray:
    """How far paper (m, rays), uneven light taken off, is from what it is around the marker, grey levels."""
    return np.asarray(np.abs(paper - _medians(paper)[:, None]))


def _medians(values: NDArray[Level]) -> NDArray[Level]:
    """Medians over an even number of rays, (m, rays) to (m,)."""
    half = values.shape[1] // 2
    parted = np.partition(values, (half - 1, half), axis=1)
    return np.asarray((parted[:, half - 1] + parted[:, half]) / 2, dtype=values.dtype)


def _dimming(ink: Float32Array, paper: Float32Array, fan: RayFan) -> FloatArray:
    """From a tilt of the paper where it is sampled to that of the middle level at the edge."""
    inwards = fan.marker_radius / fan.paper_radius
    return np.asarray(inwards * 0.5 * (1.0 + ink / np.maximum(paper, 1.0)), dtype=np.float64)
