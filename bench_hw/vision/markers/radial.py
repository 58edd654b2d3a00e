"""Markers to a hundredth of a pixel: edges on rays, undistorted, and the area centroid of what they enclose.

Not the picture is undistorted but the edges: resampling a picture costs more accuracy than its noise does. The
centroid of the area is the centre of any marker shape, where an ellipse or circle would have to fit first.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.camera.distortion import jacobian, undistort, undistort_near
from bench_hw.vision.camera.pinhole import Camera
from bench_hw.vision.markers.edges import Edges, find_edges, ray_fan, sample
from bench_hw.vision.markers.grid import DetectedGrid, FloatArray, IntArray, Picture, Sighting
from bench_hw.vision.markers.outline import (
    Outlines,
    accept_found,
    accept_new_outlines,
    area_centroids,
    compare,
    fan_centroids,
    light_shift,
    outline_basis,
    shape_waves,
    shapes,
)

Scalar = TypeVar("Scalar", np.float64, np.bool_)
LEAST_SHARE = 0.85
"""A marker counts as seen where at least this share of its rays has a sound edge."""
LEAST_CONTRAST = 0.4
"""... and where its contrast is at least this share of what it was at first."""
RADIUS_RANGE = (0.6, 1.6)
"""... and its radius within this range of its first one."""
_RECENTRE = 0.1
_PASSES = 3
_HALF_SHARE = 0.375
_WHOLE_SHARE = 0.98
_LEARNING = 0.05
_LAST_STEP = 3e-4
"""Where a Newton step from the linear guess stops: less than 1e-4 pixel is left of it."""
_OTHER_LIGHT, _SURE = 0.02, 2.5
"""A change of the tilt of light beyond this share of the contrast, and so many standard deviations, is real."""
_NEWS = 6.0
"""A tilt of light so many standard deviations from the learned one is not of the same light: what was learned before
counts no more. Set on rendered films of seeds 101 and 102, judged on others."""
_SLACK, _MORE_SLACK, _MOST_SLACK = 0.06, 0.02, 0.3
"""How much an outline may change from one picture to the next, for each picture it is not seen, and at most: a sheet
stretches by 5 % between two pictures of a webcam in a press of a third of a second."""
_FIRST_SLACK = 0.3
_UNEVEN = 1.5
"""A lost marker round which the paper is less even than it was, by more than this factor, is still half under whatever
covered it: its outline is bent there. Set on rendered films of seeds 101 and 102, judged on others."""
_HIDDEN = 0.03
"""How far off the outline is where it is covered, as a share of the radius: half of what may change unseen."""
_FARTHEST = 2.4
"""Radii of the grid's markers, beyond which no edge is looked for: an ellipse of 1.6 that has grown by 1.5."""
_FAN_MARGIN, _FAN_SHARE, _NEW_FAN = 5.0, 1.5, 0.06
"""The rays reach so many pixels beyond the farthest edge, which lies at that share of the fan's radius at most; they
are laid out anew where that radius is off by more than the last."""


_DOUBTED_LIGHT, _SURE_LIGHT, _LEAST_LIGHT = 4.0, 5.5, 0.1
"""So many standard deviations must the steepest places of the edges be beside the centroid for it to be doubted, and to
be taken in its stead, and so many pixels: what a camera's JPEG moves them."""
_LEFT = 0.5
"""Share of that correction that may be wrong."""
_UNLIKE_NOISE, _UNLIKE_GROWTH, _UNLIKE_STRETCH, _UNLIKE_ASIDE = 6.0, 0.01, 0.08, 4.0
"""How far the third harmonic of an outline may change: standard deviations of it; shares of the radius for each part of
growth and of drawing out, which go along with odd shapes; shares of how far the outline is from a circle, for each
radius by which the rays begin off its middle."""
_DENT = 2.0
"""Way of the centroid for a third harmonic that is beyond that: a dent shows in every harmonic alike."""
_LEAST = 1e-4
"""Confidence of what is seen, at least: 0 is unseen."""
DOUBTFUL = 0.05
"""A marker whose centroid may be off by more than this share of its radius is not seen..."""
_DOUBT = 0.03
"""... and its confidence falls by e for each such share."""


