"""The rows of a load: which force or depth is applied at which time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmark.files.load import OBSERVATIONS, Load


class LoadHistory(NamedTuple):
    """A load over time; before its first row the tissue is unloaded and at rest.

    Attributes
    ----------
    time : ndarray (n,)
        s, increasing, above zero.
    value : ndarray (n,)
        Force in N or depth in m, press positive.
    """

    time: NDArray[np.float64]
    value: NDArray[np.float64]


def load_history(load: Load) -> LoadHistory:
    """The observations of a load, k = 1..n; there is no row at time zero.

    Parameters
    ----------
    load : Load
        - triangle: row k at k/n of the duration, min(k, n - k) / (n/2) of the peak: for n = 100 that is 1..50, 49..0
          fiftieths, the history behind the paper's Table 2. An odd n steps over the peak.
        - ramp: row k at k/n of the duration, k/n of the peak.
        - ramp_hold: rows are shared between ramp and hold in proportion to their durations, at least one each, even
          in each part, so that the end of the ramp is always a row.
        - table: its own rows after time zero, or, with `observations`, n rows at k/n of its last time, interpolated
          linearly (from zero load at time zero where the table has no row there).

    Returns
    -------
    LoadHistory
        time (n,) and value (n,).
    """
    if load.table is not None:
        return _table(load.table, load.observations)
    count = load.observations or OBSERVATIONS
    step = np.arange(1, count + 1, dtype=np.float64)
    if load.shape == "ramp_hold":
        return _ramp_hold(load, count)
    share = step / count if load.shape == "ramp" else np.minimum(step, count - step) / (count / 2)
    return LoadHistory(load.duration * (step / count), load.peak * share)


def _ramp_hold(load: Load, count: int) -> LoadHistory:
    hold = load.hold or 0.0
    ramp_rows = min(max(round(count * load.duration / (load.duration + hold)), 1), count - 1)
    hold_rows = count - ramp_rows
    up = np.arange(1, ramp_rows + 1) / ramp_rows
    rest = np.arange(1, hold_rows + 1) / hold_rows
    time = np.concatenate([load.duration * up, load.duration + hold * rest])
    return LoadHistory(time, load.peak * np.concatenate([up, np.ones(hold_rows)]))


def _table(rows: tuple[tuple[float, float], ...], count: int | None) -> LoadHistory:
    time, value = np.array(rows, dtype=np.float64).T
    if count is None:
        return LoadHistory(time[time > 0], value[time > 0])
    if time[0] > 0:
        time, value = np.append(0.0, time), np.append(0.0, value)
    at = time[-1] * (np.arange(1, count + 1) / count)
    return LoadHistory(at, np.interp(at, time, value))
