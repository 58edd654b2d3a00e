"""The posterior of a fit's coordinates by an ensemble of walkers, with the diagnostics that say whether to trust it.

emcee draws (Foreman-Mackey et al. 2013, PASP 125:306); it is optional (`pip install tissuebench[posterior]`). Touch,
zero and gain of each trial are integrated out to second order round the fit. R-hat is that of split chains (Gelman et
al., Bayesian Data Analysis, third edition, 11.4), the walkers being the chains.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmark.errors import InputError
from benchmark.identification.parameters.layer_fit import LayerFit
from benchmark.response.force_curve import Array

WALKERS, STEPS, BURNT = 40, 3000, 600
"""Walkers, and steps of each, of which the first are thrown away."""
CONVERGED = 1.05
"""R-hat up to which chains count as mixed."""


@dataclass(frozen=True, eq=False)
class Posterior:
    """Draws of the free coordinates.

    Attributes
    ----------
    draws : (s, f) array
    low, high : (f,) array
        Ends of the central 95 %.
    r_hat, effective : (f,) array
        Split R-hat, and effective sample size.
    """

    draws: Array
    low: Array
    high: Array
    r_hat: Array
    effective: Array

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
    try:
        import emcee
    except ImportError:
        raise InputError(
            "--posterior draws with emcee, which is not installed; pip install emcee, or go without it"
        ) from None
    random = np.random.default_rng(seed)
    spread = np.sqrt(np.maximum(np.diag(found.fit.covariance), 1e-14))
    start = found.vector + spread * random.normal(size=(WALKERS, found.vector.size)) * 0.5
    density = _Density(found)
    low, high = density.bounds
    start = np.clip(start, low + 1e-9, high - 1e-9)
    sampler = emcee.EnsembleSampler(WALKERS, found.vector.size, density)
    sampler.random_state = np.random.RandomState(seed).get_state()
    sampler.run_mcmc(start, STEPS)
    free = list(found.problem.free)
    chains = sampler.get_chain(discard=BURNT)[:, :, free]
    times = sampler.get_autocorr_time(discard=BURNT, quiet=True)[free]
    draws = chains.reshape(-1, len(free))
    ends = np.quantile(draws, [0.025, 0.975], axis=0)
    return Posterior(draws, ends[0], ends[1], split_r_hat(chains), draws.shape[0] / np.maximum(times, 1.0))


def split_r_hat(chains: Array) -> Array:
    """(f,) of chains (n, c, f): between and within the halves of each."""
    half = chains.shape[0] // 2
    parts = np.concatenate([chains[:half], chains[half : 2 * half]], axis=1)
    within = parts.var(axis=0, ddof=1).mean(axis=0)
    between = half * parts.mean(axis=0).var(axis=0, ddof=1)
    return np.asarray(np.sqrt(((half - 1) / half * within + between / half) / within))


class _Density:
    """Log posterior density of coordinates (p,), the trials' nuisances integrated out round the fit."""

    def __init__(self, found: LayerFit):
        self._model, self._nuisance = found.model, found.fit.nuisance
        weight = np.diag(found.model.trial_precision)
        self._solves = [np.linalg.solve(n.T @ n + weight, n.T) for n in found.fit.columns.nuisance]
        self._columns = found.fit.columns.nuisance
        ends = [one.limits for one in found.problem.parameters]
        ends += [(-0.1, 0.1)] * (found.vector.size - len(ends))
        self.bounds = tuple(np.array(ends).T)
        self._weight = found.model.trial_precision

    def __call__(self, vector: Array) -> float:
        if (vector < self.bounds[0]).any() or (vector > self.bounds[1]).any():
            return -np.inf
        model = self._model
        at = model.evaluated(vector, self._nuisance)
        total = float(np.sum(model.prior_precision * (vector - model.prior_mean) ** 2))
        for residual, columns, solve, own in zip(
            at.residuals, self._columns, self._solves, self._nuisance, strict=True
        ):
            free = residual + columns @ own
            best = solve @ free
            left = free - columns @ best
            total += float(left @ left) + float(np.sum(self._weight * best**2))
        return -0.5 * total if np.isfinite(total) else -np.inf
