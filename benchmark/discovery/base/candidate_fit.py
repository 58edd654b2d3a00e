"""Fitting one candidate: starts screened by one step each, the promising one refined."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import EffectModel, Fit, White, nuisance_precision
from benchmark.discovery.base.trials_problem import TrialsProblem
from benchmark.physics import Effect
from benchmark.physics.effect import Values
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import Descent, Search, descend, least_squares

GOING_ON = Search(most=40)
"""Of the best start's fit, where its first steps did not end it."""
LEAST, MOST = 1e-5, 10.0
"""A screened start's amplitude is scaled within this range."""


def fit_candidate(base: Fit, effect: Effect, most: int = 10) -> Fit:
    """Fit `base` with one more effect.

    Parameters
    ----------
    base
        EffectModel fitted without it.
    effect
        To add.
    most
        Steps from each start; the best one goes on until it has converged.
    """
    model = EffectModel(base.model.problem, (*base.model.effects, effect))
    ended: list[Descent[EffectModel]] = []
    for state in (base.nuisance, *_unshifted(base)):
        starts = screened(base, model, effect, state)
        close = [
            one.vector
            for one in starts[: criteria.STARTS]
            if one.won > criteria.SECOND_START * starts[0].won or one is starts[0]
        ]
        warm = base.columns if state is base.nuisance else None
        ended += [descend(model, start, state, warm=warm, search=Search(most)) for start in close]
    return _gone_on(min(ended, key=lambda each: each.objective))


def _gone_on(ended: Descent[EffectModel]) -> Fit:
    """The fit to convergence, round the same priors: what an unfinished one leaves would be laid to something else."""
    if ended.converged:
        return ended.finished()
    return least_squares(ended.model, ended.at.vector, ended.at.nuisance, search=GOING_ON, around=ended.prior_mean)


def _unshifted(base: Fit) -> tuple[Array, ...]:
    """The trials' nuisances (R, q) with all trials of a condition on time; none where they are so anyway.

    What lags behind the motion looks like a late sensor; from a base that took it for one no step leads to the effect.
    """
    groups = np.array([trial.condition for trial in base.model.problem.trials])
    state, late = base.nuisance.copy(), False
    for number in np.unique(groups):
        shift = base.nuisance[groups == number, 2]
        late |= abs(shift.mean()) > criteria.LATE * max(float(shift.std()), base.model.problem.study.raw_interval)
        state[groups == number, 2] -= shift.mean()
    return (state,) if late else ()


@dataclass(frozen=True, eq=False)
class CandidateStart:
    """A start (p,) of the vector, what one step would gain from it, and the residual along it in each trial (R,)."""

    won: float
    vector: Array
    along: Array


def screened(base: Fit, model: EffectModel, effect: Effect, nuisance: Array | None = None) -> list[CandidateStart]:
    """Starts with what one step would gain from them, best first, at the trials' nuisances or at others (R, q).

    A start that the step makes smaller is too far off, and what it moves is bent: what a large offset of the depth
    moves is not along what the trials' own touches would take up of it. The step is then taken anew from smaller ones.
    """
    state = base.nuisance if nuisance is None else nuisance
    screen = _Screen(base, model, effect, state)
    ranked: list[CandidateStart] = []
    for values in _starts(base.model.problem, effect):
        found, scale = screen.step(values, MOST)
        for share in criteria.SMALLER_STARTS if 0.0 < scale < 1.0 else ():
            smaller = _resized(effect, values, share)
            if smaller != values:  # an amplitude by its logarithm has no smaller start
                found = max(found, screen.step(smaller, 1.0 / share)[0], key=lambda each: each.won)
        if scale > 0.0:
            ranked.append(found)
    ranked.sort(key=lambda each: -each.won)
    if not ranked:
        first = effect.first_values(base.model.problem.study.conditions[0].around)[0]
        return [CandidateStart(0.0, screen.vector(first), np.zeros(len(state)))]
    return ranked


