"""Noise and scatter of trials from what a fit leaves, the scatter parted between specimens and their trials.

A one-way random-effects model of the logarithms of the trials' gains by restricted maximum likelihood, for groups of
any size (Searle, Casella and McCulloch, Variance Components, 1992, 3.8). Trials of one specimen are no independent
witnesses of what specimens have in common: `inflation` is by how much its standard error grows for that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy

from benchmark.identification.parameters.layer_model import GAIN, MM, TOUCH, FilmNoise, FitTrial, LayerModel
from benchmark.identification.trial_data import TrialData
from benchmark.identification.trial_features import sample_noise
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import TrialsFit
from benchmark.response.noise import restricted_noise, whitener

RATIOS = np.concatenate([[0.0], np.geomspace(1e-3, 1e4, 281)])
"""Variance between over variance within that are tried."""
CHI_SQUARED = 3.841
LEAST_SCATTER = 1e-3
CELLS = 12
"""Of depth on the way down, and as many on the way up, in which trials are compared."""
CLEAR_OF_TOUCH, LEAST_AIR = 0.02, 10
"""Rows so much of the travel above the touch are in the air, and so many tell the noise there."""
LEAST_FILM_NOISE = 1e-9
"""m."""


@dataclass(frozen=True)
class SpreadParts:
    """Standard deviations of logarithms, each with its 95 % interval.

    Attributes
    ----------
    between, within : float
    between_ci95, within_ci95 : tuple of float
        `between` by profile likelihood; an open upper end is infinite.
    specimens, trials : int
    inflation : float
        Standard error of the common mean over that of independent trials; at least 1.
    """

    between: float
    between_ci95: tuple[float, float]
    within: float
    within_ci95: tuple[float, float]
    specimens: int
    trials: int
    inflation: float

    @property
    def text(self) -> str:
        """In words."""
        low, high = (100.0 * each for each in self.between_ci95)
        return (
            f"specimens scatter by {100 * self.between:.2g} % (95 % {low:.2g} to {high:.2g}), trials of one specimen "
            f"by {100 * self.within:.2g} % ({100 * self.within_ci95[0]:.2g} to {100 * self.within_ci95[1]:.2g}): "
            f"{self.trials} trials of {self.specimens} specimens"
        )

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`, in per cent."""
        ends = [100.0 * each if np.isfinite(each) else None for each in self.between_ci95]
        return {
            "between_specimens_percent": 100.0 * self.between,
            "between_ci95": ends,
            "within_specimens_percent": 100.0 * self.within,
            "within_ci95": [100.0 * each for each in self.within_ci95],
            "specimens": self.specimens,
            "trials": self.trials,
            "text": self.text,
        }


def spread_parts(gains: Array, specimens: Sequence[str]) -> SpreadParts | None:
    """Part the scatter of gains (R,); None with one specimen, or where none was tried twice.

    Parameters
    ----------
    gains : (R,) array
        Logarithms.
    specimens : sequence of str
        The specimen of each trial.
    """
    names = list(dict.fromkeys(specimens))
    groups = [gains[[each == name for each in specimens]] for name in names]
    counts = np.array([one.size for one in groups], dtype=float)
    if len(groups) < 2 or counts.max() < 2:
        return None
    means = np.array([one.mean() for one in groups])
    inside = float(sum(np.sum((one - one.mean()) ** 2) for one in groups))
    curve = np.array([_criterion(ratio, counts, means, inside) for ratio in RATIOS])
    best = int(np.argmin(curve[:, 0]))
    between, within = curve[:, 1] * np.sqrt(RATIOS), curve[:, 1]
    likely = np.flatnonzero(curve[:, 0] <= curve[best, 0] + CHI_SQUARED)
    high = np.inf if likely[-1] == RATIOS.size - 1 else float(between[likely[-1]])
    freedom = counts.sum() - counts.size
    ends = [np.sqrt(inside / scipy.stats.chi2.ppf(share, freedom)) for share in (0.975, 0.025)]
    variance = 1.0 / np.sum(counts / (within[best] ** 2 + counts * between[best] ** 2))
    independent = (within[best] ** 2 + between[best] ** 2) / counts.sum()
    return SpreadParts(
        float(between[best]),
        (float(between[likely[0]]), high),
        float(within[best]),
        (float(ends[0]), float(ends[1])),
        len(groups),
        int(counts.sum()),
        max(1.0, float(np.sqrt(variance / independent))),
    )


