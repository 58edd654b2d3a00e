"""Fading memory with three relaxation times, or with a stretched exponential."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden, Scale
from benchmark.blind.hidden.tools import lost_memory


@dataclass(frozen=True, kw_only=True)
class ViscoelasticRelaxation(Hidden):
    """Shares and times (s) of the modes; a stretched exponential is a broad spectrum of many."""

    slug = "viscoelastic_relaxation"
    shares: tuple[float, ...]
    times: tuple[float, ...]

    @classmethod
    def draw(cls, scale: Scale, rng: np.random.Generator) -> Self:
        """Three terms a decade apart, or a spectrum of 13."""
        if rng.random() < 0.5:
            times = np.array([0.12, 1.1, 9.0]) * np.exp(rng.uniform(-0.5, 0.5, 3))
            shares = rng.dirichlet([4.0, 4.0, 4.0])
        else:
            shift = np.linspace(-3.0, 3.0, 13)
            times = rng.uniform(0.5, 2.0) * np.exp(shift)
            shares = np.exp(-0.5 * (shift / rng.uniform(1.0, 1.6)) ** 2)
            shares /= shares.sum()
        return cls(scale=scale, shares=tuple(shares.tolist()), times=tuple(times.tolist()))

    def push(self, time: Array, depth: Array, elastic: Array) -> Array:
        """What has been forgotten is missing."""
        lost: Array = lost_memory(time, elastic, 1.0 / np.array(self.times)) @ np.array(self.shares)
        return -0.5 * self.amplitude * lost
