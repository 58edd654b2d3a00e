"""How far apart two rivals are in an experiment: what the second cannot imitate of the first."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmark.discovery.result import Array

Signals = Callable[[Array], Array]
"""Parameters (p,) of a model to its signals (n, C) in an experiment."""
STEP = 0.1
"""Of a parameter's standard deviation, for differences."""


def separation(first: Array, rival: Signals, at: Array, covariance: Array, noise: Array, time: Array) -> float:
    """T = min over the rival's parameters of |m_A - m_B|^2, in squared standard deviations of one trial.

    The rival may move its parameters, at the price of what the session says of them, and each trial has a gain, a
    zero of every channel and a time shift of its own. Linear in all of these (optimal design for discrimination:
    A. C. Atkinson and V. V. Fedorov 1975, Biometrika 62:57).

    Parameters
    ----------
    first : (n, C) array
        What the first expects.
    rival : (p,) to (n, C)
        The second.
    at, covariance : (p,) and (p, p)
        The second's parameters by the session.
    noise : (C,) array
        Standard deviation of a row.
    time : (n,) array
        s.
    """
    second = rival(at)
    whole = ((first - second) / noise).ravel()
    spread = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    moved = [
        ((rival(at + STEP * size * unit) - second) / (STEP * noise)).ravel()
        for size, unit in zip(spread, np.eye(at.size), strict=True)
        if size > 0.0
    ]
    columns = np.column_stack([*moved, *_nuisances(second, noise, time)])
    prices = np.zeros((len(moved), columns.shape[1]))
    kept = spread > 0.0
    if moved:
        correlation = covariance[np.ix_(kept, kept)] / np.outer(spread[kept], spread[kept])
        values, vectors = np.linalg.eigh(correlation)
        prices[:, : len(moved)] = (vectors / np.sqrt(np.maximum(values, 1e-9))).T
    design = np.vstack([columns, prices])
    wanted = np.concatenate([whole, np.zeros(len(moved))])
    found = np.linalg.lstsq(design, wanted, rcond=1e-10)[0]
    return float(np.sum((wanted - design @ found) ** 2))


def _nuisances(signals: Array, noise: Array, time: Array) -> list[Array]:
    """Gain, time shift, and the zero of each channel, as columns."""
    shifted = np.gradient(signals, time, axis=0)
    zeros = [np.broadcast_to(row, signals.shape).ravel() for row in np.eye(signals.shape[1])]
    return [(signals / noise).ravel(), (shifted / noise).ravel(), *zeros]
