"""Corners of boards as a known camera sees them, without any picture. Synthetic."""

from collections.abc import Callable

import numpy as np
import pytest

from bench_hw.vision.calibration import Board
from bench_hw.vision.camera import Camera

NOISE = 0.04
"""Standard deviation of a corner, pixels an axis: what the detector leaves in a sharp picture."""


@pytest.fixture(scope="session")
def board() -> Board:
    return Board(9, 6, 8e-3)


@pytest.fixture(scope="session")
def lens(boards):
    return boards.BoardCamera()


@pytest.fixture(scope="session")
def true_camera(lens) -> Camera:
    return Camera(lens.size, lens.focal, lens.centre, lens.distortion)


@pytest.fixture(scope="session")
def seen_corners(boards, lens, board) -> Callable[..., list[np.ndarray]]:
    """Corners (54, 2) of a board in poses, with noise."""

    def see(poses, seed: int = 0, noise: float = NOISE) -> list[np.ndarray]:
        random = np.random.default_rng(seed)
        flat = np.pad(boards.corner_points(), ((0, 0), (0, 1)))
        views = []
        for pose in poses:
            points = flat @ pose.matrix.T + pose.place
            pixels = lens.pixels(points[:, :2] / points[:, 2:])
            views.append(pixels + random.normal(0, noise, pixels.shape))
        return views

    return see
