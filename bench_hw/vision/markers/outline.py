"""A marker's outline against the one it had, and its centroid.

From picture to picture an outline shifts, grows and stretches a little: five numbers (constant, cosine, sine
and their second harmonics of the ray's angle). What strays from that is something else in front of the marker; the
covered edges are filled in. Areas and centroids are by Green's theorem.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench_hw.vision.markers.edges import Edges, RayFan
from bench_hw.vision.markers.grid import FloatArray

_STRAY, _LEAST_STRAY = (0.03, 0.06), (0.25, 0.5)
"""How far an edge may at least and at most be from where it should be: share of the radius, pixels; the larger."""
_DEVIATIONS = 4.5
_UNKNOWN = 8.0
"""Between the two, so many standard deviations of an edge."""
_WIDER = 3
"""So many rays beside a covered stretch are not trusted either."""
_FEWEST_RAYS = 10
_ROUNDS = 8
_NEW_GROWTH, _NEW_ROUNDNESS = 0.15, 0.2
_ALIKE = 1.25
"""How much more a mean over every second ray strays than if they were independent: neighbours see the same pixels."""
_FOUND_ROUNDNESS = 0.12
"""Of the mean radius: how far the outline of a marker that is found again may be from an ellipse."""


def area_centroids(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Give the centroids and areas of polygons.

    Parameters
    ----------
    x, y : ndarray, shape (m, n)
        Corners of m polygons in their order round.

    Returns
    -------
    centroids : ndarray, shape (m, 2)
        NaN for a polygon without area.
    areas : ndarray, shape (m,)
        Not negative.
    """
    x0, y0 = x.mean(axis=1, keepdims=True), y.mean(axis=1, keepdims=True)
    left, up = x - x0, y - y0
    left_next, up_next = _next(left), _next(up)
    cross = left * up_next - left_next * up
    twice = cross.sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = 1.0 / (3.0 * twice)
        centroids = np.stack(
            [
                x0[:, 0] + ((left + left_next) * cross).sum(axis=1) * share,
                y0[:, 0] + ((up + up_next) * cross).sum(axis=1) * share,
            ],
            axis=1,
        )
    return centroids, 0.5 * np.abs(twice)


