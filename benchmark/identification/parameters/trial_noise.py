"""The noise of trials and the scatter of their gains, from what a fit leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmark.identification.parameters.layer_model import GAIN, LayerModel
from benchmark.response.least_squares import TrialsFit
from benchmark.response.noise import fit_memory, scales, whitener

LEAST_SCATTER = 1e-3


def renoised(fit: TrialsFit[LayerModel], freedom: int) -> tuple[LayerModel, float]:
    """The model with noise (AR(1)) and scatter of gains estimated from what a fit leaves, and the noise's memory.

    Parameters
    ----------
    fit : TrialsFit of LayerModel
    freedom : int
        Trials beyond those that settle the level of each press; with none the scatter stays as it was.
    """
    model = fit.model
    predicted = model.predicted(fit.vector, fit.nuisance)
    errors = [one.data.force - force for one, force in zip(model.trials, predicted, strict=True)]
    counts = [one.count for one in model.trials]
    memory = fit_memory(errors, counts)
    white = tuple(whitener(count, memory) for count in counts)
    noise = np.maximum(scales(errors, counts, memory), 1e-9)
    scatter = model.gain_deviation if freedom < 1 else _scatter(fit, freedom)
    return replace(model, white=white, noise=noise, gain_deviation=scatter), memory


def _scatter(fit: TrialsFit[LayerModel], freedom: int) -> float:
    """Standard deviation of the trials' gains: a step of expectation and maximisation, with the trials' freedom."""
    weight = np.diag(fit.model.trial_precision)
    left = [np.linalg.pinv(n.T @ n + weight)[GAIN, GAIN] for n in fit.columns.nuisance]
    total = float(np.sum(fit.nuisance[:, GAIN] ** 2) + np.sum(left))
    return max(float(np.sqrt(total / freedom)), LEAST_SCATTER)