@dataclass(frozen=True, eq=False, slots=True)
class Look:
    """Edges and outlines of some markers.

    Parameters
    ----------
    middles : ndarray, shape (k, 2)
        Where the rays began, pixels.
    edges : Edges
        As found.
    outlines : Outlines
        As judged and filled.
    pixels : ndarray, shape (k, 2)
        Area centroids of the outlines.
    """

    middles: FloatArray
    edges: Edges
    outlines: Outlines
    pixels: FloatArray

    def with_part(self, part: Look, where: IntArray) -> Look:
        """Give it with the markers `where` as in another look, of just those."""
        edges, new = self.edges, part.edges
        return Look(
            _joined(self.middles, part.middles, where),
            Edges(
                _joined(edges.radius, new.radius, where),
                _joined(edges.there, new.there, where),
                _joined(edges.contrast, new.contrast, where),
                _joined(edges.tilt, new.tilt, where),
                _joined(edges.tilt_std, new.tilt_std, where),
                _joined(edges.noise, new.noise, where),
                _joined(edges.steepest, new.steepest, where),
            ),
            Outlines(
                _joined(self.outlines.radius, part.outlines.radius, where),
                _joined(self.outlines.sound, part.outlines.sound, where),
            ),
            _joined(self.pixels, part.pixels, where),
        )


def _joined(whole: NDArray[Scalar], part: NDArray[Scalar], where: IntArray) -> NDArray[Scalar]:
    result = whole.copy()
    result[where] = part
    return result