def fan_centroids(radius: FloatArray, directions: FloatArray) -> FloatArray:
    """Give the centroids of polygons whose corners lie on rays at even angles, from where the rays begin.

    Parameters
    ----------
    radius : ndarray, shape (m, n)
        Distances of the corners.
    directions : ndarray, shape (2, n)
        Cosine and sine of the rays' angles.

    Returns
    -------
    ndarray, shape (m, 2)
        NaN for a polygon without area.
    """
    product = radius * _next(radius)
    before = np.concatenate([product[:, -1:], product[:, :-1]], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((product + before) * radius @ directions.T / (3.0 * product.sum(axis=1))[:, None])


def _next(values: FloatArray) -> FloatArray:
    return np.concatenate([values[:, 1:], values[:, :1]], axis=1)


@dataclass(frozen=True, eq=False, slots=True)
class Outlines:
    """Whole outlines of some markers.

    Parameters
    ----------
    radius : ndarray, shape (m, rays)
        From the fan's middle, pixels; rays without a sound edge are filled from the outline before.
    sound : ndarray of bool, shape (m, rays)
        Rays with an edge of the marker's own.
    """

    radius: FloatArray
    sound: NDArray[np.bool_]

    @property
    def share(self) -> FloatArray:
        """Share of sound rays, shape (m,)."""
        return np.asarray(np.count_nonzero(self.sound, axis=1) / self.sound.shape[1])


def outline_basis(fan: RayFan) -> FloatArray:
    """Give the five shapes of change at each ray, shape (rays, 5)."""
    cosine, sine = fan.directions
    return np.stack([np.ones_like(cosine), cosine, sine, cosine**2 - sine**2, 2.0 * cosine * sine], axis=1)


def compare(edges: Edges, before: FloatArray, basis: FloatArray, slack: FloatArray, noise: FloatArray) -> Outlines:
    """Judge edges by the outlines the markers had before.

    Parameters
    ----------
    edges : Edges
        Of m markers.
    before : ndarray, shape (m, rays)
        Outlines before, about their centroids, pixels.
    basis : ndarray, shape (rays, 5)
        From `outline_basis`.
    slack : ndarray, shape (m,)
        How much each may have grown or stretched since, as a share of its radius.
    noise : ndarray, shape (m,)
        Standard deviation of an edge, pixels; infinite where the outline before is a mere circle.
    """
    change, size = edges.radius - before, before.mean(axis=1, keepdims=True)
    limit, bound = _limits(size, noise), slack[:, None] * size
    model = _bounded(_fit(change, edges.there.astype(np.float64), basis), bound) @ basis.T
    sound = edges.there & (np.abs(change - model) < limit)
    doubtful = np.flatnonzero((edges.there & ~sound).any(axis=1))
    if len(doubtful):
        part = _resistant(change[doubtful], edges.there[doubtful], basis, limit[doubtful], bound[doubtful])
        model[doubtful] = part
        sound[doubtful] = edges.there[doubtful] & (np.abs(change[doubtful] - part) < limit[doubtful])
    sound = sound & ~_beside_gaps(sound)
    return Outlines(np.where(sound, edges.radius, before + model), sound)


def _limits(size: FloatArray, noise: FloatArray) -> FloatArray:
    """How far edges may be from where they should be, (m, 1), pixels."""
    least, most = (np.maximum(pixels, share * size) for pixels, share in zip(_LEAST_STRAY, _STRAY, strict=True))
    most = np.where(np.isfinite(noise)[:, None], most, _UNKNOWN * most)
    return np.asarray(np.clip(_DEVIATIONS * noise[:, None], least, most))


def _resistant(
    change: FloatArray, there: NDArray[np.bool_], basis: FloatArray, limit: FloatArray, bound: FloatArray
) -> FloatArray:
    """The change (m, rays) that most rays agree on: least absolute deviations, then least squares over those rays."""
    weight = there.astype(np.float64)
    for _ in range(_ROUNDS):
        stray = np.abs(change - _bounded(_fit(change, weight, basis), bound) @ basis.T)
        weight = there / np.maximum(stray, 0.2 * limit)
    for _ in range(2):
        weight = (there & (stray < limit)).astype(np.float64)
        model = np.asarray(_bounded(_fit(change, weight, basis), bound) @ basis.T)
        stray = np.abs(change - model)
    return model


def _beside_gaps(sound: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Rays (m, rays) in or beside a stretch of three or more rays that are not sound."""
    if sound.all():
        return np.zeros_like(sound)
    gap = ~(sound | np.roll(sound, 1, axis=1) | np.roll(sound, -1, axis=1))
    return np.asarray(np.any([np.roll(gap, k, axis=1) for k in range(-_WIDER - 1, _WIDER + 2)], axis=0))


def _bounded(numbers: FloatArray, bound: FloatArray) -> FloatArray:
    """The five numbers (m, 5) with growth and drawing-out within a bound (m, 1)."""
    numbers[:, :1] = np.clip(numbers[:, :1], -bound, bound)
    drawn = np.hypot(numbers[:, 3], numbers[:, 4])[:, None]
    numbers[:, 3:] *= np.minimum(1.0, bound / np.maximum(drawn, 1e-12))
    return numbers


def _fit(change: FloatArray, weight: FloatArray, basis: FloatArray) -> FloatArray:
    """Weighted least squares, (m, 5); zero for a marker with too few rays."""
    if weight.all() and weight.max(initial=1.0) == 1.0 and len(basis) >= _FEWEST_RAYS:  # shapes at even angles part
        return np.asarray(change @ basis * (np.array([1.0, 2.0, 2.0, 2.0, 2.0]) / len(basis)))
    products = (basis[:, :, None] * basis[:, None, :]).reshape(len(basis), -1)
    normal = (weight @ products).reshape(-1, basis.shape[1], basis.shape[1])
    right = (weight * change) @ basis
    few = np.count_nonzero(weight, axis=1) < _FEWEST_RAYS
    normal[few], right[few] = np.eye(basis.shape[1]), 0.0
    normal += 1e-6 * np.eye(basis.shape[1])
    return np.asarray(np.linalg.solve(normal, right[:, :, None])[:, :, 0])


def light_shift(edges: Edges, sound: NDArray[np.bool_], basis: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Give how far centroids are from those of where the grey level rises most steeply, and the standard deviation.

    Light that is uneven across a marker, as beside a reflection, moves the middle level between ink and paper; it does
    not move the steepest place of an edge.

    Parameters
    ----------
    edges : Edges
        Of k markers.
    sound : ndarray of bool, shape (k, rays)
        The rays that count.
    basis : ndarray, shape (rays, 5)
        From `outline_basis`.

    Returns
    -------
    shift : ndarray, shape (k, 2)
        To be added to the centroids, pixels.
    deviation : ndarray, shape (k,)
        Of either number, by what the rays differ by among themselves.
    """
    sound, basis = sound[:, ::2], basis[::2]
    numbers = _fit(edges.steepest, sound.astype(np.float64), basis)
    left = sound * (edges.steepest - numbers @ basis.T)
    free = np.maximum(sound.sum(axis=1) - len(basis.T), 1)
    return numbers[:, 1:3], _ALIKE * np.sqrt(2.0 / len(basis) * np.einsum("ij,ij->i", left, left) / free)


def shape_waves(basis: FloatArray) -> FloatArray:
    """Give the second and third harmonics (rays, 4) of which `shapes` are made, from an `outline_basis`."""
    (c, s), (c2, s2) = basis[:, 1:3].T, basis[:, 3:].T
    return np.asarray(2.0 / len(basis) * np.stack([c2, s2, c * c2 - s * s2, s * c2 + c * s2], axis=1))


def shapes(radius: FloatArray, waves: FloatArray) -> NDArray[np.complex128]:
    """Give the second and the third harmonic of outlines (k, rays) about their centroids, shares of the mean radius.

    Returns
    -------
    ndarray of complex, shape (k, 2)
        Of an ellipse with the half axes a and b the second has the size (a - b) / (a + b); the third is 0 for every
        outline that is alike on opposite sides, however it is stretched.
    """
    return np.asarray((radius @ waves / radius.mean(axis=1)[:, None]).view(np.complex128))


def accept_found(edges: Edges, outlines: Outlines, basis: FloatArray) -> Outlines:
    """Take the outlines of markers that were looked for as they are, where they are wholly visible and near an ellipse.

    While a marker was lost the sheet may have stretched it into another shape than five numbers tell.

    Parameters
    ----------
    edges, outlines : Edges, Outlines
        Of k markers, judged by `compare`.
    basis : ndarray, shape (rays, 5)
        From `outline_basis`.
    """
    numbers = np.linalg.lstsq(basis, edges.radius.T, rcond=None)[0]
    uneven = np.abs(edges.radius - (basis @ numbers).T).max(axis=1)
    whole = edges.there.all(axis=1) & (uneven < _FOUND_ROUNDNESS * edges.radius.mean(axis=1))
    sound = outlines.sound | whole[:, None]
    return Outlines(np.where(sound, edges.radius, outlines.radius), sound)


def accept_new_outlines(edges: Edges, outlines: Outlines, before: FloatArray, basis: FloatArray) -> Outlines:
    """Take outlines as they are in a picture in which most of them are other than before.

    Then it is not that something has come in front of a marker: the focus or the exposure has changed. Only markers
    that are wholly visible, round and about as large as before are accepted.

    Parameters
    ----------
    edges, outlines : Edges, Outlines
        Of all m markers, judged by `compare`.
    before : ndarray, shape (m, rays)
        Outlines before, pixels.
    basis : ndarray, shape (rays, 5)
        From `outline_basis`.
    """
    other = np.asarray(edges.there.all(axis=1) & ~outlines.sound.all(axis=1))
    if other.mean() <= 0.5:
        return outlines
    circle = basis[:, :3]
    mean = edges.radius.mean(axis=1)
    uneven = np.abs(edges.radius - edges.radius @ circle @ np.linalg.inv(circle.T @ circle) @ circle.T).max(axis=1)
    other &= (uneven < _NEW_ROUNDNESS * mean) & (np.abs(mean / before.mean(axis=1) - 1.0) < _NEW_GROWTH)
    sound = outlines.sound | other[:, None]
    return Outlines(np.where(sound, edges.radius, outlines.radius), sound)
