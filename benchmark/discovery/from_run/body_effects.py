"""Every effect of the body fitted to the loads of a run that are not held out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import t as student

from benchmark.discovery.discovery_result import Array
from benchmark.discovery.from_run.run_case import RunCase
from benchmark.physics import Effect, EffectParameter
from benchmark.response.least_squares import Search, fit_record
from benchmark.response.pipeline import physics_of
from benchmark.response.trials_model import RecordModel, differences
from wavemodel import WaveError

SEARCH = Search(most=80, gain=0.0, share=1e-10, damping=1.0)
STEP = 1e-5
"""By which a parameter of about one is changed to differentiate."""
FAILED = 1e3
"""Residual, in units of the base's, where a set of parameters has no answer."""


@dataclass(frozen=True, eq=False)
class BodyEffectFit:
    """An effect fitted.

    Attributes
    ----------
    effect : Effect
    values : mapping
        SI.
    ci95 : mapping
        Name to (low, high): from the curvature of the fit.
    rmse : float
        N, over the fitted rows.
    delta_bic : float
        Against the base, one observation a load level.
    """

    effect: Effect
    values: Mapping[str, float]
    ci95: Mapping[str, tuple[float, float]]
    rmse: float
    delta_bic: float


def fit_body_effect(effect: Effect, case: RunCase) -> BodyEffectFit | None:
    """Fit an effect from each of its starts and keep the best; None where no start has an answer."""
    measured = case.run.force
    scale = _rms((case.force() - measured)[case.fitted])
    starts = effect.first_values(case.context)
    coordinates = _Coordinates(effect.description.parameters, starts)

    def residual(u: Array) -> Array:
        try:
            force = case.force(physics_of([(effect, coordinates.values(u))], case.context))
        except WaveError:
            return np.full(int(case.fitted.sum()), FAILED)
        return np.asarray((measured - force)[case.fitted] / scale)

    bounds = coordinates.bounds
    record = RecordModel(residual, lambda u: differences(residual, u, STEP, bounds), bounds)
    found = [fit_record(record, coordinates.start(values), SEARCH) for values in starts]
    best = min(found, key=lambda each: each.objective)
    left = residual(best.vector)
    if not np.abs(left).max() < FAILED:
        return None
    levels = np.unique(np.round(measured[case.fitted], 9)).size
    bic = levels * float(np.log(max(_rms(left), 1e-12) ** 2)) + len(effect.names) * float(np.log(levels))
    interval = coordinates.interval(best.vector, best.columns.vector[0], left, levels)
    return BodyEffectFit(effect, coordinates.settled(best.vector), interval, scale * _rms(left), bic)


class _Coordinates:
    """Parameters as numbers of about one: over the size of their largest start, or logarithms."""

    def __init__(self, parameters: Sequence[EffectParameter], starts: Sequence[Mapping[str, float]]):
        self._parameters = parameters
        self._scales = np.array(
            [1.0 if p.logarithmic else max(abs(start[p.name]) for start in starts) or p.high for p in parameters]
        )

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Least and largest, (k,) each."""
        return self._of({p.name: p.low for p in self._parameters}), self._of({p.name: p.high for p in self._parameters})

    def values(self, u: Array) -> dict[str, float]:
        """SI values within their bounds."""
        return {
            p.name: float(np.clip(np.exp(x) if p.logarithmic else x, p.low, p.high))
            for p, x in zip(self._parameters, u * self._scales, strict=True)
        }

    def settled(self, u: Array) -> dict[str, float]:
        """The same for the answer: what lies at its lower bound but for the fit's step away from it is the bound."""
        near = {p.name: 1e-6 * scale for p, scale in zip(self._parameters, self._scales, strict=True)}
        lows = {p.name: p.low for p in self._parameters}
        return {
            name: lows[name] if abs(value - lows[name]) < near[name] else value
            for name, value in self.values(u).items()
        }

    def start(self, values: Mapping[str, float]) -> Array:
        """(k,) within the bounds."""
        return np.clip(self._of(values), *self.bounds)

    def interval(self, u: Array, jacobian: Array, residual: Array, levels: int) -> dict[str, tuple[float, float]]:
        """95 % by the curvature at the best point; the whole range where the fit does not feel a parameter."""
        free = max(levels - u.size, 1)
        variance = float(np.sum(residual**2)) / free
        covariance = variance * np.linalg.pinv(jacobian.T @ jacobian)
        low, high = self.bounds
        felt = np.abs(jacobian).max(axis=0) > 1e-9
        reach = np.where(felt, student.ppf(0.975, free) * np.sqrt(np.diag(covariance)), np.inf)
        ends = [self.values(np.clip(u + sign * reach, low, high)) for sign in (-1.0, 1.0)]
        return {p.name: (ends[0][p.name], ends[1][p.name]) for p in self._parameters}

    def _of(self, values: Mapping[str, float]) -> Array:
        numbers = [np.log(values[p.name]) if p.logarithmic else values[p.name] for p in self._parameters]
        return np.asarray(np.array(numbers) / self._scales)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
