"""A fit whose effects may have another form than the catalogue's: what they add may be off at each turn of the press.

An effect of the catalogue resembles the true one, and what it misses has no known shape. So each condition's force, and
the pattern that the effect makes in the markers, may be off by a share of the most that the effect adds there, with a
value of its own at each turn of the press and half way to it, linear between. What an effect adds by the depth alone,
such as a stiffening, is missed by the depth alone: the same on the way in, in a hold and on the way back. What a
sensor adds evenly with time, such as a drift, is missed as evenly: not otherwise at each turn.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import EffectModel, Fit
from benchmark.discovery.trials.study import ConditionData
from benchmark.physics import Effect
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import one_step
from benchmark.response.trials_model import TrialColumns

SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Of a condition's deepest press, or of its time, between which a form is off that goes by depth or time alone.

At touch the former is not off at all."""
FINE, ALONE = 25, 0.1
"""Places of time, linear between which an effect adds all but this share (of the norm) that goes by it alone."""
NEIGHBOURS = 4
"""Rows next to each other in depth, between which it is linear where an effect goes by that alone.

About as many as a depth is passed, so that a way in and a way back lie between the same two and are told apart; between
even places a gap's step at touch would be off.
"""
LEAST_MOVED = 1e-9
"""Standard deviations of noise: a sensor in which an effect adds less does not see it."""