class MarkerEdges:
    """Measures markers it knows; what it knows of them follows their slow change.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture the grid was found in.
    grid : DetectedGrid
        The markers.
    camera : Camera
        Whose distortion is taken off the edges.
    """

    def __init__(self, grey: Picture, grid: DetectedGrid, camera: Camera) -> None:
        count = len(grid.centres)
        self._camera = camera
        self._fan = ray_fan(grid.radius, grid.spacing)
        self._grid_radius, self._spacing = grid.radius, grid.spacing
        self._basis = outline_basis(self._fan)
        self._waves = shape_waves(self._basis)
        self._outline = np.full((count, len(self._basis)), grid.radius)
        self._tilt, self._lit = np.zeros((count, 2)), np.zeros(count)
        self._inverse = camera.undistorted(grid.centres)
        self._looks = 0
        self.shape = np.zeros((count, 2), dtype=np.complex128)
        self._first_shape = np.full((count, 2), complex(np.nan))
        self._slack, self._noise = np.full(count, _FIRST_SLACK), np.full(count, np.inf)
        self._contrast, self._radius = np.ones(count), np.full(count, grid.radius)
        everyone = np.arange(count)
        first = self._look(grey, grid.centres, everyone, self._tilt)
        self._contrast, self._radius = first.edges.contrast, first.outlines.radius.mean(axis=1)
        first, _ = self._checked(first, everyone)
        self._learn(first, everyone, first.outlines.share > LEAST_SHARE)

    @property
    def radius(self) -> FloatArray:
        """First radius of each marker, pixels, shape (m,)."""
        return self._radius

    def look(self, grey: Picture, starts: FloatArray, which: IntArray, *, searched: bool = False) -> Sighting:
        """Measure some markers in a picture.

        Parameters
        ----------
        grey : ndarray of uint8, shape (height, width)
            The picture.
        starts : ndarray, shape (k, 2)
            Where to look, pixels; right to about half a marker radius.
        which : ndarray of int, shape (k,)
            The numbers of the markers.
        searched : bool
            Whether they were lost and looked for: then their outlines may have changed more.

        Returns
        -------
        Sighting
            Of the k markers.
        """
        if searched:
            self._slack[which] = np.maximum(self._slack[which], _FIRST_SLACK)
        self._fit_the_fan()
        look = self._look(grey, starts, which, self._tilt[which])
        if searched:
            found = accept_found(look.edges, look.outlines, self._basis)
            pixels = look.middles + np.nan_to_num(fan_centroids(found.radius, self._fan.directions))
            look = replace(look, outlines=found, pixels=pixels)
        look, doubt = self._checked(look, which)
        points, radius = self._undistorted(look, which)
        confidence, error = self._confidence(look, which), _stated_error(look)
        if doubt.any():
            confidence, error = confidence * confidence_left(doubt, radius), np.hypot(error, np.sqrt(0.5) * doubt)
        confidence[~np.isfinite(points).all(axis=1)] = 0.0
        if searched:
            confidence[look.edges.noise > _UNEVEN * self._noise[which]] = 0.0
        seen = confidence > 0.0
        whole = seen & (look.outlines.share > _WHOLE_SHARE)
        self._follow(look, which, seen & ~whole)
        self._learn(look, which, whole)
        sighting = Sighting(points, look.pixels, radius, confidence, error)
        return sighting if seen.all() else sighting.kept(seen)

    def _checked(self, look: Look, which: IntArray) -> tuple[Look, FloatArray]:
        """Correct for uneven light on the ink, and say how far each centroid may be off beside noise, pixels."""
        shift, deviation = light_shift(look.edges, look.outlines.sound, self._basis)
        lit = np.sqrt((shift * shift).sum(axis=1))
        lit[lit < _DOUBTED_LIGHT * deviation] = 0.0
        sure = lit > np.maximum(_SURE_LIGHT * deviation, _LEAST_LIGHT)
        if sure.any():
            lit[sure] *= _LEFT
            shift[~sure] = 0.0
            radius = look.outlines.radius + shift @ self._fan.directions
            look = replace(look, outlines=replace(look.outlines, radius=radius), pixels=look.pixels + shift)
        return look, np.hypot(lit, self._dents(look, which))

    def _dents(self, look: Look, which: IntArray) -> FloatArray:
        """How far centroids may be off as outlines are other than at first on opposite sides, pixels, (k,)."""
        aside = look.pixels - look.middles
        about = look.outlines.radius - aside @ self._fan.directions
        shape, size, first = shapes(about, self._waves), about.mean(axis=1), self._first_shape[which]
        self.shape[which] = shape
        change = np.abs(shape - first) * size[:, None]
        least = _UNLIKE_NOISE * np.sqrt(2.0 / len(self._basis)) * look.edges.noise
        if not (change[:, 1] > least).any():
            return np.zeros(len(which))
        uneven = np.sqrt(np.maximum(np.einsum("ij,ij->i", about, about) / len(self._basis) - size**2, 0.0))
        allowed = least + _UNLIKE_GROWTH * np.abs(size - self._radius[which]) + _UNLIKE_STRETCH * change[:, 0]
        allowed += _UNLIKE_ASIDE * uneven * np.hypot(aside[:, 0], aside[:, 1]) / size
        return np.asarray(_DENT * np.fmax(change[:, 1] - allowed, 0.0))

    def _look(
        self, grey: Picture, starts: FloatArray, which: IntArray, tilt: FloatArray, passes: int = _PASSES
    ) -> Look:
        """Measure, and once more about the centroid where the rays began off the middle, or in another light."""
        look = self._pass(grey, starts, which, tilt)
        off = np.abs(look.pixels - starts).max(axis=1) > _RECENTRE * self._radius[which]
        other = _in_other_light(look.edges, tilt)
        if passes == 1 or not (off | other).any():
            return look
        again = np.flatnonzero((off | other) & (look.edges.there.mean(axis=1) > _HALF_SHARE))
        if not len(again):
            return look
        light = np.where(other[:, None], look.edges.tilt, tilt)[again]
        return look.with_part(self._look(grey, look.pixels[again], which[again], light, passes - 1), again)

    def _pass(self, grey: Picture, middles: FloatArray, which: IntArray, tilt: FloatArray) -> Look:
        edges = find_edges(sample(grey, middles, self._fan), self._fan, tilt)
        outlines = compare(edges, self._outline[which], self._basis, self._slack[which], self._noise[which])
        if len(which) == len(self._outline):
            outlines = accept_new_outlines(edges, outlines, self._outline, self._basis)
        offsets = fan_centroids(outlines.radius, self._fan.directions)
        return Look(middles, edges, outlines, middles + np.nan_to_num(offsets))

    def _undistorted(self, look: Look, which: IntArray) -> tuple[FloatArray, FloatArray]:
        """The centroids of the undistorted outlines (k, 2), normalised, and radii of equal area, pixels."""
        camera = self._camera
        offsets = look.outlines.radius[:, None, :] * self._fan.directions
        edges = camera.to_normalised(np.moveaxis(look.middles[:, :, None] + offsets, 1, 2))
        middles = camera.to_normalised(look.middles)
        if any(camera.distortion):
            inverse = self._inverse_of(middles, which)
            slope = jacobian(inverse, camera.distortion)
            left, up = edges[..., 0] - middles[:, None, 0], edges[..., 1] - middles[:, None, 1]
            scale = 1.0 / slope.determinant[:, None]
            guess = np.empty_like(edges)
            guess[..., 0] = inverse[:, None, 0] + scale * (slope.yy[:, None] * left - slope.xy[:, None] * up)
            guess[..., 1] = inverse[:, None, 1] + scale * (slope.xx[:, None] * up - slope.xy[:, None] * left)
            edges = undistort_near(edges, camera.distortion, guess, steps=1, small=_LAST_STEP)
        centroids, areas = area_centroids(edges[..., 0], edges[..., 1])
        return centroids, np.sqrt(areas * camera.focal[0] * camera.focal[1] / np.pi)

    def _inverse_of(self, middles: FloatArray, which: IntArray) -> FloatArray:
        """Invert the distortion near where each marker was before; with the full search where that fails."""
        coefficients = self._camera.distortion
        inverse = undistort_near(middles, coefficients, self._inverse[which], steps=2)
        lost = ~np.isfinite(inverse).all(axis=1)
        if lost.any():
            inverse[lost] = undistort(middles[lost], coefficients)
        self._inverse[which] = inverse
        return inverse

    def _confidence(self, look: Look, which: IntArray) -> FloatArray:
        """Share of sound rays times contrast as a share of the first one; 0 for what is no marker."""
        share = look.outlines.share
        contrast = look.edges.contrast / self._contrast[which]
        growth = look.outlines.radius.mean(axis=1) / self._radius[which]
        good = (share >= LEAST_SHARE) & (contrast >= LEAST_CONTRAST)
        good &= (growth > RADIUS_RANGE[0]) & (growth < RADIUS_RANGE[1])
        return np.where(good, share * np.minimum(contrast, 1.0), 0.0)

    def _fit_the_fan(self) -> None:
        """Lay the rays out anew where markers have grown out of them, or shrunk."""
        reach = min(float(self._outline.max()), _FARTHEST * self._grid_radius)
        middle = self._outline.size // 2
        usual = float(np.partition(self._outline, middle, axis=None)[middle])
        wanted = max(usual, (reach + _FAN_MARGIN) / _FAN_SHARE)
        if abs(wanted / self._fan.marker_radius - 1.0) <= _NEW_FAN:
            return
        old = self._fan
        self._fan = ray_fan(wanted, self._spacing * usual / self._grid_radius)
        self._basis = outline_basis(self._fan)
        self._waves = shape_waves(self._basis)
        if self._fan.directions.shape != old.directions.shape:
            angles = [np.arange(fan.directions.shape[1]) / fan.directions.shape[1] for fan in (self._fan, old)]
            rows = [np.interp(angles[0], angles[1], row, period=1.0) for row in self._outline]
            self._outline = np.array(rows)

    def _follow(self, look: Look, which: IntArray, part: NDArray[np.bool_]) -> None:
        """Take the growth and stretch of markers that are seen in part; their covered edges teach nothing."""
        chosen = which[part]
        if not len(chosen):
            return
        shift = (look.pixels - look.middles)[part]
        change = look.outlines.radius[part] - shift @ self._fan.directions - self._outline[chosen]
        numbers = np.linalg.lstsq(self._basis, change.T, rcond=None)[0]
        self._outline[chosen] += (self._basis @ numbers).T
        self._slack[chosen] = _SLACK

    def _learn(self, look: Look, which: IntArray, whole: NDArray[np.bool_]) -> None:
        """Take the outlines and the light of markers that are seen wholly as what is usual from now on."""
        self._looks += 1
        self._slack[which] = np.minimum(self._slack[which] + _MORE_SLACK, _MOST_SLACK)
        chosen, weight = which[whole], max(_LEARNING, 1.0 / self._looks)
        shift = (look.pixels - look.middles)[whole]
        self._outline[chosen] = look.outlines.radius[whole] - shift @ self._fan.directions
        self._slack[chosen] = _SLACK
        first = chosen[np.isnan(self._first_shape[chosen, 0])]
        self._first_shape[first] = self.shape[first]
        noise = look.edges.noise[whole]
        new = ~np.isfinite(self._noise[chosen])
        self._noise[chosen[new]] = noise[new]
        self._noise[chosen] += weight * (noise - self._noise[chosen])
        self._learn_light(look.edges.tilt[whole], look.edges.tilt_std[whole], chosen)

    def _learn_light(self, tilt: FloatArray, std: FloatArray, chosen: IntArray) -> None:
        """Take the mean tilt of light since the light last changed, of some twenty pictures at most."""
        change = tilt - self._tilt[chosen]
        pictures = np.where((np.abs(change) > _NEWS * std[:, None]).any(axis=1), 1.0, self._lit[chosen] + 1.0)
        self._lit[chosen] = pictures
        self._tilt[chosen] += np.maximum(_LEARNING, 1.0 / pictures)[:, None] * change


