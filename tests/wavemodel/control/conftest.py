"""A wave with few modes, a tissue, and tools on it."""

from collections.abc import Callable

import numpy as np
import pytest

from wavemodel import DiscTool, LayeredWave, WaveDiscretisation
from wavemodel.control import Grid, InteractiveTissue, layered_body


@pytest.fixture(scope="session")
def grid() -> Grid:
    return Grid(80e-3, 60e-3, 1e-3)


@pytest.fixture(scope="session")
def wave(skin) -> LayeredWave:
    return LayeredWave(
        skin(), DiscTool(3e-3), discretisation=WaveDiscretisation(window=40e-3, modes=24), large_press="linear"
    )


@pytest.fixture
def tissue(wave, grid) -> Callable[..., InteractiveTissue]:
    return lambda **options: InteractiveTissue(layered_body(wave, grid), grid, **options)


@pytest.fixture(scope="session")
def snapshot() -> Callable[[InteractiveTissue], list[np.ndarray]]:
    """All that a tissue answers, copied: two further frames and their forces."""
    return lambda tissue: [tissue.frame(1e-3).copy(), tissue.force.copy(), tissue.frame(1e-3).copy()]
