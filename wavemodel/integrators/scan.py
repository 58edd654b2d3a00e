"""Recursions over a history without a loop over its steps."""

from itertools import pairwise

import numpy as np

from wavemodel.arrays import FloatArray, NumberArray

DECAYED = 45.0
"""Beyond this exponent what was there before is gone (e^-45 is 3e-20)."""
LARGEST = 600.0
"""Exponents that a block may sum up to without overflow."""
BLOCK = 60
"""Steps that cost as much one after the other as a block does at once; shorter blocks are not worth it."""


def decaying_sum(exponent: NumberArray, gain: NumberArray, start: complex = 0.0) -> NumberArray:
    """y_n = e^(-exponent_n) y_(n-1) + gain_n, from y = `start` before the first.

    The sum of e^(c_k) gain_k with the running sum c of the exponents, in blocks that cannot overflow; every term is
    scaled down by what follows it, so that no digits are lost against the recursion.

    Parameters
    ----------
    exponent
        (n,) not negative (or complex, its real part).
    gain
        (n,).
    start
        y before the first step.
    """
    out = np.empty_like(gain)
    exponent = np.where(exponent.real > DECAYED, DECAYED, exponent)
    block = np.floor(np.cumsum(exponent.real) / LARGEST)
    edges = [0, *(np.flatnonzero(np.diff(block)) + 1), gain.size]
    if len(edges) > 2 and gain.size < BLOCK * (len(edges) - 1):
        return _one_by_one(np.exp(-exponent), gain, start)
    for first, last in pairwise(edges):
        sum_up = np.cumsum(exponent[first:last])
        growth = np.exp(sum_up)
        out[first:last] = (np.cumsum(gain[first:last] * growth) + start) / growth
        start = out[last - 1] if last > first else start
    return out


def _one_by_one(keep: NumberArray, gain: NumberArray, start: complex) -> NumberArray:
    """y_n = keep_n y_(n-1) + gain_n, (n,), in Python's numbers, which are faster than arrays of one."""
    out, last = [], start
    for kept, more in zip(keep.tolist(), gain.tolist(), strict=True):
        last = kept * last + more
        out.append(last)
    return np.array(out, dtype=gain.dtype)


def bounded_sum(change: FloatArray, limit: FloatArray, start: float = 0.0) -> FloatArray:
    """y_n = y_(n-1) + change_n, kept within -limit_n and +limit_n (a stop, in the language of hysteresis).

    Steps compose: y -> clip(y + a, low, high) followed by another of its kind is again one. They are therefore
    joined pairwise over distances 1, 2, 4...: log2(n) passes over the whole history.

    Parameters
    ----------
    change
        (n,).
    limit
        (n,) not negative.
    start
        y before the first step.
    """
    shift, low, high = change.copy(), -limit, limit.copy()
    distance = 1
    while distance < change.size:
        a, b, c = shift[distance:].copy(), low[distance:].copy(), high[distance:].copy()
        low[distance:] = np.clip(low[:-distance] + a, b, c)
        high[distance:] = np.clip(high[:-distance] + a, b, c)
        shift[distance:] = shift[:-distance] + a
        distance *= 2
    return np.asarray(np.clip(start + shift, low, high))
