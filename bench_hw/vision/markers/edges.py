"""The edge on each ray: where the smoothed grey level passes half way from ink to paper."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.markers.model import FloatArray, IntArray
from bench_hw.vision.markers.rays import Float32Array, RayFan

Level = TypeVar("Level", np.float32, np.float64)

RAY_CONTRAST = 0.5
"""A ray counts where ink and paper differ by this share of what is usual for its marker..."""
STRANGE_PAPER = 0.2
"""... and its paper is as bright as elsewhere around the marker, within this share of the contrast..."""
_SPREADS = 4.0
"""... or within so many usual deviations, if those are more."""
_EDGE_WIDTH = 3.0
"""Contrast over the slope of a smoothed edge, pixels: of a webcam's sharpness."""


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
    """

    radius: FloatArray
    there: NDArray[np.bool_]
    contrast: FloatArray
    tilt: FloatArray
    tilt_std: FloatArray
    noise: FloatArray


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
    noise = _EDGE_WIDTH * spread / np.maximum(contrast, 1.0)
    return Edges(np.where(there, radius, 0.0), there, contrast, seen_tilt, tilt_std, noise)


def _crossing(filtered: Float32Array, middle: Float32Array) -> tuple[IntArray, FloatArray, FloatArray]:
    """Where smoothed profiles (m, rays, smooth + 2) first pass the middle level (m, rays), and by how much.

    The sample before, and how far it and the next one are above the level; (m, rays) each.
    """
    below = filtered[:, :, :-2] < middle[:, :, None]
    at = (below[:, :, :-1] > below[:, :, 1:]).argmax(axis=2)
    place = at + np.arange(0, filtered.size, filtered.shape[2]).reshape(at.shape)
    before, after = (filtered.take(place + ahead).astype(np.float64) - middle for ahead in (0, 1))
    return at, before, after


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
