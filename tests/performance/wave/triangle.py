"""A triangle of a hundred load steps, set-up apart: the wave against the finite elements of the same job."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

import fem
from tests.performance.wave.job import RADIUS, fem_model, wave_layers
from wavemodel import DiscTool, LayeredWave

T = TypeVar("T")
STEPS, FEM_REPEATS, WAVE_REPEATS = 100, 3, 200
PEAKS = {"linear": 0.1, "finite": 1.0}
"""In N."""


@dataclass(frozen=True)
class Triangle:
    """Seconds of one kinematics: set-ups, medians of the history alone, and the wave's p99."""

    kinematics: str
    fem_setup: float
    fem: float
    wave_setup: float
    wave: float
    wave_p99: float
    error: float

    @property
    def ratio(self) -> float:
        """How many times faster the wave is."""
        return self.fem / self.wave


def triangle(kinematics: str) -> Triangle:
    """Follow the same history with both, repeats in turn."""
    steps = np.arange(1.0, STEPS + 1.0)
    force = PEAKS[kinematics] * (1.0 - np.abs(2.0 * steps / STEPS - 1.0))
    fem_setup, model = _timed(lambda: fem_model(mesh="default", kinematics=kinematics))
    large = "corrected" if kinematics == "finite" else "linear"
    wave_setup, wave = _timed(lambda: LayeredWave(wave_layers(), DiscTool(RADIUS), large_press=large))
    slow, fast = [], []
    for _ in range(FEM_REPEATS):
        seconds, solved = _timed(lambda: model.run(fem.Load("force", steps, force)))
        slow.append(seconds)
        for _ in range(WAVE_REPEATS):
            seconds, followed = _timed(lambda: wave.run("force", steps, force))
            fast.append(seconds)
    peak = solved.top_deflection.max(axis=0)
    error = 100.0 * float((np.abs(followed.top_deflection - solved.top_deflection) / peak).max())
    return Triangle(
        kinematics, fem_setup, float(np.median(slow)), wave_setup, float(np.median(fast)),
        float(np.quantile(fast, 0.99)), error,
    )  # fmt: skip


def _timed(call: Callable[[], T]) -> tuple[float, T]:
    start = time.perf_counter()
    answer = call()
    return time.perf_counter() - start, answer
