"""The edge on each ray: where the smoothed grey level passes half way from ink to paper."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.markers.model import FloatArray
from bench_hw.vision.markers.rays import Float32Array, RayFan

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
    ink = profiles[:, :, : fan.ink].mean(axis=2)
    paper = profiles[:, :, -fan.paper :].mean(axis=2)
    usual_ink, usual_paper = np.median(ink, axis=1), np.median(paper, axis=1)
    contrast = (usual_paper - usual_ink).astype(np.float64)
    middle = 0.5 * (usual_paper + usual_ink)[:, None] + (tilt @ fan.directions).astype(np.float32)
    above = profiles @ fan.smoothing - middle[:, :, None]
    crossing = (above[:, :, :-1] < 0.0) & (above[:, :, 1:] >= 0.0)
    at = crossing.argmax(axis=2)
    before = np.take_along_axis(above, at[:, :, None], axis=2)[:, :, 0].astype(np.float64)
    after = np.take_along_axis(above, at[:, :, None] + 1, axis=2)[:, :, 0].astype(np.float64)
    there = (before < 0.0) & (after >= 0.0) & (contrast > 0.0)[:, None]
    strange = _strangeness(paper, tilt, fan)
    spread = 1.4826 * np.median(strange, axis=1)
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


def _strangeness(paper: Float32Array, tilt: FloatArray, fan: RayFan) -> FloatArray:
    """How far paper (m, rays) is from what it is around the marker, apart from uneven light, grey levels."""
    left = paper - tilt @ fan.directions
    return np.asarray(np.abs(left - np.median(left, axis=1, keepdims=True)))


def _dimming(ink: Float32Array, paper: Float32Array, fan: RayFan) -> FloatArray:
    """From a tilt of the paper where it is sampled to that of the middle level at the edge."""
    inwards = fan.marker_radius / float(fan.radii[-fan.paper :].mean())
    return np.asarray(inwards * 0.5 * (1.0 + ink / np.maximum(paper, 1.0)), dtype=np.float64)
