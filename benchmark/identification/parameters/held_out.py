"""How the other trials predict a condition: refits without it on the surrogates at hand, and bands of predictions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmark.identification.parameters.layer_fit import SEARCH, LayerFit
from benchmark.identification.parameters.layer_model import GAIN, LayerModel
from benchmark.identification.pooling import fold_between
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import least_squares, settled


@dataclass(frozen=True, eq=False)
class HeldOut:
    """A condition predicted from the others, each trial with its own touch and zero.

    Attributes
    ----------
    condition : str
    trials : int
    rms_percent : float
        Root mean square of measured minus predicted, in % of the peak.
    trial_rms_percent : tuple of float
        The same of each trial.
    covered : float
        Share of the trials whose force at the peak lies in the 95 % band of one more trial.
    gains : tuple of float
        Logarithm of each trial's force over the model's in the fit of all conditions together.
    """

    condition: str
    trials: int
    rms_percent: float
    covered: float
    trial_rms_percent: tuple[float, ...] = ()
    gains: tuple[float, ...] = ()

    @property
    def over_model(self) -> float:
        """The trials' force over the model's in the fit of all conditions together, their geometric mean."""
        return math.exp(math.fsum(self.gains) / max(len(self.gains), 1))

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`."""
        own = {key: value for key, value in vars(self).items() if key != "gains"}
        return {**own, "trial_rms_percent": list(self.trial_rms_percent), "force_over_model": self.over_model}


def contradiction(held: Sequence[HeldOut]) -> str:
    """How conditions contradict each other under one law, in words; "" where the law follows them all.

    They do where the forces of their trials stand beside those of the fitted model by `pooling.APART`, and by more than
    trials of one condition scatter.
    """
    fold = fold_between([one.gains for one in held])
    if fold is None:
        return ""
    stand = ", ".join(f"{one.condition} {one.over_model:.3g}" for one in held[:4])
    errors = ", ".join(f"{one.condition} to {one.rms_percent:.3g} %" for one in held[:4])
    return (
        f"one law does not follow all conditions: their forces over the fitted model's are {stand}; each predicted "
        f"from the others: {errors} of the peak"
    )


def held_out(found: LayerFit, groups: Sequence[str]) -> tuple[HeldOut, ...]:
    """Predict each group of trials from the others; none where there is but one group.

    Parameters
    ----------
    found : LayerFit
    groups : sequence of str
        The group (condition, tool) of each trial.
    """
    names = list(dict.fromkeys(groups))
    if len(names) < 2:
        return ()
    return tuple(_predicted(found, np.array([each == name for each in groups]), name) for name in names)


def _predicted(found: LayerFit, out: Array, name: str) -> HeldOut:
    others = subset(found.model, np.flatnonzero(~out.astype(bool)))
    fit = least_squares(others, found.vector, found.fit.nuisance[~out.astype(bool)], search=SEARCH)
    held = subset(found.model, np.flatnonzero(out))
    start = found.fit.nuisance[out.astype(bool)].copy()
    start[:, GAIN] = 0.0
    nuisance = settled(_without_gain(held), fit.vector, start)
    predicted = held.predicted(fit.vector, nuisance)
    squares, inside = [], 0
    for k, (trial, force) in enumerate(zip(held.trials, predicted, strict=True)):
        pressing = force - nuisance[k, 1]
        peak = int(np.argmax(pressing))
        squares.append(float(np.mean((trial.data.force - force) ** 2)) / max(float(pressing[peak]), 1e-12) ** 2)
        slope = peak_sensitivity(held, k, fit.vector, nuisance)
        variance = slope @ fit.covariance @ slope + held.gain_deviation**2
        variance += (held.noise[k] / max(float(pressing[peak]), 1e-12)) ** 2
        error = (trial.data.force[peak] - force[peak]) / max(float(pressing[peak]), 1e-12)
        inside += int(abs(error) <= found.quantile * np.sqrt(variance))
    roots = tuple(100.0 * float(np.sqrt(each)) for each in squares)
    gains = tuple(found.fit.nuisance[out.astype(bool), GAIN].tolist())
    whole = 100.0 * float(np.sqrt(np.mean(squares)))
    return HeldOut(name, len(held.trials), whole, inside / len(held.trials), roots, gains)


def subset(model: LayerModel, kept: NDArray[np.int64]) -> LayerModel:
    """The model of some of its trials."""
    return replace(
        model,
        trials=tuple(model.trials[k] for k in kept),
        white=tuple(model.white[k] for k in kept),
        noise=model.noise[kept],
        film_noise=tuple(model.film_noise[k] for k in kept) if model.film_noise else (),
    )


def _without_gain(model: LayerModel) -> LayerModel:
    """The model whose trials have no gain of their own to speak of."""
    return replace(model, gain_deviation=1e-6)


def peak_sensitivity(model: LayerModel, k: int, vector: Array, nuisance: Array) -> Array:
    """(p,) derivatives of the logarithm of one trial's largest force by the coordinates."""
    step = 1e-4
    base = model.predicted(vector, nuisance)[k] - nuisance[k, 1]
    peak, out = int(np.argmax(base)), np.zeros(vector.size)
    for index in range(vector.size):
        moved = vector.copy()
        moved[index] += step
        force = subset(model, np.array([k])).predicted(moved, nuisance[k : k + 1])[0] - nuisance[k, 1]
        out[index] = (force[peak] - base[peak]) / (step * max(float(base[peak]), 1e-12))
    return out


def prediction_bands(found: LayerFit) -> list[tuple[Array, Array]]:
    """Lower and upper end (n,) N of the 95 % band of each trial's force: parameters, gain and noise."""
    bands = []
    forces = found.predicted
    for k, force in enumerate(forces):
        slope = peak_sensitivity(found.model, k, found.vector, found.fit.nuisance)
        pressing = force - found.fit.nuisance[k, 1]
        share = float(slope @ found.fit.covariance @ slope) + found.model.gain_deviation**2
        half = found.quantile * np.sqrt(share * pressing**2 + found.model.noise[k] ** 2)
        gain = np.exp(found.fit.nuisance[k, GAIN])
        centre = found.fit.nuisance[k, 1] + pressing / gain
        bands.append((np.asarray(centre - half), np.asarray(centre + half)))
    return bands
