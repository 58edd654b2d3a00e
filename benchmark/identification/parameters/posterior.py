"""The posterior of a fit's coordinates by an ensemble of walkers, with the diagnostics that say whether to trust it.

emcee draws (Foreman-Mackey et al. 2013, PASP 125:306); it is optional (`pip install tissuebench[posterior]`). Touch,
zero and gain of each trial, and the model's own error in each press, are integrated out to second order round the fit;
parameters alone and the scatter of the gains are drawn. The scatter of the gains is drawn along,
flat in its standard deviation (Gelman 2006, Bayesian Analysis 1:515): few trials do not tell it surely, and held at its
estimate the intervals would be too narrow, as a normal quantile is beside Student's. Walkers move by
differential evolution (ter Braak and Vrugt 2008, Statistics and Computing 18:435), whose steps along curved valleys are
correlated half as long as stretch moves. R-hat is that of split chains
(Gelman et al., Bayesian Data Analysis, third edition, 11.4), the walkers being the chains.
"""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

from benchmark.errors import InputError
from benchmark.identification.parameters.layer_fit import LayerFit
from benchmark.identification.parameters.layer_model import GAIN
from benchmark.response.force_curve import Array

WALKERS, STEPS, BURNT = 40, 3000, 600
"""Walkers (twice the coordinates at least), and steps of each, of which the first are thrown away."""
SCATTERS = (1e-3, 0.3)
"""Standard deviations of the gains between which it is drawn."""
HELD = (0.99, 1.01)
SCATTER_SPREAD = 0.3
"""Of the walkers' starts, in its logarithm."""
CONVERGED = 1.05
"""R-hat up to which chains count as mixed."""
LEAST_TIMES = 50.0
"""Autocorrelation times that a chain has at least, for its time to be trusted (emcee's own rule)."""


@dataclass(frozen=True, eq=False)
class Posterior:
    """Draws of the free coordinates.

    Attributes
    ----------
    chains : (n, c, f) array
        Steps, walkers, coordinates.
    low, high : (f,) array
        Ends of the central 95 %.
    r_hat, effective : (f,) array
        Split R-hat, and effective sample size.
    times : (f,) array or None
        Integrated autocorrelation times, steps; None where they were not estimated.
    """

    chains: Array
    low: Array
    high: Array
    r_hat: Array
    effective: Array
    times: Array | None = None

    @property
    def short(self) -> str:
        """That the chains are short beside their autocorrelation time; empty where they are not."""
        steps, longest = len(self.chains), 0.0 if self.times is None else float(self.times.max())
        if not LEAST_TIMES * longest > steps:
            return ""
        return (
            f"the posterior's chains of {steps} steps are shorter than {LEAST_TIMES:g} times their autocorrelation "
            f"time of {longest:.0f} steps: its intervals and effective samples are rough"
        )

    @property
    def draws(self) -> Array:
        """(n c, f) of all walkers."""
        return self.chains.reshape(-1, self.chains.shape[2])

    @property
    def converged(self) -> bool:
        """Whether all chains mixed."""
        return bool((self.r_hat <= CONVERGED).all())

    def to_dict(self, names: Sequence[str], found: LayerFit) -> dict[str, Any]:
        """Entry of `fit.json`, in the parameters' units."""
        out = {}
        for place, (name, index) in enumerate(zip(names, found.problem.free, strict=True)):
            one = found.problem.parameters[index]
            ends = sorted(one.scale * one.value(float(end[place])) for end in (self.low, self.high))
            out[name] = {
                "ci95": ends,
                "r_hat": float(self.r_hat[place]),
                "effective_samples": float(self.effective[place]),
            }
        return {"converged": self.converged, "parameters": out}


def posterior(found: LayerFit, seed: int) -> Posterior:
    """Draw from the posterior of a fit.

    Parameters
    ----------
    found : LayerFit
    seed : int
        Of the walkers.

    Raises
    ------
    InputError
        emcee is not installed.
    """
    emcee = load_emcee()
    random = np.random.default_rng(seed)
    density = _Density(found)
    count = len(found.problem.parameters)
    spread = np.append(np.sqrt(np.maximum(np.diag(found.fit.covariance)[:count], 1e-14)), SCATTER_SPREAD)
    walkers = max(WALKERS, 2 * spread.size + 2)
    start = density.start + spread * random.normal(size=(walkers, spread.size)) * 0.5
    low, high = density.bounds
    start = np.clip(start, low + 1e-9, high - 1e-9)
    moves = [(emcee.moves.DEMove(), 0.8), (emcee.moves.DESnookerMove(), 0.2)]
    sampler = emcee.EnsembleSampler(walkers, spread.size, density, moves=moves)
    sampler.random_state = np.random.RandomState(seed).get_state()
    sampler.run_mcmc(start, STEPS)
    free = list(found.problem.free)
    chains = sampler.get_chain(discard=BURNT)[:, :, free]
    times = sampler.get_autocorr_time(discard=BURNT, quiet=True, tol=0)[free]  # `Posterior.short` says it
    ends = np.quantile(chains.reshape(-1, len(free)), [0.025, 0.975], axis=0)
    count = chains.shape[0] * chains.shape[1]
    return Posterior(chains, ends[0], ends[1], split_r_hat(chains), count / np.maximum(times, 1.0), times)


