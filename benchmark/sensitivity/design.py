"""The points of a Sobol sensitivity analysis: Saltelli's design in the unit cube."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.sensitivity.indices import Array, unit_cube

DEFAULT_BASE = 64
LEAST_BASE = 8


def base_samples(points: int, parameters: int) -> int:
    """The largest base sample, a power of two, whose design has at most `points` points; 0 where none has."""
    most = points // (parameters + 2)
    return 0 if most < 1 else 1 << (most.bit_length() - 1)


def saltelli_design(names: Sequence[str], base: int, seed: int) -> Array:
    """Points of the design.

    Parameters
    ----------
    names
        The d parameters.
    base
        Base samples N, a power of two.
    seed
        Of the scrambling.

    Returns
    -------
    ndarray, shape (N (d + 2), d)
        Shares from 0 to 1, block after block of d + 2 points: A, A with column i from B (i = 1..d), B. Saltelli et al.
        2010, Comput Phys Commun 181:259, without second-order indices.
    """
    from SALib.sample import sobol

    points = sobol.sample(unit_cube(names), base, calc_second_order=False, scramble=True, seed=seed)
    return np.asarray(points, dtype=np.float64)
