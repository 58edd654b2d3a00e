"""A press of a linear spring of 500 N/m, cut into short steps."""

from collections.abc import Callable

import numpy as np
import pytest

from wavemodel.physics.quasi_static_press import QuasiStaticPress

STIFFNESS = 500.0


def spring(depth: np.ndarray) -> np.ndarray:
    return STIFFNESS * depth


def sawtooth(*corners: float, points: int = 400) -> np.ndarray:
    """Depths that go straight from corner to corner, the corners included."""
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(corners)))])
    return np.interp(np.unique(np.concatenate([np.linspace(0.0, way[-1], points), way])), way, corners)


@pytest.fixture
def path() -> Callable[..., np.ndarray]:
    return sawtooth


@pytest.fixture
def press() -> Callable[..., np.ndarray]:
    """(physics, depth, speed) to force: the spring with options, moved at a constant speed (m/s)."""

    def run(physics, depth, speed=1e-3):
        steps = np.maximum(np.abs(np.diff(depth, prepend=0.0)) / speed, 1e-9)
        return QuasiStaticPress(spring, physics).force(np.cumsum(steps), depth)

    return run
