"""First-order autoregressive (AR(1)) noise: its memory, the transform that whitens it, and what it leaves of n samples.

Rows may be means of raw samples: the variance of a mean and its covariance with the next mean follow in closed form
(G. E. P. Box and G. M. Jenkins, Time Series Analysis, section 2.1), and rows further apart are taken as a Markov chain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from benchmark.response.force_curve import Array

MEMORIES = (0.0, 0.2, 0.4, 0.6, 0.75, 0.85, 0.92, 0.96, 0.98, 0.99, 0.995, 0.998)
"""Correlations of neighbouring raw samples that are tried."""
MISSING = 1e6
"""Variance of a row without a sample, in those of a sample."""
RESOLVED = 1e-3
"""To which the memory is found that lies between those."""
RANK = 1e-6
"""Smallest share of the largest singular value with which fitted columns count as different."""
LARGEST = 0.999
"""Lag-one autocorrelations are taken as no larger."""


@dataclass(frozen=True, eq=False)
class Whitener:
    """z_k = (e_k - back_k e_j) / scale_k for noise of unit standard deviation a raw sample; (n,) each.

    j = `before`_k is the row with samples before row k.
    """

    back: Array
    scale: Array
    before: NDArray[np.int64]

    def __call__(self, rows: Array) -> Array:
        """(n, ...) rows to white ones."""
        back, scale = (a.reshape(-1, *[1] * (rows.ndim - 1)) for a in (self.back, self.scale))
        return np.asarray((rows - back * rows[self.before]) / scale)


def whitener(count: Array, memory: float) -> Whitener:
    """For rows that hold `count` (n,) samples, neighbours correlated by `memory`; a row without any says nothing."""
    some = np.flatnonzero(count > 0.0)
    back, scale = np.zeros(count.size), np.full(count.size, np.sqrt(MISSING))
    before = np.arange(count.size)
    before[some[1:]] = some[:-1]
    back[some], scale[some] = _chain(count[some], memory)
    return Whitener(back, scale, before)


def _chain(count: Array, memory: float) -> tuple[Array, Array]:
    """`back` and `scale` of rows that follow one another and hold `count` (n,) samples each."""
    held = np.maximum(count, 1.0)
    if memory > 0.0:
        fade = memory**held
        variance = (1.0 + memory) / (1.0 - memory) / held - 2.0 * memory * (1.0 - fade) / (held * (1.0 - memory)) ** 2
        joint = memory * (1.0 - fade[1:]) * (1.0 - fade[:-1]) / (1.0 - memory) ** 2 / (held[1:] * held[:-1])
    else:
        variance, joint = 1.0 / held, np.zeros(max(held.size - 1, 0))
    share = np.clip(joint / np.sqrt(variance[1:] * variance[:-1]), 0.0, 0.9999)
    back = np.concatenate([[0.0], share * np.sqrt(variance[1:] / variance[:-1])])[: count.size]
    scale = np.sqrt(variance * np.concatenate([[1.0], 1.0 - share**2])[: count.size])
    return back, scale


def fit_memory(errors: Array | Sequence[Array], counts: Array | Sequence[Array]) -> float:
    """The memory of noise by maximum likelihood from R errors (n,), each trial with a scale of its own."""
    best, chosen = np.inf, 0.0
    for memory in MEMORIES:
        total = 0.0
        for error, count in zip(errors, counts, strict=True):
            some = count > 0.0
            if not some.any():
                continue
            use = whitener(count, memory)
            white = use(error)[some]
            total += white.size * np.log(np.mean(white**2) + 1e-300) + 2.0 * np.log(use.scale[some]).sum()
        if total < best:
            best, chosen = total, memory
    return chosen


def scales(errors: Array | Sequence[Array], counts: Array | Sequence[Array], memory: float) -> Array:
    """(R,) standard deviation of a raw sample in each trial; NaN in one without samples, such as one not filmed."""
    return np.array([_scale(error, count, memory) for error, count in zip(errors, counts, strict=True)])


def _scale(error: Array, count: Array, memory: float) -> float:
    some = count > 0.0
    return float(np.sqrt(np.mean(whitener(count, memory)(error)[some] ** 2))) if some.any() else np.nan


def restricted_noise(
    errors: Sequence[Array], counts: Sequence[Array], columns: Sequence[Array], memory: float | None = None
) -> tuple[float, Array]:
    """Memory of the noise, and its standard deviation (R,) in each trial, where each was fitted by columns of its own.

    A fit takes the slow part of the noise along, so that what it leaves forgets sooner than the noise did: of a memory
    of 0.8 in 250 rows three columns leave 0.76, and the noise of a mean is taken a fifth too small. Restricted maximum
    likelihood undoes that (Patterson and Thompson 1971, Biometrika 58:545; of autoregressive noise Cheang and
    Reinsel 2000, Journal of the American Statistical Association 95:1173), each trial with a scale of its own. It
    corrects maximum likelihood's memory, and is sought downhill from there: where the noise is the depth's, the columns
    hold it too, and explain it all once a memory near one takes off what they have beside it.

    Parameters
    ----------
    errors : sequence of (n,) array
        What a fit leaves of R trials.
    counts : sequence of (n,) array
        Samples in each row.
    columns : sequence of (n, q) array
        Derivatives by what was fitted in each trial alone; the errors may hold any share of them.
    memory : float or None
        Where it is known.

    Returns
    -------
    float and (R,) array
        In the unit of the errors; NaN in a trial with no more rows than columns.
    """
    kept = [_Left.of(*each) for each in zip(errors, counts, columns, strict=True)]
    told = [one for one in kept if one is not None]
    if memory is None:
        memory = _restricted_memory(told, fit_memory(errors, counts)) if told else 0.0
    return memory, np.array([np.nan if one is None else one.scale(memory) for one in kept])


def _restricted_memory(told: Sequence[_Left], first: float) -> float:
    """The memory of the restricted likelihood of trials, downhill from a first one."""

    def criterion(memory: float) -> float:
        return sum(one.criterion(memory) for one in told)

    best = _downhill([criterion(each) for each in MEMORIES], MEMORIES.index(first))
    ends = MEMORIES[max(best - 1, 0)], MEMORIES[min(best + 1, len(MEMORIES) - 1)]
    between = minimize_scalar(criterion, bounds=ends, method="bounded", options={"xatol": RESOLVED}).x
    return min((MEMORIES[best], float(between)), key=criterion)


def _downhill(values: Sequence[float], start: int) -> int:
    """The place of the minimum to which values lead from a start."""
    while True:
        lower = min(range(max(start - 1, 0), min(start + 2, len(values))), key=lambda k: values[k])
        if values[lower] >= values[start]:
            return start
        start = lower


@dataclass(frozen=True, eq=False)
class _Left:
    """What a fit leaves of one trial (n,), samples in each row, and an orthonormal basis (n, r) of what was fitted."""

    error: Array
    count: Array
    basis: Array

    @staticmethod
    def of(error: Array, count: Array, columns: Array) -> _Left | None:
        """Without rows that hold no sample; None where no more rows than columns are left."""
        some = count > 0.0
        left, sizes, _ = np.linalg.svd(columns[some] / np.maximum(np.linalg.norm(columns[some], axis=0), 1e-300), False)
        basis = left[:, sizes > RANK * max(sizes.max(initial=0.0), 1e-300)]
        return _Left(error[some], count[some], basis) if some.sum() > basis.shape[1] else None

    def criterion(self, memory: float) -> float:
        """-2 log restricted likelihood at the best scale, but for a constant."""
        power, ruled, steps = self._white(memory)
        return float(self._freedom * np.log(power + 1e-300) + 2.0 * (np.log(ruled).sum() + np.log(steps).sum()))

    def scale(self, memory: float) -> float:
        """Standard deviation of a raw sample."""
        return float(np.sqrt(self._white(memory)[0]))

    @property
    def _freedom(self) -> int:
        return int(self.error.size - self.basis.shape[1])

    def _white(self, memory: float) -> tuple[float, Array, Array]:
        """Mean square per degree of freedom, the sizes (r,) of the fitted directions, and the whitener's scales."""
        use = whitener(self.count, memory)
        directions, ruled = np.linalg.qr(use(self.basis))
        white = use(self.error)
        white = white - directions @ (directions.T @ white)
        return float(white @ white) / self._freedom, np.abs(np.diag(ruled)), use.scale


def lag_one(residual: Array, parameters: int = 1) -> float:
    """Lag-one autocorrelation of a residual (n,) left by a fit of `parameters`, between 0 and 0.999.

    The estimate is low by (1 + 3 rho) / n for a fitted mean (Marriott and Pope, Biometrika 41:390); that is
    undone once for each fitted parameter. Negative values count as 0: an interval is never narrowed.
    """
    n = len(residual)
    centred = residual - residual.mean()
    power = float(centred @ centred)
    if power == 0.0:
        return 0.0
    raw = float(centred[1:] @ centred[:-1]) / power
    share = min(parameters / n, 0.1)
    return float(np.clip((raw + share) / (1.0 - 3.0 * share), 0.0, LARGEST))


def effective_rows(rows: int, rho: float) -> float:
    """Return how many independent samples tell as much as `rows` of them: n (1 - rho) / (1 + rho)."""
    return rows * (1.0 - rho) / (1.0 + rho)


def whitened(columns: Array, rho: float) -> Array:
    """Rows (n - 1, c) of `columns` (n, c) less rho times the row before, which makes AR(1) noise white."""
    return np.asarray(columns[1:] - rho * columns[:-1])
