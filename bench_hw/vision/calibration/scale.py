"""The scale of the marker plane, from a picture of a board or of a ruler that lies in it.

A ruler's marks repeat: how often in a pixel is the strongest wave of the undistorted picture. The wave is found in the
spectrum; its phase along the ruler then gives its frequency to a small part of a step of the spectrum.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import InputError
from bench_hw.vision.calibration.board import Board, look_for_board, read_picture
from bench_hw.vision.calibration.fit import fit_similarity
from bench_hw.vision.camera.pinhole import Camera, FloatArray

_PERIODS = (3.5, 40.0)
_BACKGROUND = 20.0
_LEAST_PEAK, _BANDS = 15.0, 25
"""A wave stands out if it is so many times as strong as waves of about its length in other directions usually are."""
_LARGEST_STD, _SYSTEMATIC = 3e-3, 2e-4
"""Of the scale: a less certain one is refused, and a more certain one than the second is not believed."""
_ROUNDS, _WEAKEST, _CROSSED = 3, 0.05, 0.4
_LEAST_CONTRAST = 25.0
LARGEST_TILT = np.radians(2.0)
"""A plane tilted by more than this against the picture is warned of."""


@dataclass(frozen=True, slots=True)
class PlaneScale:
    """The scale of the marker plane, from one picture.

    Parameters
    ----------
    scale, scale_std : float
        m per undistorted pixel and its standard deviation.
    middle : tuple of 2 floats
        Where the middle of the board or ruler is seen, undistorted pixels.
    kind : str
        `board` or `ruler`.
    warnings : tuple of str
        A sentence each.
    """

    scale: float
    scale_std: float
    middle: tuple[float, float]
    kind: str
    warnings: tuple[str, ...] = ()


def measure_ruler(grey: NDArray[np.uint8], camera: Camera, mark: float) -> PlaneScale | None:
    """Measure the scale from the marks of a ruler.

    Parameters
    ----------
    grey : ndarray of uint8, shape (height, width)
        The picture.
    camera : Camera
        Takes the distortion off.
    mark : float
        Distance of the finest marks, m.

    Returns
    -------
    PlaneScale or None
        None where nothing repeats clearly enough to be a ruler.
    """
    marks = _marks(grey, camera)
    wave = _strongest_wave(marks)
    if wave is None or np.ptp(marks) < _LEAST_CONTRAST:
        return None
    for _ in range(_ROUNDS):
        change, std, middle = _phase_slope(marks, wave)
        wave = wave + change
    scale = mark * float(np.hypot(*wave))
    scale_std = float(np.hypot(mark * std, _SYSTEMATIC * scale))
    x, y = camera.to_pixels((np.array(middle) - camera.centre) / camera.focal[0])  # the marks' pixels are square
    return PlaneScale(scale, scale_std, (float(x), float(y)), "ruler") if scale_std < _LARGEST_STD * scale else None


def _marks(grey: NDArray[np.uint8], camera: Camera) -> FloatArray:
    """The undistorted picture less its background, fading out to the border."""
    matrix = np.array([[camera.focal[0], 0, camera.centre[0]], [0, camera.focal[0], camera.centre[1]], [0, 0, 1.0]])
    lens = np.array(camera.distortion)
    maps = cv2.initUndistortRectifyMap(camera.matrix, lens, np.eye(3), matrix, camera.size, cv2.CV_32FC1)
    straight = cv2.remap(grey.astype(np.float32), *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    local = straight - cv2.GaussianBlur(straight, (0, 0), _BACKGROUND)
    height, width = grey.shape
    return np.asarray(local * np.hanning(height)[:, None] * np.hanning(width), dtype=np.float64)


def _strongest_wave(marks: FloatArray) -> FloatArray | None:
    """The frequency (x, y; per pixel) of the strongest wave, if it stands out."""
    power = np.abs(np.fft.rfft2(marks))
    y, x = np.meshgrid(np.fft.fftfreq(marks.shape[0]), np.fft.rfftfreq(marks.shape[1]), indexing="ij")
    frequency = np.hypot(x, y)
    ring = (frequency > 1.0 / _PERIODS[1]) & (frequency < 1.0 / _PERIODS[0])
    share = np.zeros_like(power)
    bands = np.digitize(frequency, np.geomspace(1.0 / _PERIODS[1], 1.0 / _PERIODS[0], _BANDS))
    for band in np.unique(bands[ring]):
        members = ring & (bands == band)
        share[members] = power[members] / np.median(power[members])
    at = np.unravel_index(int(np.argmax(share)), power.shape)
    if not share[at] > _LEAST_PEAK or _crossed(power, int(at[0]), int(at[1])):
        return None
    return np.array([x[at], y[at]]) / _overtone(power, int(at[0]), int(at[1]))


def _crossed(power: FloatArray, row: int, column: int) -> bool:
    """Whether a wave at right angles is as strong: then it is no ruler but a board or a grid of spots."""
    height, width = len(power), 2 * (power.shape[1] - 1)
    row = row if row < height / 2 else row - height
    across, down = -row / height * width, column / width * height
    sign = 1.0 if across >= 0.0 else -1.0
    return bool(_near(power, sign * down, sign * across) > _CROSSED * power[row, column])


def _near(power: FloatArray, row: float, column: float) -> float:
    """The strongest of the waves around a place in the spectrum."""
    rows = np.arange(round(row) - 2, round(row) + 3) % len(power)
    first = max(round(column) - 2, 0)
    return float(power[rows, first : first + 5].max())


def _overtone(power: FloatArray, row: int, column: int) -> int:
    """Which multiple of the marks' own wave a wave is: of a half or a third of it there is as much then."""
    row = row if row < len(power) / 2 else row - len(power)
    for multiple in (3, 2):
        if _near(power, row / multiple, column / multiple) > 0.5 * power[row, column]:
            return multiple
    return 1