@dataclass(frozen=True, eq=False)
class BentModel(EffectModel):
    """A model with `bends` amplitudes of what its effects' forms miss, behind the base's nuisances in the vector.

    `straight` is the fit with the forms as they are.
    """

    bends: int = 0
    straight: Fit | None = None

    @property
    def shape_count(self) -> int:
        """Nuisances of the base and bends, which come first."""
        return len(self.problem.shapes) + self.bends

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of the vector: none of a bend."""
        low, high = EffectModel(self.problem, self.effects, self.pinned).bounds
        return self.widened(low, -np.inf), self.widened(high, np.inf)

    def widened(self, values: Array, bend: float) -> Array:
        """Values (p - bends,) of a model without bends, with `bend` for each."""
        return np.insert(values, [len(self.problem.shapes)] * self.bends, bend)


def bent(fitted: Fit, slugs: Sequence[str]) -> Fit:
    """The fit with some of its effects' forms free to be off by `FORM_OFF`, one step from where it is.

    Parameters
    ----------
    fitted
        To convergence.
    slugs
        The effects whose forms may be off.
    """
    before, first = fitted.model, fitted.model.shape_count
    parts = [_bends(fitted, effect) for effect in before.effects if effect.slug in slugs]
    extra = [np.hstack(each) for each in zip(*parts, strict=True)]
    model = BentModel(before.problem, before.effects, before.pinned, extra[0].shape[1], fitted)
    at = model.evaluated(model.widened(fitted.vector, 0.0), fitted.nuisance)
    vector = [np.hstack([j[:, :first], e, j[:, first:]]) for j, e in zip(fitted.columns.vector, extra, strict=True)]
    mean, precision = model.widened(fitted.prior_mean, 0.0), model.widened(fitted.precision, criteria.FORM_OFF**-2)
    return one_step(model, at, TrialColumns(vector, fitted.columns.nuisance), mean, precision)


def straight(fitted: Fit) -> Fit:
    """The fit with the forms as they are, to be refitted: bends are one step, of which the model knows no more."""
    model = fitted.model
    return model.straight if isinstance(model, BentModel) and model.straight is not None else fitted


def _bends(fitted: Fit, effect: Effect) -> list[Array]:
    """White bends (N, b) of one effect in each trial: those of other conditions are zero."""
    model, problem = fitted.model, fitted.model.problem
    felt = effect.description.acts_on != "observation"
    between = _knots_of(fitted, effect)
    turns = [between(condition) for condition in problem.study.conditions]
    ends = np.cumsum([0, *(len(problem.study.names[:2]) * len(each) for each in turns)])
    out = []
    for index, (trial, added) in enumerate(zip(problem.trials, added_by(fitted, effect.slug), strict=True)):
        rows = np.zeros((added.size, ends[-1]))
        patterns = _patterns(added, problem.noise.scale[index], felt)
        shapes = [share[:, None] * pattern for pattern in patterns for share in turns[trial.condition]]
        first = ends[trial.condition]
        for place, shape in enumerate(shapes, start=first):
            rows[:, place] = model.white.flat(index, shape)
        out.append(rows)
    return out


def _patterns(added: Array, scale: Array, felt: bool) -> list[Array]:
    """(C,) by which a form may be off in force and, where there are any, markers: the most that the effect adds there.

    How much of an effect of the press is `felt` in the force is a matter of its form, too: in units of the noise it may
    be off there by as much as in the markers. What a camera sees wrongly is never in the force.
    """
    sizes = np.abs(added) / scale
    force = np.zeros(scale.size)
    force[0] = (sizes.max() if felt else sizes[:, 0].max()) * scale[0]
    if scale.size == 1:
        return [force]
    markers = added[int(np.argmax(sizes[:, 1:].max(axis=1)))].copy()
    markers[0] = 0.0
    return [force, markers if sizes[:, 1:].max() > LEAST_MOVED else np.zeros(scale.size)]


def added_by(fitted: Fit, slug: str) -> list[Array]:
    """What an effect adds to the signals (n, C) of each trial."""
    model = fitted.model
    kept = [k for k, (of, _) in enumerate(model.parameters, start=model.shape_count) if of != slug]
    less = EffectModel(model.problem, tuple(effect for effect in model.effects if effect.slug != slug))
    vector = fitted.vector[[*range(model.shape_count), *kept]]
    pairs = zip(model.signals(fitted.vector, fitted.nuisance), less.signals(vector, fitted.nuisance), strict=True)
    return [whole - rest for whole, rest in pairs]


def _knots_of(fitted: Fit, effect: Effect) -> Callable[[ConditionData], Array]:
    """Between what a form may be off: depths or times where it goes by these alone, else the turns of the press."""
    model = fitted.model
    alone = EffectModel(model.problem, (effect,))
    mine = [k for k, (slug, _) in enumerate(model.parameters, start=model.shape_count) if slug == effect.slug]
    vector = fitted.vector[[*range(len(model.problem.shapes)), *mine]]
    none = np.zeros_like(fitted.nuisance)  # a trial's own delay would part the way in from the way back
    by_itself = added_by(replace(fitted, model=alone, vector=vector, nuisance=none), effect.slug)
    trials = [
        (t.motion.read, a / s)
        for t, a, s in zip(model.problem.trials, by_itself, model.problem.noise.scale, strict=True)
    ]
    by_depth = (_goes_by(m.depth, np.sort(m.depth)[::NEIGHBOURS], added) for m, added in trials)
    if not effect.remembers and all(by_depth):
        return _between_depths
    sensor = effect.description.acts_on == "observation"
    even = sensor and all(_goes_by(m.time, np.linspace(m.time[0], m.time[-1], FINE), added) for m, added in trials)
    return _between_times if even else _between_turns


def _goes_by(what: Array, knots: Array, added: Array) -> bool:
    """Whether values (n, C) in units of their noise are functions of a number a row (n,), but for a small share."""
    weights = _hats(what, np.unique(knots)).T
    left = added - weights @ np.linalg.lstsq(weights, added, rcond=None)[0]
    return bool(np.linalg.norm(left) <= ALONE * np.linalg.norm(added))


def _between_depths(condition: ConditionData) -> Array:
    """(k, n) weights of the rows by their depth: 1 at one of `SHARES`, linear to the next; none of the touch."""
    depth = np.median(condition.depth, axis=0)
    return _hats(np.maximum(depth, 0.0), np.array(SHARES) * depth.max())[1:]


def _between_times(condition: ConditionData) -> Array:
    """(k, n) weights of the rows by their time: 1 at one of `SHARES` of a trial, linear to the next."""
    time = np.median(condition.time, axis=0)
    return _hats(time, time[0] + np.array(SHARES) * (time[-1] - time[0]))


def _hats(at: Array, knots: Array) -> Array:
    """(k, n) weights of places (n,): 1 at a knot (k,), linear to the next."""
    return np.array([np.interp(at, knots, each) for each in np.eye(knots.size)])


def _between_turns(condition: ConditionData) -> Array:
    """(k, n) weights of the rows by the turns of the press, and half way to them: 1 at one, linear to the next."""
    parts = np.column_stack([condition.phase, condition.cycle, condition.part])
    changes = np.flatnonzero((np.diff(parts, axis=0) != 0).any(axis=1)) + 1
    rows = np.arange(float(len(parts)))
    return _hats(rows, np.unique([0, *changes, rows[-1]]))