class _Screen:
    """One step from a base towards an effect, off what base and nuisances (R, q) explain."""

    def __init__(self, base: Fit, model: EffectModel, effect: Effect, state: Array) -> None:
        self.base, self.model, self.effect, self.state = base, model, effect, state
        self.known = base.model.values(base.vector)
        self.plain = base.model.signals(base.vector, state)
        self.white = White(base.model.problem)
        self.residuals = self.white.residuals(self.plain)
        self.projections = _projections(base)

    def vector(self, values: Values) -> Array:
        """The base's vector with the effect at values."""
        shape = self.base.vector[: self.model.shape_count]
        return self.model.vector(shape, {**self.known, self.effect.slug: values})

    def step(self, values: Values, most: float) -> tuple[CandidateStart, float]:
        """A start at values, resized by the share that one step leaves, up to `most`, and that; 0 if nothing moves."""
        signals = self.model.signals(self.vector(values), self.state)
        moved = [self.white.flat(i, now - then) for i, (now, then) in enumerate(zip(signals, self.plain, strict=True))]
        overlaps, sizes, pull = _projected(self.base, self.state, self.projections, self.residuals, moved)
        overlap, size = float(overlaps.sum()) + pull, float(sizes.sum())
        if size <= 0.0:
            return CandidateStart(0.0, self.vector(values), np.zeros(len(self.state))), 0.0
        scale = float(np.clip(overlap / size, LEAST, most))
        won = scale * overlap - 0.5 * scale**2 * size
        along = overlaps / np.sqrt(size / len(self.plain))
        return CandidateStart(won, self.vector(_resized(self.effect, values, scale)), along), scale


def _resized(effect: Effect, values: Values, scale: float) -> dict[str, float]:
    """The values with linear amplitudes so many times as large, within their bounds."""
    changed = dict(values)
    for p in effect.description.parameters:
        if p.name in (effect.amplitude, *effect.amplitudes) and not p.logarithmic:
            changed[p.name] = float(np.clip(values[p.name] * scale, p.low, p.high))
    return changed


def _starts(problem: TrialsProblem, effect: Effect) -> list[dict[str, float]]:
    """Starts for all conditions, and with the other sign where the amplitude may have it."""
    deepest = max((c.around for c in problem.study.conditions), key=lambda around: around.peak_depth)
    quickest = min((c.around for c in problem.study.conditions), key=lambda around: around.duration)
    found: list[dict[str, float]] = []
    for around in (deepest, quickest) if deepest is not quickest else (deepest,):
        found += [dict(each) for each in effect.first_values(around) if each not in found]
    scaled = (effect.amplitude, *effect.amplitudes)
    either = {p.name for p in effect.description.parameters if p.name in scaled and p.low < 0.0 and not p.logarithmic}
    if either:
        found += [{name: -value if name in either else value for name, value in each.items()} for each in found]
    return found


def _projections(base: Fit) -> tuple[list[tuple[Array, Array, Array]], Array]:
    """For each trial its columns with the solved nuisances, and the normal matrix of the base's vector."""
    problem = base.model.problem
    weight = nuisance_precision(problem)
    parts, matrix = [], np.diag(base.precision).astype(float)
    for j, n in zip(base.columns.vector, base.columns.nuisance, strict=True):
        inner = np.asarray(np.linalg.inv(n.T @ n + np.diag(weight)))
        parts.append((j, n, inner))
        side = n.T @ j
        matrix += j.T @ j - side.T @ inner @ side
    return parts, np.asarray(matrix)


def _projected(
    base: Fit,
    state: Array,
    projections: tuple[list[tuple[Array, Array, Array]], Array],
    residuals: Sequence[Array],
    moved: Sequence[Array],
) -> tuple[Array, Array, float]:
    """Overlap (R,) of what an effect moves with the residual, and its own size (R,), off base and nuisances.

    The third is what their priors add to the overlap: a base that is bent against its priors to follow the data pulls
    towards the effect that would let it go.
    """
    parts, matrix = projections
    weight = nuisance_precision(base.model.problem)
    held = [move - n @ (inner @ (n.T @ move)) for (_, n, inner), move in zip(parts, moved, strict=True)]
    on_base = sum((j.T @ h for (j, _, _), h in zip(parts, held, strict=True)), np.zeros(len(matrix)))
    amount = np.linalg.solve(matrix, on_base)
    overlaps, sizes = [], []
    pull = float(amount @ (base.precision * (base.vector - base.prior_mean)))
    for index, (j, n, inner) in enumerate(parts):
        side = j @ amount
        rest = held[index] - (side - n @ (inner @ (n.T @ side)))
        overlaps.append(float(rest @ residuals[index]))
        sizes.append(float(rest @ moved[index]))
        pull += float((n.T @ (moved[index] - side)) @ inner @ (weight * state[index]))
    return np.array(overlaps), np.array(sizes), pull