def doubted(sighting: Sighting, doubt: FloatArray, kept: NDArray[np.bool_]) -> Sighting:
    """Give a sighting whose centroids may be off by `doubt` (m,) more, pixels, with those not `kept` unseen."""
    confidence = sighting.confidence * np.exp(-doubt / (_DOUBT * np.nan_to_num(sighting.radius, nan=1.0)))
    error = np.hypot(sighting.error, np.sqrt(0.5) * doubt)
    return replace(sighting, confidence=np.maximum(confidence, _LEAST) * sighting.seen, error=error).kept(
        sighting.seen & kept
    )


def confidence_left(doubt: FloatArray, radius: FloatArray) -> FloatArray:
    """Give the factor of the confidence of centroids that may be off by `doubt`, pixels like `radius`; 0 for unseen."""
    share = doubt / radius
    return np.where(share > DOUBTFUL, 0.0, np.exp(-share / _DOUBT))


def _stated_error(look: Look) -> FloatArray:
    """Standard deviation of each centroid along an axis, pixels, shape (k,).

    A centroid is 2/n sum r_i (cos, sin): radii of independent noise s move it by s sqrt(2/n). A covered arc, the share
    h of the outline, moves it by 2 h times what the outline is off there.
    """
    share = look.outlines.share
    rays = look.outlines.radius.shape[1]
    of_noise = look.edges.noise * np.sqrt(2.0 / (rays * np.maximum(share, 0.1)))
    of_hidden = 2.0 * (1.0 - share) * _HIDDEN * look.outlines.radius.mean(axis=1)
    return np.asarray(np.hypot(of_noise, of_hidden))


def _in_other_light(edges: Edges, tilt: FloatArray) -> NDArray[np.bool_]:
    """Which wholly visible markers lie in other light than was learned, as near a shadow."""
    change = np.abs(edges.tilt - tilt).max(axis=1)
    real = change > np.maximum(_OTHER_LIGHT * edges.contrast, _SURE * edges.tilt_std)
    return np.asarray(real & edges.there.all(axis=1))
