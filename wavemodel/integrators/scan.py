"""Recursions over a history without a loop over its steps."""

import numpy as np
from scipy.linalg import get_blas_funcs

from wavemodel.arrays import FloatArray, NumberArray

DECAYED = 45.0
"""Beyond this exponent what was there before is gone (e^-45 is 3e-20)."""


def decaying_sum(exponent: NumberArray, gain: NumberArray, start: NumberArray | complex = 0.0) -> NumberArray:
    """y_n = e^(-exponent_n) y_(n-1) + gain_n, from y = `start` before the first.

    The steps of all rows, one after the other, are one unit triangular band that BLAS solves.

    Parameters
    ----------
    exponent
        (..., n) not negative (or complex, its real part).
    gain
        (..., n).
    start
        (...) y before the first step.
    """
    keep, out = np.exp(-exponent), np.array(gain, dtype=np.result_type(exponent, gain, np.asarray(start)))
    if out.size == 0:
        return out
    out[..., 0] += keep[..., 0] * start
    keep[..., 0] = 0.0  # one row after the other: each starts anew
    band = np.ones((2, out.size), dtype=out.dtype, order="F")
    np.negative(keep.ravel()[1:], out=band[1, :-1])
    (solve,) = get_blas_funcs(("tbsv",), (band,))
    return np.asarray(solve(1, band, out.ravel(), lower=1, diag=1, overwrite_x=1)).reshape(out.shape)


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
