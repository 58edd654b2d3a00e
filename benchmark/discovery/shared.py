"""What all trials share beyond a model: the misfit of their mean, less what their scatter accounts for."""

from __future__ import annotations

import numpy as np

from benchmark.discovery.fit import Fit, White


def shared_misfit(fitted: Fit) -> float:
    """Squared norm of the whitened mean residual, in standard errors, above its expectation from replicates.

    Each condition gives R |mean|^2 less the sum of its variances over trials; a condition without replicates gives its
    rows' number in the place of the variances.
    """
    problem = fitted.model.problem
    residuals = White(problem).residuals(fitted.model.signals(fitted.vector, fitted.nuisance))
    groups = np.array([trial.condition for trial in problem.trials])
    total = 0.0
    for number in np.unique(groups):
        rows = np.array([residuals[i] for i in np.flatnonzero(groups == number)])
        floor = rows.var(axis=0, ddof=1).sum() if len(rows) > 1 else float(rows.shape[1])
        total += len(rows) * float(np.sum(rows.mean(axis=0) ** 2)) - float(floor)
    return total


def share_left(before: Fit, after: Fit) -> float:
    """Share of the misfit that trials share which a model with effects surely leaves of the one without; 0 to 1.

    What is left is taken one standard deviation lower than it was found, as if of as many free numbers as rows.
    """
    opened, problem = shared_misfit(before), after.model.problem
    rows = sum(condition.signals[0].size for condition in problem.study.conditions)
    sure = shared_misfit(after) - np.sqrt(2.0 * rows)
    return float(np.clip(sure / opened, 0.0, 1.0)) if opened > 0.0 else 0.0