def load_emcee() -> ModuleType:
    """The package that draws.

    Raises
    ------
    InputError
        It is not installed.
    """
    try:
        return importlib.import_module("emcee")
    except ImportError:
        raise InputError(
            "--posterior draws with emcee, which is not installed; pip install emcee, or go without it"
        ) from None


def split_r_hat(chains: Array) -> Array:
    """(f,) of chains (n, c, f): between and within the halves of each."""
    half = chains.shape[0] // 2
    parts = np.concatenate([chains[:half], chains[half : 2 * half]], axis=1)
    within = parts.var(axis=0, ddof=1).mean(axis=0)
    between = half * parts.mean(axis=0).var(axis=0, ddof=1)
    return np.asarray(np.sqrt(((half - 1) / half * within + between / half) / within))


class _Density:
    """Log posterior density of the parameters (p,) and the log of the gains' scatter; `start` is the fit itself.

    The trials' nuisances and the model's own error are integrated out to second order round the fit: with white columns
    N of a trial's nuisances and J of the error, whose precision is P, the error's is P + sum of J^T J - J^T N (N^T N +
    W)^-1 N^T J. A scatter that no trials told is held.
    """

    def __init__(self, found: LayerFit):
        self._model, self._nuisance, self._vector = found.model, found.fit.nuisance, found.vector
        count = len(found.problem.parameters)
        self._count, self._columns = count, found.fit.columns.nuisance
        self._errors = [one[:, count:] for one in found.fit.columns.vector]
        self._normal = np.array([one.T @ one for one in self._columns])
        self._across = np.array([one.T @ error for one, error in zip(self._columns, self._errors, strict=True)])
        self._error_normal = sum(one.T @ one for one in self._errors) + np.diag(found.model.prior_precision[count:])
        self.start = np.append(found.vector[:count], np.log(found.model.gain_deviation))
        told = SCATTERS if found.problem.freedom > 0 else found.model.gain_deviation * np.array(HELD)
        self.bounds = tuple(np.array([*(one.limits for one in found.problem.parameters), np.log(told)]).T)

    def __call__(self, coordinates: Array) -> float:
        if (coordinates < self.bounds[0]).any() or (coordinates > self.bounds[1]).any():
            return -np.inf
        model, log_scatter = self._model, float(coordinates[-1])
        unfitted = self._unfitted(coordinates[:-1])
        inner = self._normal + np.diag(model.trial_precision)
        inner[:, GAIN, GAIN] = self._normal[:, GAIN, GAIN] + np.exp(-2.0 * log_scatter)
        pulls = np.array([one.T @ each for one, each in zip(self._columns, unfitted, strict=True)])
        solved = np.linalg.solve(inner, np.concatenate([self._across, pulls[:, :, None]], axis=2))
        known = self._error_normal - np.einsum("rqi,rqj->ij", self._across, solved[:, :, :-1])
        pull = sum(one.T @ each for one, each in zip(self._errors, unfitted, strict=True))
        pull = pull - np.einsum("rqi,rq->i", self._across, solved[:, :, -1])
        misfit = sum(float(each @ each) for each in unfitted) - float(np.sum(pulls * solved[:, :, -1]))
        misfit -= float(pull @ np.linalg.solve(known, pull))
        size = float(np.linalg.slogdet(inner)[1].sum()) + 2.0 * len(unfitted) * log_scatter
        size += float(np.linalg.slogdet(known)[1])
        off = coordinates[:-1] - model.prior_mean[: self._count]
        prior = float(np.sum(model.prior_precision[: self._count] * off**2))
        density = -0.5 * (misfit + size + prior) + log_scatter
        return density if np.isfinite(density) else -np.inf

    def _unfitted(self, parameters: Array) -> list[Array]:
        """White residuals of the trials, with nuisances and the model's own error at zero."""
        vector, error = self._vector.copy(), self._vector[self._count :]
        vector[: self._count] = parameters
        rows = zip(
            self._model.evaluated(vector, self._nuisance).residuals,
            self._columns,
            self._nuisance,
            self._errors,
            strict=True,
        )
        return [residual + columns @ own + errors @ error for residual, columns, own, errors in rows]
