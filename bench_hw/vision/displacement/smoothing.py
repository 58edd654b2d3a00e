"""The moving average: the article's, which looks back, and one that stays where it is."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from bench_hw.errors import InputError
from bench_hw.vision.displacement.tracks import FloatArray

Mode = Literal["none", "centred", "causal"]
PAPER_WINDOW = 10
"""Section 3.2.5 of the article: "a window size of 10 and a denominator coefficient of 1"."""


def moving_average(values: FloatArray, window: int = PAPER_WINDOW, mode: Mode = "centred") -> FloatArray:
    """Average over frames.

    Parameters
    ----------
    values : ndarray, shape (n, ...)
        NaN where not known; an average with a NaN in its window is NaN.
    window : int
        Frames.
    mode : str
        `centred`: as many frames before as after, the outermost two with half weight where the window is even, a
        shorter window towards the ends; no delay. `causal`: the article's filter (MATLAB's `filter`, which takes
        zeros for what was before the first frame); it delays by (window - 1) / 2 frames and flattens a peak.
        `none`: nothing.

    Raises
    ------
    InputError
        A window below 1, or another mode.
    """
    if window < 1:
        raise InputError(f"a moving average of {window} frames; allowed: at least 1")
    if mode == "none" or window == 1:
        return values.copy()
    if mode == "causal":
        padded = np.concatenate([np.zeros((window - 1, *values.shape[1:])), values])
        return np.asarray(sliding_window_view(padded, window, axis=0).mean(axis=-1))
    if mode == "centred":
        return _centred(values, window)
    raise InputError(f"moving average {mode!r}; allowed: none, centred, causal")


def _centred(values: FloatArray, window: int) -> FloatArray:
    half = window // 2
    weights = np.ones(2 * half + 1)
    if window % 2 == 0:
        weights[[0, -1]] = 0.5
    result = values.copy()
    for row in range(len(values)):
        reach = min(half, row, len(values) - 1 - row)
        part = weights if reach == half else np.ones(2 * reach + 1)
        result[row] = np.tensordot(part / part.sum(), values[row - reach : row + reach + 1], axes=1)
    return result
