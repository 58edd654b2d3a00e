"""Small mathematics that several hidden effects share."""

from __future__ import annotations

import numpy as np

from benchmark.blind.arrays import Array


def touching(depth: Array, width: float) -> Array:
    """How much the tool touches: 0 in air, rising to 1 over a depth of about `width`."""
    return 1.0 - np.exp(-np.clip(depth, 0.0, None) / width)


def lost_memory(time: Array, force: Array, rates: Array) -> Array:
    """What each mode has forgotten of a force history.

    Parameters
    ----------
    time, force : (n,)
        s and N.
    rates : (n, m) or (m,) 1/s
        Of forgetting, which may change with time.

    Returns
    -------
    (n, m) N
        Force minus what each mode still remembers of it.
    """
    rates = np.broadcast_to(rates, (time.size, np.shape(rates)[-1]))
    kept = np.zeros(rates.shape)
    state = np.zeros(rates.shape[1])
    decay = np.exp(-np.diff(time)[:, None] * rates[1:])
    inflow = np.sqrt(decay) * np.diff(force)[:, None]
    for row in range(time.size - 1):
        state = decay[row] * state + inflow[row]
        kept[row + 1] = state
    out: Array = force[:, None] - kept
    return out


def play(path: Array, width: float, start: float) -> Array:
    """Output (n,) of a play of `width` that follows `path`, beginning at `start` within half a width of it."""
    out = np.empty(path.size)
    now, half = start, 0.5 * width
    for row, value in enumerate(path.tolist()):
        now = min(max(now, value - half), value + half)
        out[row] = now
    return out


def smooth_excess(value: Array, threshold: float, width: float) -> Array:
    """By how much a value is over a threshold, rounded over `width`."""
    return width * np.logaddexp(0.0, (value - threshold) / width)
