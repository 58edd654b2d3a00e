"""Frames that are late against the force, one more than the other."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from benchmark.blind.arrays import Array
from benchmark.blind.hidden.hidden import Hidden


@dataclass(frozen=True, kw_only=True)
class CameraLatency(Hidden):
    """`jitter` seeds the scatter of one trial."""

    slug = "camera_latency"
    only_markers = True
    jitter: int | None = None

    def in_trial(self, rng: np.random.Generator) -> Self:
        """A scatter of its own."""
        return replace(super().in_trial(rng), jitter=int(rng.integers(2**32)))

    def instants(self, frames: Array) -> Array:
        """When frames were taken: before their stamps."""
        late = np.ones(frames.size)
        if self.jitter is not None:
            late *= np.random.default_rng(self.jitter).gamma(16.0, 1 / 16.0, frames.size)
        return np.clip(frames - 0.2 * self.amplitude * late, 0.0, None)
