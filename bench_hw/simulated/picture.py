"""What the simulated webcam sees: dark round markers on a light sheet, through a lens with distortion.

Each pixel is carried back to the marker plane once (the distortion inverted), so a picture is
exact to the edge softness: a marker covers a pixel by its signed distance to the edge over the pixel's
size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench_hw.simulated.specimen import FloatArray

_INVERSE_STEPS = 30
_WIDEST = 10.0
"""Tangent of the widest half angle of view that is looked for."""


@dataclass(frozen=True, slots=True)
class CameraModel:
    """A camera that looks straight up at the lower face, its axis on the tool axis.

    Parameters
    ----------
    size : tuple of 2 ints
        Width and height, pixels.
    focal_length : float
        Pixels.
    distance : float
        Camera to the resting lower face, m.
    distortion : tuple of 5 floats
        k1, k2, p1, p2, k3 of OpenCV's model; it must not fold over inside the picture.
    marker_radius : float
        m.
    paper, ink : float
        Grey levels of sheet and markers, 0 to 255.
    lighting : float
        Relative change of brightness from left to right.
    blur : float
        Standard deviation of the blur, pixels.
    noise : float
        Standard deviation of a pixel's grey level.
    """

    size: tuple[int, int] = (640, 480)
    focal_length: float = 582.0
    distance: float = 0.070
    distortion: tuple[float, float, float, float, float] = (-0.08, 0.02, 0.0005, -0.0005, 0.0)
    marker_radius: float = 1.2e-3
    paper: float = 205.0
    ink: float = 35.0
    lighting: float = 0.15
    blur: float = 0.8
    noise: float = 3.0


def distort(points: FloatArray, coefficients: tuple[float, float, float, float, float]) -> FloatArray:
    """Apply OpenCV's distortion to normalised points (..., 2).

    The radial factor is 1 + k1 r^2 + k2 r^4 + k3 r^6, the tangential shift that of Brown and Conrady.
    """
    k1, k2, p1, p2, k3 = coefficients
    x, y = points[..., 0], points[..., 1]
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    dx = 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)
    dy = p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y
    return np.stack([x * radial + dx, y * radial + dy], axis=-1)


def undistort(points: FloatArray, coefficients: tuple[float, float, float, float, float]) -> FloatArray:
    """Invert `distort` by fixed-point steps on the residual; (..., 2) normalised.

    Raises
    ------
    ValueError
        The distortion cannot be inverted somewhere in the picture (it folds over).
    """
    guess = points.copy()
    for _ in range(_INVERSE_STEPS):
        residual = distort(guess, coefficients) - points
        guess = np.clip(guess - residual, -_WIDEST, _WIDEST)
    worst = float(np.abs(distort(guess, coefficients) - points).max())
    if not worst < 1e-9:
        raise ValueError(f"distortion {coefficients}: folds over inside the picture; allowed are milder values")
    return guess


class Painter:
    """Paints pictures of markers as one camera sees them.

    Parameters
    ----------
    model : CameraModel
        The camera.
    rng : numpy.random.Generator
        Source of the noise.
    """

    def __init__(self, model: CameraModel, rng: np.random.Generator) -> None:
        self._model, self._rng = model, rng
        width, height = model.size
        pixels = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1).astype(float)
        self._centre = np.array([(width - 1) / 2.0, (height - 1) / 2.0])
        self._plane = undistort((pixels - self._centre) / model.focal_length, model.distortion)
        ramp = 1.0 + model.lighting * ((pixels[..., 0] - self._centre[0]) / width)
        self._paper = (model.paper * ramp).astype(np.float32)
        self._ink = (model.ink * ramp).astype(np.float32)

    def paint(self, markers: FloatArray) -> NDArray[np.uint8]:
        """Paint markers (m, 3) (x, y, sunk; m) as a grey picture (height, width)."""
        picture = self._paper.copy()
        for x, y, sunk in markers:
            self._paint_one(picture, np.array([x, y]), self._model.distance - sunk)
        if self._model.noise > 0.0:
            picture += np.float32(self._model.noise) * self._rng.standard_normal(picture.shape, np.float32)
        painted: NDArray[np.uint8] = np.clip(np.rint(picture), 0.0, 255.0).astype(np.uint8)
        return painted

    def centres(self, markers: FloatArray) -> FloatArray:
        """Where the markers' centres fall in the picture, (m, 2) pixels (x right, y down)."""
        normalised = markers[:, :2] / (self._model.distance - markers[:, 2:])
        return np.asarray(distort(normalised, self._model.distortion) * self._model.focal_length + self._centre)

    def _paint_one(self, picture: NDArray[np.float32], position: FloatArray, distance: float) -> None:
        model = self._model
        centre = distort(position / distance, model.distortion) * model.focal_length + self._centre
        reach = 1.5 * model.marker_radius / distance * model.focal_length + 4.0 * (1.0 + model.blur)
        low = np.maximum(np.floor(centre - reach), 0).astype(int)
        high = np.minimum(np.ceil(centre + reach) + 1, model.size).astype(int)
        if np.any(high <= low):
            return
        window = (slice(low[1], high[1]), slice(low[0], high[0]))
        offset = self._plane[window] * distance - position
        outside = (np.hypot(offset[..., 0], offset[..., 1]) - model.marker_radius) * model.focal_length / distance
        share = _coverage(outside, model.blur).astype(np.float32)
        picture[window] += share * (self._ink[window] - picture[window])


def _coverage(outside: FloatArray, blur: float) -> FloatArray:
    """Share of a pixel that is inside an edge `outside` pixels away, blurred by a Gaussian of `blur` pixels."""
    from scipy.special import erf

    softness = np.hypot(blur, np.sqrt(1.0 / 12.0))
    result: FloatArray = 0.5 * (1.0 - erf(outside / (softness * np.sqrt(2.0))))
    return result
