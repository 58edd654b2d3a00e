"""Recursions over a history without a loop over its steps."""

import numpy as np

from wavemodel.arrays import FloatArray, NumberArray

DECAYED = 45.0
"""Beyond this exponent what was there before is gone (e^-45 is 3e-20)."""


LARGEST = 600.0
"""Exponents that may be summed up without overflow."""


def decaying_sum(exponent: NumberArray, gain: NumberArray, start: NumberArray | complex = 0.0) -> NumberArray:
    """y_n = e^(-exponent_n) y_(n-1) + gain_n, from y = `start` before the first.

    Parameters
    ----------
    exponent
        (..., n) not negative (or complex, its real part).
    gain
        (..., n).
    start
        (...) y before the first step.
    """
    whole = exponent.real.sum(axis=-1) <= LARGEST
    if whole.all():
        return _at_once(exponent, gain, start)
    if not whole.any():
        return _joined(exponent, gain, start)
    out, start = np.empty_like(gain), np.broadcast_to(start, whole.shape)
    out[whole] = _at_once(exponent[whole], gain[whole], start[whole])
    out[~whole] = _joined(exponent[~whole], gain[~whole], start[~whole])
    return out


def _at_once(exponent: NumberArray, gain: NumberArray, start: NumberArray | complex) -> NumberArray:
    """The sum of e^(c_k) gain_k with the running sum c of the exponents, every term scaled down by what follows it."""
    growth = np.exp(np.cumsum(exponent, axis=-1))
    return np.asarray((np.cumsum(gain * growth, axis=-1) + np.asarray(start)[..., None]) / growth)


def _joined(exponent: NumberArray, gain: NumberArray, start: NumberArray | complex) -> NumberArray:
    """Two steps are y -> keep y + gain again: they are joined over distances 1, 2, 4..., while anything is left.

    W. D. Hillis and G. L. Steele 1986, Communications of the ACM 29:1170.
    """
    keep, out = np.exp(-np.moveaxis(exponent, -1, 0), order="C"), np.moveaxis(gain, -1, 0).copy()
    out[0] += keep[0] * start
    distance = 1
    while distance < len(out) and np.abs(keep[distance:]).max() > np.exp(-DECAYED):
        out[distance:] += keep[distance:] * out[:-distance]
        keep[distance:] *= keep[:-distance]
        distance *= 2
    return np.moveaxis(out, 0, -1)


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
