"""What a bench adds to a trial: noise with memory and heavy tails, and now and then a bad trial."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from benchmark.blind.arrays import Array, Integers
from benchmark.blind.scene import Noise

TAILS = 4.0


def remembered(noise: Noise, shape: tuple[int, ...], rng: np.random.Generator) -> Array:
    """First-order autoregressive noise along the first axis, of Student-t shocks with 4 degrees of freedom."""
    shocks = rng.standard_t(TAILS, shape) / np.sqrt(TAILS / (TAILS - 2.0))
    shocks *= np.sqrt(1.0 - noise.memory**2)
    shocks[0] /= np.sqrt(1.0 - noise.memory**2)
    out: Array = noise.std * lfilter([1.0], [1.0, -noise.memory], shocks, axis=0)
    return out


def spike(time: Array, size: float, rng: np.random.Generator) -> Array:
    """A knock against the bench: (n,) N, a decaying ring of a tenth of a second."""
    since = time - rng.uniform(0.2, 0.8) * time[-1]
    ring = np.exp(-since / 0.1) * np.cos(2 * np.pi * 15.0 * since)
    return size * np.where(since >= 0.0, ring, 0.0)


def dropout(time: Array, rng: np.random.Generator) -> Integers:
    """Indices of the samples that are kept when a plug is loose for 0.3 s."""
    begin = rng.uniform(0.2, 0.8) * time[-1]
    return np.flatnonzero((time < begin) | (time > begin + 0.3))