def _phase_slope(marks: FloatArray, wave: FloatArray) -> tuple[FloatArray, float, tuple[float, float]]:
    """How much a wave's frequency is off (x, y; per pixel), how sure that is, and where the marks are.

    The marks, turned back by the wave, have a phase that grows evenly along the ruler by what the wave is off.
    """
    y, x = np.mgrid[: marks.shape[0], : marks.shape[1]].astype(np.float64)
    turned = marks * np.exp(-2j * np.pi * (wave[0] * x + wave[1] * y))
    period = 1.0 / float(np.hypot(*wave))
    turned = cv2.GaussianBlur(turned.real, (0, 0), period) + 1j * cv2.GaussianBlur(turned.imag, (0, 0), period)
    weight = np.abs(turned) ** 2
    chosen = weight > _WEAKEST * weight.max()
    weight, x, y = weight[chosen], x[chosen], y[chosen]
    middle = (float(np.average(x, weights=weight)), float(np.average(y, weights=weight)))
    phase = np.angle(turned[chosen] * np.conj(np.sum(turned[chosen] * weight)))
    along = ((x - middle[0]) * wave[0] + (y - middle[1]) * wave[1]) * period
    slope = np.average(phase * along, weights=weight) / np.average(along**2, weights=weight)
    left = phase - slope * along
    spread = float(np.sqrt(np.average(along**2, weights=weight)))
    count = max(2.0, np.sqrt(12.0) * spread / period)
    std = float(np.sqrt(np.average(left**2, weights=weight) / count)) / (2.0 * np.pi * spread)
    return wave * period * slope / (2.0 * np.pi), std, middle


def measure_plane(path: Path, board: Board, camera: Camera, mark: float) -> PlaneScale:
    """Measure the scale in a picture of the marker plane.

    Parameters
    ----------
    path : pathlib.Path
        The picture.
    board : Board
        The board, if it shows one.
    camera : Camera
        Takes the distortion off.
    mark : float
        Distance of a ruler's finest marks, m, if it shows one.

    Raises
    ------
    InputError
        It shows neither, or is of another size than the camera's pictures.
    """
    grey = read_picture(path)
    if grey.shape != camera.size[::-1]:
        raise InputError(
            f"{path}: the picture is {grey.shape[1]} x {grey.shape[0]} pixels; "
            f"allowed: {camera.size[0]} x {camera.size[1]}, as the views"
        )
    view = look_for_board(grey, board, str(path))
    if view.corners is not None:
        return _of_board(camera.undistorted(view.corners) * camera.focal[0], board, camera)
    found = measure_ruler(grey, camera, mark)
    if found is None:
        raise InputError(
            f"{path}: neither a board with {board} inner corners ({view.reason}) nor a ruler; "
            "allowed: one of the two, sharp and lying in the marker plane"
        )
    return found


def _of_board(seen: FloatArray, board: Board, camera: Camera) -> PlaneScale:
    """Scale by the best similarity; its error is that of the fit and of a tilt, which foreshortens by its square."""
    if not np.isfinite(seen).all():
        raise InputError("the board of the plane lies where the camera's distortion has no inverse")
    fit = fit_similarity(board.points, seen)
    tilt = _tilt(seen, board, camera.focal[0])
    scale = 1.0 / fit.scale
    middle = seen.mean(axis=0) / camera.focal[0]
    x, y = camera.to_pixels(middle)
    warnings: tuple[str, ...] = ()
    if tilt > LARGEST_TILT:
        reach = 0.5 * float(np.hypot(*np.ptp(seen, axis=0)))
        spread = 100.0 * np.tan(tilt) * reach / camera.focal[0]
        warnings = (
            f"the plane is tilted by {np.degrees(tilt):.1f} degrees against the picture: the scale is right in the "
            f"middle of the board and changes by {spread:.1g} % to its border; put the camera straight",
        )
    std = float(np.hypot(scale * fit.scale_std / fit.scale, scale * tilt**2 / 4.0))
    return PlaneScale(scale, std, (float(x), float(y)), "board", warnings)


def _tilt(seen: FloatArray, board: Board, focal: float) -> float:
    """Angle (rad) between the board's plane and the picture's, from the homography of its corners."""
    import cv2

    homography = np.asarray(cv2.findHomography(board.points, seen / focal)[0], dtype=np.float64)
    columns = homography / np.linalg.norm(homography[:, 0])
    normal = np.cross(columns[:, 0], columns[:, 1])
    return float(np.arccos(min(1.0, abs(normal[2]) / float(np.linalg.norm(normal)))))