def _criterion(ratio: float, counts: Array, means: Array, inside: float) -> tuple[float, float]:
    """-2 log restricted likelihood at a ratio of variances, and the standard deviation within that belongs to it."""
    weight = counts / (1.0 + counts * ratio)
    mean = float(np.sum(weight * means) / np.sum(weight))
    total = inside + float(np.sum(weight * (means - mean) ** 2))
    freedom = float(counts.sum() - 1.0)
    variance = max(total / freedom, 1e-300)
    value = freedom * np.log(variance) + float(np.sum(np.log1p(counts * ratio))) + float(np.log(np.sum(weight)))
    return value, float(np.sqrt(variance))


@dataclass(frozen=True)
class CourseLeft:
    """What a fit leaves of the force of one press' trials alike, and the noise of their records, N.

    `over_time` where conditions were taken each by itself over time, where that says more than depth.
    """

    left: float = 0.0
    noise: float = 0.0
    over_time: bool = False

    @property
    def ratio(self) -> float:
        """How many times the noise is left."""
        return self.left / max(self.noise, 1e-300)


def courses_left(fit: TrialsFit[LayerModel]) -> tuple[CourseLeft, ...]:
    """What a fit leaves of the force of each press' trials alike, and the noise of their records.

    Trials of one press share what a law does not follow: the mean of what is left at a depth on the way down, or up,
    less what chance leaves of a mean; and trials of one condition what is left at a time after the touch, as in a hold.
    The noise is told without the law: the largest of the scatter of samples, of the force in the air and of what is
    left between trials, which slow noise makes. One trial is taken by itself where it has been in the air, else its
    share is 0.
    """
    predicted = fit.model.predicted(fit.vector, fit.nuisance)
    errors = [one.data.force - force for one, force in zip(fit.model.trials, predicted, strict=True)]
    touches = fit.nuisance[:, TOUCH] / MM
    return tuple(_course_left(fit.model.trials, touches, errors, press) for press in range(len(fit.model.surrogates)))


def _course_left(trials: Sequence[FitTrial], touches: Array, errors: Sequence[Array], press: int) -> CourseLeft:
    """Of one press."""
    own = [k for k, one in enumerate(trials) if one.press == press]
    if not own:
        return CourseLeft()
    air = [_in_air(trials[k].data, touches[k]) for k in own]
    noise = float(np.median(np.fmax(air, [sample_noise(trials[k].data.force) for k in own])))
    if len(own) < 2:
        lone = float(np.sqrt(np.mean(errors[own[0]] ** 2))) if np.isfinite(air[0]) else 0.0
        return CourseLeft(lone, noise)
    found = [_alike([_shared([_places(trials[k].data, touches[k]) for k in own], [errors[k] for k in own])], noise)]
    names = [trials[k].data.condition for k in own]
    repeated = [[k for k, each in zip(own, names, strict=True) if each == name] for name in sorted(set(names))]
    held = [
        _shared(_times([trials[k].data for k in each], touches[each]), [errors[k] for k in each])
        for each in repeated
        if len(each) > 1
    ]
    if held:
        found.append(replace(_alike(held, noise), over_time=True))
    return max(found, key=lambda one: one.ratio)


def _alike(shared: Sequence[tuple[float, float]], noise: float) -> CourseLeft:
    """Of mean squares alike and apart in one group of trials or several."""
    alike, apart = np.mean(shared, axis=0)
    return CourseLeft(float(np.sqrt(alike)), max(noise, float(np.sqrt(apart))))


def _times(trials: Sequence[TrialData], touches: Array) -> list[Array]:
    """(n,) the cell of each row by the time since the touch, as long as all trials go on; -1 elsewhere."""
    since = [one.time - one.time[int(np.argmax(one.depth > touch))] for one, touch in zip(trials, touches, strict=True)]
    end = max(min(float(one[-1]) for one in since), 1e-300)
    cells = [np.floor(2 * CELLS * one / end).astype(int) for one in since]
    return [np.where((one >= 0) & (one < 2 * CELLS), one, -1) for one in cells]


