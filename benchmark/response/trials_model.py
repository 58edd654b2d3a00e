"""What the engine of least squares fits: a model of many trials, or of one record."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from benchmark.response.force_curve import Array


@dataclass(frozen=True, eq=False)
class TrialColumns:
    """White derivatives of each trial's prediction: by the vector (N, p) and by the trial's nuisances (N, q)."""

    vector: list[Array]
    nuisance: list[Array]

    def only(self, trials: Iterable[int]) -> TrialColumns:
        """Those of some trials, by their numbers."""
        pairs = [(self.vector[index], self.nuisance[index]) for index in trials]
        return TrialColumns([vector for vector, _ in pairs], [nuisance for _, nuisance in pairs])


@dataclass(frozen=True, eq=False)
class TrialsEvaluation:
    """A model at a vector (p,) and nuisances (R, q): its signals and the white residuals (N,) of each trial.

    Residuals are measured minus predicted; what signals are is the model's own affair.
    """

    vector: Array
    nuisance: Array
    signals: list[Array]
    residuals: list[Array]


class TrialsModel(Protocol):
    """What is fitted to R trials: a vector (p,), and q nuisances of each trial with priors round zero."""

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds (p,) of the vector."""
        ...

    @property
    def trial_precision(self) -> Array:
        """(q,) prior precisions of a trial's nuisances; 0 for none."""
        ...

    @property
    def trial_bounds(self) -> tuple[Array, Array] | None:
        """Lower and upper bounds (R, q) of the nuisances; None where there are none."""
        ...

    def prior(self, start: Array) -> tuple[Array, Array]:
        """Mean and precision (p,) of the priors of a fit that begins at a vector."""
        ...

    def evaluated(self, vector: Array, nuisance: Array) -> TrialsEvaluation:
        """Signals and white residuals of all trials."""
        ...

    def columns(self, at: TrialsEvaluation, warm: TrialColumns | None = None) -> TrialColumns:
        """Derivatives of all trials; some may be lent by those of a start nearby (`warm`)."""
        ...

    def nuisance_columns(self, at: TrialsEvaluation) -> list[Array]:
        """Those by the nuisances alone."""
        ...


@dataclass(frozen=True, eq=False)
class RecordModel:
    """One record fitted by a vector (p,) alone, without nuisances and priors.

    Attributes
    ----------
    residual : (p,) -> (n,)
        Measured minus predicted.
    derivative : (p,) -> (n, p)
        Of the prediction.
    bounds : (p,) and (p,) array
        Equal ones fix a parameter.
    """

    residual: Callable[[Array], Array]
    derivative: Callable[[Array], Array]
    bounds: tuple[Array, Array]

    @property
    def trial_precision(self) -> Array:
        """No nuisance has a prior."""
        return np.zeros(0)

    @property
    def trial_bounds(self) -> None:
        """Nor bounds."""

    def prior(self, start: Array) -> tuple[Array, Array]:
        """No priors."""
        return np.zeros_like(start), np.zeros_like(start)

    def evaluated(self, vector: Array, nuisance: Array) -> TrialsEvaluation:
        """The record's residual."""
        return TrialsEvaluation(vector, nuisance, [], [self.residual(vector)])

    def columns(self, at: TrialsEvaluation, warm: TrialColumns | None = None) -> TrialColumns:  # noqa: ARG002
        """The record's derivative; nothing is lent."""
        return TrialColumns([self.derivative(at.vector)], self.nuisance_columns(at))

    def nuisance_columns(self, at: TrialsEvaluation) -> list[Array]:
        """None."""
        return [np.zeros((at.residuals[0].size, 0))]


def differences(residual: Callable[[Array], Array], vector: Array, step: float, bounds: tuple[Array, Array]) -> Array:
    """(n, p) derivatives of a prediction from its residuals, measured minus predicted: central, one-sided at bounds.

    A parameter whose bounds are equal has none.
    """
    columns: list[Array | None] = []
    for k in range(vector.size):
        less, more = vector.copy(), vector.copy()
        less[k], more[k] = max(vector[k] - step, bounds[0][k]), min(vector[k] + step, bounds[1][k])
        wide = more[k] - less[k]
        columns.append((residual(less) - residual(more)) / wide if wide > 0.0 else None)
    known = next((each for each in columns if each is not None), np.zeros(0))
    return np.stack([np.zeros_like(known) if each is None else each for each in columns], axis=1)
