"""Pictures of chessboards and rulers through a camera that is known exactly. Synthetic, for tests.

Each pixel is carried back to the board: the distortion is inverted once for the whole picture by fixed-point steps,
then the ray meets the board's plane. Squares are softened over about a pixel, then the picture is blurred.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np


@dataclass
class BoardCamera:
    """A camera and the rays of its pixels."""

    size: tuple[int, int] = (640, 480)
    focal: tuple[float, float] = (620.0, 618.0)
    centre: tuple[float, float] = (326.0, 233.0)
    distortion: tuple[float, ...] = (0.07, -0.28, -0.002, 0.0015, 0.0)
    blur: float = 0.7
    noise: float = 3.0
    rays: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        self.rays = self.undistorted(np.stack(np.meshgrid(*map(np.arange, self.size)), axis=-1).astype(float))

    def undistorted(self, pixels: np.ndarray) -> np.ndarray:
        """Normalised points of pixels (..., 2)."""
        seen = (pixels - self.centre) / self.focal
        point = seen.copy()
        for _ in range(60):
            point += 0.7 * (seen - self.distorted(point))
        return point

    def distorted(self, points: np.ndarray) -> np.ndarray:
        k1, k2, p1, p2, k3 = self.distortion
        x, y = points[..., 0], points[..., 1]
        r2 = x * x + y * y
        radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
        u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
        v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
        return np.stack([u, v], axis=-1)

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """Pixels of undistorted normalised points."""
        return self.distorted(points) * self.focal + self.centre


@dataclass(frozen=True)
class Pose:
    """Where a board is: rotation vector (rad) and translation (mm) of its middle."""

    turn: tuple[float, float, float]
    place: tuple[float, float, float]

    @property
    def matrix(self) -> np.ndarray:
        return cv2.Rodrigues(np.array(self.turn, dtype=float))[0]


def poses(rng: np.random.Generator, count: int = 25, distance: float = 100.0, tilt: float = 0.5) -> list[Pose]:
    """Boards in many places and tilts, all corners of an 80 x 56 mm board inside the picture of `BoardCamera`."""
    result = []
    while len(result) < count:
        z = distance * rng.uniform(0.95, 1.5)
        turn = (*rng.uniform(-tilt, tilt, 2), rng.uniform(-0.3, 0.3))
        pose = Pose(turn, (*(rng.uniform(-0.3, 0.3, 2) * z * np.array([0.9, 0.75])), z))
        corners = np.array([[x, y, 0.0] for x in (-40, 40) for y in (-28, 28)]) @ pose.matrix.T + pose.place
        flat = corners[:, :2] / corners[:, 2:]
        if np.abs(flat[:, 0]).max() < 0.5 and np.abs(flat[:, 1]).max() < 0.365:
            result.append(pose)
    return result


def board(
    camera: BoardCamera,
    pose: Pose,
    rng: np.random.Generator,
    corners: tuple[int, int] = (9, 6),
    square: float = 8.0,
    blur: float | None = None,
) -> np.ndarray:
    """A chessboard with `corners` inner corners (columns, rows) and squares of `square` mm, uint8."""
    flat, scale = _on_plane(camera, pose)
    columns, rows = corners[0] + 1, corners[1] + 1
    u = flat[..., 0] / square + columns / 2
    v = flat[..., 1] / square + rows / 2
    pixels = square * scale
    wave = _checks(u, pixels) * _checks(v, pixels)
    inside = _within(u, 0.0, columns, pixels) * _within(v, 0.0, rows, pixels)
    light = 225.0 - inside * (95.0 - 95.0 * wave)
    return _exposed(light, camera, rng, blur)


def ruler(
    camera: BoardCamera, pose: Pose, rng: np.random.Generator, length: int = 70, blur: float | None = None
) -> np.ndarray:
    """A ruler with a mark every mm, longer at 5 and 10 mm, uint8."""
    flat, scale = _on_plane(camera, pose)
    x, y = flat[..., 0] + length / 2, flat[..., 1] + 6.0
    nearest = np.rint(x)
    mark = np.clip(0.5 + (0.12 - np.abs(x - nearest)) * scale, 0.0, 1.0)
    reach = np.where(nearest % 10 == 0, 8.0, np.where(nearest % 5 == 0, 6.5, 5.0))
    mark *= np.clip(0.5 + (reach - y) * scale, 0.0, 1.0) * np.clip(0.5 + y * scale, 0.0, 1.0)
    mark *= (nearest >= 0) & (nearest <= length)
    return _exposed(210.0 - 170.0 * mark, camera, rng, blur)


def corner_points(corners: tuple[int, int] = (9, 6), square: float = 8.0) -> np.ndarray:
    """The inner corners on the board, mm from its middle, row by row."""
    x = (np.arange(corners[0]) - (corners[0] - 1) / 2) * square
    y = (np.arange(corners[1]) - (corners[1] - 1) / 2) * square
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


def _on_plane(camera: BoardCamera, pose: Pose) -> tuple[np.ndarray, np.ndarray]:
    """Board coordinates (mm) of each pixel, and pixels per mm there."""
    turn, place = pose.matrix, np.array(pose.place)
    rays = np.concatenate([camera.rays, np.ones((*camera.rays.shape[:2], 1))], axis=-1)
    normal = turn[:, 2]
    reach = (normal @ place) / (rays @ normal)
    flat = (rays * reach[..., None] - place) @ turn[:, :2]
    return flat, np.full(flat.shape[:2], camera.focal[0]) / np.clip(reach, 1.0, None)


def _checks(u: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """+1 and -1 in turn from square to square, softened over one pixel; `pixels` is pixels per square."""
    sign = np.where(np.floor(u).astype(int) % 2 == 0, 1.0, -1.0)
    return sign * np.clip(2.0 * np.abs(u - np.rint(u)) * pixels, 0.0, 1.0)


def _within(u: np.ndarray, low: float, high: float, pixels: np.ndarray) -> np.ndarray:
    return np.clip(0.5 + (u - low) * pixels, 0, 1) * np.clip(0.5 + (high - u) * pixels, 0, 1)


def _exposed(light: np.ndarray, camera: BoardCamera, rng: np.random.Generator, blur: float | None) -> np.ndarray:
    blur = camera.blur if blur is None else blur
    picture = cv2.GaussianBlur(light.astype(np.float32), (0, 0), blur) if blur > 0 else light.astype(np.float32)
    picture += np.float32(camera.noise) * rng.standard_normal(picture.shape, np.float32)
    return np.clip(np.rint(picture), 0, 255).astype(np.uint8)
