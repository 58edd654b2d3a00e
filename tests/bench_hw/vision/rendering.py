"""Pictures of markers whose true places are known exactly. Synthetic, for tests; nothing here is the tracker's.

A marker is a star-shaped blot on the plane: r(a) = R (1 + sum of harmonics). Its outline, 720 points, goes through
the camera forwards, so that no distortion is ever inverted. A pixel's grey level follows from the share of 4 x 4
points in it that lie inside, each softened over its own size, then blurred. The truth is the area centroid of the
outline on the plane.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import cv2
import numpy as np

FINE = 4
PAPER_DISTORTION = (0.07, -0.48, -0.01, -0.01, 0.0)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)


@dataclass(frozen=True)
class Scene:
    """A camera over a plane at `distance` mm; pixel (0, 0) is the middle of the first pixel."""

    size: tuple[int, int] = (640, 480)
    focal: float = 582.0
    centre: tuple[float, float] = (322.0, 236.5)
    distortion: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0, 0.0)
    distance: float = 70.0
    origin: tuple[float, float] = (0.0, 0.0)  # mm on the plane, from the optical axis to the grid's middle
    paper: float = 205.0
    ink: float = 35.0
    lighting: float = 0.15
    blur: float = 0.8
    noise: float = 4.0

    def project(self, points: np.ndarray, sunk: np.ndarray | float = 0.0) -> np.ndarray:
        """Pixels of plane points (..., 2) in mm that have sunk towards the camera by `sunk` mm."""
        k1, k2, p1, p2, k3 = self.distortion
        depth = self.distance - np.asarray(sunk)
        x, y = (points[..., 0] + self.origin[0]) / depth, (points[..., 1] + self.origin[1]) / depth
        r2 = x * x + y * y
        radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
        u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
        v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
        return np.stack([u * self.focal + self.centre[0], v * self.focal + self.centre[1]], axis=-1)

    @property
    def mm_per_px(self) -> float:
        return self.distance / self.focal

    def camera_toml(self) -> str:
        """The true camera.toml."""
        width, height = self.size
        k1, k2, p1, p2, k3 = self.distortion
        origin = [c + o / self.mm_per_px for c, o in zip(self.centre, self.origin, strict=True)]
        return (
            f"schema = 1\nimage_size = [{width}, {height}]\n"
            f"[matrix]\nfx = {self.focal}\nfy = {self.focal}\ncx = {self.centre[0]}\ncy = {self.centre[1]}\n"
            f"[distortion]\nk1 = {k1}\nk2 = {k2}\np1 = {p1}\np2 = {p2}\nk3 = {k3}\n"
            f"[plane]\nmm_per_px = {self.mm_per_px!r}\nmm_per_px_std = 0.0\norigin_px = {origin}\n"
            "[quality]\nviews = 25\nreprojection_rms_px = 0.1\nmap_error_rms_px = 0.01\n"
        )


@dataclass(frozen=True)
class Sheet:
    """Markers on the plane: middles (m, 2) in mm, and outlines (m, 720) in mm."""

    middles: np.ndarray
    outlines: np.ndarray

    def truth(self, moved: np.ndarray | None = None) -> np.ndarray:
        """Area centroids (m, 2) on the plane, mm, with the middles moved to `moved`."""
        middles = self.middles if moved is None else moved
        x, y = self.outlines * np.cos(ANGLES), self.outlines * np.sin(ANGLES)
        cross = x * np.roll(y, -1, 1) - np.roll(x, -1, 1) * y
        area = 3.0 * cross.sum(1)
        offset = [(((v + np.roll(v, -1, 1)) * cross).sum(1)) / area for v in (x, y)]
        return middles + np.stack(offset, axis=1)


def sheet(
    rng: np.random.Generator,
    rows: int = 3,
    columns: int = 6,
    spacing: float = 8.5,
    radius: float = 1.2,
    out_of_round: float = 0.06,
    turn: float = 0.0,
) -> Sheet:
    """A grid around (0, 0), row by row, of markers whose radius strays by up to `out_of_round` of itself."""
    x = (np.arange(columns) - (columns - 1) / 2) * spacing
    y = (np.arange(rows) - (rows - 1) / 2) * spacing
    middles = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    c, s = np.cos(turn), np.sin(turn)
    middles = middles @ np.array([[c, s], [-s, c]])
    wave = np.zeros((len(middles), len(ANGLES)))
    for n in range(2, 6):
        size, phase = rng.normal(size=(len(middles), 1)) / n, rng.uniform(0, 2 * np.pi, (len(middles), 1))
        wave += size * np.cos(n * ANGLES + phase)
    wave *= out_of_round / np.abs(wave).max(axis=1, keepdims=True)
    return Sheet(middles, radius * (1.0 + wave))


@dataclass
class Renderer:
    """Paints frames of one sheet through one camera."""

    scene: Scene
    sheet: Sheet
    rng: np.random.Generator
    _ground: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        width, height = self.scene.size
        ramp = 1.0 + self.scene.lighting * ((np.arange(width) - width / 2) / width)[None, :]
        ramp = ramp + 0.5 * self.scene.lighting * ((np.arange(height) - height / 2) / height)[:, None]
        self._ground = ramp.astype(np.float32)

    def frame(
        self, moved: np.ndarray | None = None, sunk: np.ndarray | float = 0.0, stretch: float = 1.0
    ) -> np.ndarray:
        """A grey picture (height, width), uint8, of the markers with their middles at `moved` (m, 2) mm."""
        return self.noisy(self.clean(moved, sunk, stretch))

    def clean(
        self, moved: np.ndarray | None = None, sunk: np.ndarray | float = 0.0, stretch: float = 1.0
    ) -> np.ndarray:
        """The same without noise, float32."""
        middles = self.sheet.middles if moved is None else moved
        depths = np.broadcast_to(np.asarray(sunk, dtype=float), (len(middles),))
        scene = self.scene
        picture = scene.paper * self._ground
        for middle, outline, depth in zip(middles, self.sheet.outlines * stretch, depths, strict=True):
            ring = middle + outline[:, None] * np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)
            _blot(picture, scene.project(ring, depth), scene.project(middle, depth), scene, self._ground)
        return picture

    def noisy(self, picture: np.ndarray, level: float | None = None) -> np.ndarray:
        """Grey noise and rounding."""
        level = self.scene.noise if level is None else level
        grain = self.rng.standard_normal(picture.shape, np.float32) * np.float32(level)
        return np.clip(np.rint(picture + grain), 0, 255).astype(np.uint8)


def _blot(picture: np.ndarray, ring: np.ndarray, middle: np.ndarray, scene: Scene, ground: np.ndarray) -> None:
    margin = 4 + int(np.ceil(4 * scene.blur))
    low = np.floor(ring.min(axis=0)).astype(int) - margin
    high = np.ceil(ring.max(axis=0)).astype(int) + margin + 1
    cut_low, cut_high = np.maximum(low, 0), np.minimum(high, scene.size)
    if np.any(cut_low >= cut_high):
        return
    share = _share(ring - low, middle - low, high - low, scene.blur)
    share = share[cut_low[1] - low[1] : cut_high[1] - low[1], cut_low[0] - low[0] : cut_high[0] - low[0]]
    window = (slice(cut_low[1], cut_high[1]), slice(cut_low[0], cut_high[0]))
    picture[window] += share * (scene.ink * ground[window] - picture[window])


def _share(ring: np.ndarray, middle: np.ndarray, size: np.ndarray, blur: float) -> np.ndarray:
    """Share of each pixel of a window inside an outline (720, 2), blurred; pixels of the window's first pixel."""
    x = (np.arange(size[0] * FINE) + 0.5) / FINE - 0.5 - middle[0]
    y = (np.arange(size[1] * FINE) + 0.5) / FINE - 0.5 - middle[1]
    offset = ring - middle
    angle = np.arctan2(offset[:, 1], offset[:, 0])
    order = np.argsort(angle)
    radius = np.hypot(offset[order, 0], offset[order, 1])
    fine_angle = np.arctan2(y[:, None], x[None, :])
    edge = np.interp(fine_angle, angle[order], radius, period=2 * np.pi)
    slope = np.gradient(radius, angle[order])
    lean = np.interp(fine_angle, angle[order], np.cos(np.arctan2(slope, radius)), period=2 * np.pi)
    inside = np.clip(0.5 + FINE * lean * (edge - np.hypot(x[None, :], y[:, None])), 0.0, 1.0).astype(np.float32)
    if blur > 0:
        inside = cv2.GaussianBlur(inside, (0, 0), blur * FINE, borderType=cv2.BORDER_REPLICATE)
    return inside.reshape(size[1], FINE, size[0], FINE).mean(axis=(1, 3))


def press(sheet_: Sheet, depth: float, reach: float = 30.0, thickness: float = 4.0) -> tuple[np.ndarray, np.ndarray]:
    """Middles (m, 2) and sinking (m,), mm, of a clamped plate pressed by `depth` mm in the middle."""
    r2 = (sheet_.middles**2).sum(axis=1)
    share = np.clip(1.0 - r2 / reach**2, 0.0, None)
    slope = depth * 4.0 / reach**2 * share
    return sheet_.middles * (1.0 + 0.5 * thickness * slope)[:, None], depth * share**2


__all__ = ["PAPER_DISTORTION", "Renderer", "Scene", "Sheet", "press", "replace", "sheet"]