def _in_air(trial: TrialData, touch: float) -> float:
    """Standard deviation of the force in the air, N; NaN where there are too few rows."""
    air = trial.force[trial.depth < touch - CLEAR_OF_TOUCH * float(np.ptp(trial.depth))]
    return float(np.std(air)) if air.size >= LEAST_AIR else np.nan


def _places(trial: TrialData, touch: float) -> Array:
    """(n,) the cell of each row by its depth, on the way to the deepest and back; -1 in the air."""
    below = (trial.depth - touch) / max(float(trial.depth.max()) - touch, 1e-12)
    cell = np.minimum((CELLS * below).astype(int), CELLS - 1)
    back = np.arange(trial.rows) > int(np.argmax(trial.depth))
    return np.where(below > 0.0, cell + CELLS * back, -1)


def _shared(places: Sequence[Array], errors: Sequence[Array]) -> tuple[float, float]:
    """Mean squares of what trials leave alike in cells, less chance's part, and of what they leave apart."""
    means = np.full((len(places), 2 * CELLS), np.nan)
    for k, (cells, error) in enumerate(zip(places, errors, strict=True)):
        for cell in np.unique(cells[cells >= 0]):
            means[k, cell] = error[cells == cell].mean()
    told = np.isfinite(means).all(axis=0)
    if not told.any():
        return 0.0, 0.0
    apart = float(np.mean(np.var(means[:, told], axis=0, ddof=1)))
    alike = float(np.mean(np.mean(means[:, told], axis=0) ** 2)) - apart / len(places)
    return max(alike, 0.0), apart


def renoised(fit: TrialsFit[LayerModel], freedom: int, memory: float | None = None) -> tuple[LayerModel, float]:
    """The model with noise (AR(1)) and scatter of gains estimated from what a fit leaves, and the noise's memory.

    Parameters
    ----------
    fit : TrialsFit of LayerModel
    freedom : int
        Trials beyond those that settle the level of each press; with none the scatter stays as it was.
    memory : float or None
        Of the force's noise, where it is known.
    """
    model = fit.model
    predicted = model.predicted(fit.vector, fit.nuisance)
    errors = [one.data.force - force for one, force in zip(model.trials, predicted, strict=True)]
    counts = [one.count for one in model.trials]
    memory, deviations = restricted_noise(errors, counts, model.force_columns(fit.vector, fit.nuisance), memory)
    white = tuple(whitener(count, memory) for count in counts)
    noise = np.where(np.isnan(deviations), model.noise, np.maximum(deviations, 1e-9))
    scatter = model.gain_deviation if freedom < 1 else _scatter(fit, freedom)
    films = _film_noise(model, fit.vector, fit.nuisance)
    return replace(model, white=white, noise=noise, gain_deviation=scatter, film_noise=films), memory


def _film_noise(model: LayerModel, vector: Array, nuisance: Array) -> tuple[FilmNoise | None, ...]:
    """Noise of the rings of markers: a memory for all films, a size for each ring of each."""
    moved = model.moved(vector, nuisance)
    left = [
        None if m is None or t.film is None else t.film.moved - m for t, m in zip(model.trials, moved, strict=False)
    ]
    films = [
        (one, trial.film.count)
        for one, trial in zip(left, model.trials, strict=False)
        if one is not None and trial.film
    ]
    if not films:
        return model.film_noise
    rings = [ring for one, _ in films for ring in one.T]
    counts = [count for one, count in films for _ in one.T]
    memory, deviations = restricted_noise(rings, counts, [np.ones((ring.size, 1)) for ring in rings])
    deviations = np.fmax(deviations, LEAST_FILM_NOISE).reshape(len(films), -1)
    found = iter(FilmNoise(whitener(films[k][1], memory), each) for k, each in enumerate(deviations))
    return tuple(None if one is None else next(found) for one in left)


def _scatter(fit: TrialsFit[LayerModel], freedom: int) -> float:
    """Standard deviation of the trials' gains: a step of expectation and maximisation, with the trials' freedom."""
    weight = np.diag(fit.model.trial_precision)
    left = [np.linalg.pinv(n.T @ n + weight)[GAIN, GAIN] for n in fit.columns.nuisance]
    total = float(np.sum(fit.nuisance[:, GAIN] ** 2) + np.sum(left))
    return max(float(np.sqrt(total / freedom)), LEAST_SCATTER)
