"""Synthetic replicates of one press, by a linear law."""

import numpy as np

from bench_hw.tables import TrialTable


def replicate(seed, scatter=0.03, deepest=2e-3, air=0.0):
    """A synthetic press of a flat punch, F = k d with 600 N/m (Hayes' linear law), 2 mN of noise, 2 mm and back."""
    random = np.random.default_rng(seed)
    time = np.linspace(0.0, 4.0, 400)
    depth = (deepest + air) * (1.0 - np.abs(time / 2.0 - 1.0)) - air
    stiffness = 600.0 * np.exp(scatter * random.standard_normal())
    force = stiffness * np.clip(depth, 0.0, None) + 2e-3 * random.standard_normal(time.size)
    return TrialTable(time, depth + 5e-7 * random.standard_normal(time.size), force, {}, "", {})
