"""A model of a session: the base with some effects, its parameters as a vector, and its fit to every trial."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery import criteria
from benchmark.discovery.base.base_shape import Shape, ShapedTable
from benchmark.discovery.base.setup_priors import farthest, is_setup, shares
from benchmark.discovery.base.trial_bounds import trial_bounds
from benchmark.discovery.base.trials_problem import OWN, TrialsProblem
from benchmark.discovery.trials.marker_layout import PLACED
from benchmark.physics import Effect, EffectParameter, Readings, catalogue
from benchmark.physics.effect import TableTerm, Values
from benchmark.physics.setup_entry import setup_key
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import Search, TrialsFit, least_squares, trial_blocks
from benchmark.response.least_squares import settled as settled_nuisances
from benchmark.response.pipeline import TrialPipeline
from benchmark.response.trials_model import TrialColumns, TrialsEvaluation

SHAPE_STEP = 1e-3
"""By which the base's nuisances are changed to differentiate."""
FIXED = 1e-6
"""Standard deviation of what does not differ between trials."""
MOST = 12
"""Steps of a fit at most."""
FINER = 1e-3
"""Of the steps by which a fit differentiates, those by which it is told what the data determine. By the fit's own a row
that leaves contact counts with one of two parameters that act together and not with the other, which seems to part
them; at this share no derivative of the catalogue's effects changes by 1e-4 of itself when it is ten times as fine.
"""
JUMP = 2.0
"""Times as large as by the usual step a fine derivative is where what it is of jumps, as a pull's force off none."""


@dataclass(frozen=True, eq=False)
class White:
    """Residual vectors of a problem, whitened and flattened: one array a trial."""

    problem: TrialsProblem

    @cached_property
    def _whiteners(self) -> list[tuple[Array, NDArray[np.int64], Array]]:
        """(n, C) of each trial: what share of a row before is taken off, its place, and the weight of the rest.

        Places are in the flattened rows.
        """
        out = []
        for index, trial in enumerate(self.problem.trials):
            use = self.problem.whiteners(index)
            weight = 1.0 / np.column_stack([one.scale for one in use])
            if self.problem.mask is not None:
                weight = weight * self.problem.mask[trial.condition]
            before = np.column_stack([one.before for one in use]) * len(use) + np.arange(len(use))
            out.append((np.column_stack([one.back for one in use]), before, weight))
        return out

    def flat(self, index: int, rows: Array) -> Array:
        """Rows (n, C) of a trial whitened, masked and flattened to (N,)."""
        back, before, weight = self._whiteners[index]
        return np.asarray(((rows - back * rows.take(before)) * weight).ravel())

    def residuals(self, signals: list[Array]) -> list[Array]:
        """White residuals, measured minus simulated."""
        return [self.flat(i, trial.signals - signals[i]) for i, trial in enumerate(self.problem.trials)]


@dataclass(frozen=True, eq=False)
class EffectModel:
    """Base and effects for a problem; a `benchmark.response.trials_model.TrialsModel`.

    The vector is the shape nuisances of the base, then each effect's parameters; logarithmic ones by their logarithm.
    `pinned` nuisances stay at their values.
    """

    problem: TrialsProblem
    effects: tuple[Effect, ...]
    pinned: tuple[tuple[str, float], ...] = ()

    @cached_property
    def pipelines(self) -> tuple[TrialPipeline, ...]:
        """The way of a trial in each condition."""
        study = self.problem.study
        own = [replace(e, body=None, lower_face=None) if e.slug in self.tabled else e for e in self.effects]
        chosen = ordered(own, catalogue())
        return tuple(TrialPipeline(condition.around, chosen, study.distance) for condition in study.conditions)

    @cached_property
    def tabled(self) -> dict[str, TableTerm]:
        """Terms of the effects that all tables carry, by their slugs."""
        terms = {effect.slug: effect.in_table for effect in self.effects if effect.in_table is not None}
        return {slug: term for slug, term in terms.items() if all(term.key in t.added for t in self.problem.tables)}

    @cached_property
    def white(self) -> White:
        """The problem's whitening."""
        return White(self.problem)

    @cached_property
    def parameters(self) -> tuple[tuple[str, EffectParameter], ...]:
        """(slug, parameter) of the effects, in the vector's order."""
        return tuple((effect.slug, p) for effect in self.effects for p in effect.description.parameters)

    @property
    def shape_count(self) -> int:
        """Base nuisances, which come first."""
        return len(self.problem.shapes)

    @property
    def size(self) -> int:
        """Length of the vector."""
        return self.shape_count + len(self.parameters)

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of the vector."""
        held = dict(self.pinned)
        reach = [farthest(name) for name in self.problem.shapes]
        shapes = [(held.get(n, -far), held.get(n, far)) for n, far in zip(self.problem.shapes, reach, strict=True)]
        low = [low for low, _ in shapes] + [_inner(p, p.low) for _, p in self.parameters]
        high = [high for _, high in shapes] + [_inner(p, p.high) for _, p in self.parameters]
        return np.array(low), np.array(high)

    def prior(self, start: Array) -> tuple[Array, Array]:
        """Mean and precision (p,) of the priors; logarithmic parameters round their start."""
        mean, precision = np.zeros(self.size), np.zeros(self.size)
        mean[: self.shape_count] = [self.problem.shape_means.get(name, 0.0) for name in self.problem.shapes]
        precision[: self.shape_count] = np.array(list(self.problem.shape_priors.values())) ** -2.0
        for k, (_, parameter) in enumerate(self.parameters, start=self.shape_count):
            if parameter.logarithmic:
                mean[k], precision[k] = start[k], criteria.LOG_PRIOR**-2
            else:
                precision[k] = (parameter.high - parameter.low) ** -2
                mean[k] = start[k]
        return mean, precision

    def vector(self, shape: Array, values: Mapping[str, Values]) -> Array:
        """The vector of shape nuisances (s,) and the effects' values."""
        inner = [_inner(p, values[slug][p.name]) for slug, p in self.parameters]
        return np.concatenate([shape, inner])

    def shape(self, vector: Array) -> Shape:
        """The base's shape."""
        values = dict(zip(self.problem.shapes, vector.tolist(), strict=False))
        for k, (slug, _) in enumerate(self.parameters, start=self.shape_count):
            key = setup_key(slug)
            if key is not None:
                values[key] = values.get(key, 0.0) + float(vector[k])
        moduli = self.problem.moduli
        common = values[moduli[0]] if moduli else 0.0
        values |= {key: values[key] - common for key in moduli} | {"modulus": values["modulus"] + common}
        forms = {name: value for name, value in values.items() if not is_setup(name)}
        own = self.values(vector) if self.tabled else {}
        added = {t.key: (own[slug][t.amount], own[slug][t.part]) for slug, t in self.tabled.items()}
        return Shape(setup=shares(values), added=added, **forms)

    def values(self, vector: Array) -> dict[str, dict[str, float]]:
        """Values of each effect's parameters, in SI."""
        out: dict[str, dict[str, float]] = {effect.slug: {} for effect in self.effects}
        for k, (slug, p) in enumerate(self.parameters, start=self.shape_count):
            raw = float(np.exp(vector[k]) if p.logarithmic else vector[k])
            out[slug][p.name] = min(max(raw, p.low), p.high)
        return out

    def shaped(self, vector: Array) -> tuple[ShapedTable, ...]:
        """The table of each condition with the vector's shape."""
        shape, study = self.shape(vector), self.problem.study
        return tuple(
            ShapedTable(table, shape, condition.around.peak_depth)
            for table, condition in zip(self.problem.tables, study.conditions, strict=True)
        )

    def signals(self, vector: Array, nuisance: Array) -> list[Array]:
        """(n, C) signals of each trial.

        Parameters
        ----------
        vector
            (p,) of the model.
        nuisance
            (trials, q): log gain, force zero, time shift, depth at touch, thickness, marker zeros.
        """
        tables, values = self.shaped(vector), self.values(vector)
        out: list[Array] = [np.zeros(0)] * len(nuisance)
        for number, places in self._places.items():
            own = nuisance[places, : len(OWN)].tolist()
            elastics = [tables[number].thicker(thickness) for *_, thickness in own]
            motions = [self.problem.trials[index].motion for index in places]
            ways = [(float(np.exp(gain)), shift, height) for gain, _, shift, height, _ in own]
            readings = self.pipelines[number].of_several(elastics, values, motions, ways)
            scaled = self._grid_seen(tables[number].shape)
            for index, each in zip(places, readings, strict=True):
                signals = self.as_signals(each, nuisance[index, 1], nuisance[index, len(OWN) :])
                signals[:, 1:] = self.problem.trials[index].at_frames(signals[:, 1:] + scaled)
                out[index] = signals
        return out

    @cached_property
    def _places(self) -> dict[int, list[int]]:
        """Numbers of the trials of each condition."""
        found: dict[int, list[int]] = {}
        for index, trial in enumerate(self.problem.trials):
            found.setdefault(trial.condition, []).append(index)
        return found

    def _grid_seen(self, shape: Shape) -> Array:
        """(C - 1,) or (0,) m by which the grid's scale shows in the marker combinations."""
        layout = self.problem.study.layout
        if layout is None:
            return np.zeros(0)
        return layout.seen_scale(shape.grid_scale, shape.lens) * layout.scale_pattern

    def as_signals(self, readings: Readings, zero: float, offsets: Array) -> Array:
        """(n, C): force, then marker combinations, with their zeros."""
        layout = self.problem.study.layout
        force = readings.force[:, None] + zero
        if layout is None or readings.markers is None:
            return force
        markers = layout.signals(readings.markers)
        markers[:, layout.zero_columns] += offsets
        return np.concatenate([force, markers], axis=1)

    @cached_property
    def trial_precision(self) -> Array:
        """(q,) prior precisions of a trial's nuisances."""
        return nuisance_precision(self.problem)

    @cached_property
    def trial_bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds (R, q) of the trials' nuisances."""
        return trial_bounds(self.problem)

    def evaluated(self, vector: Array, nuisance: Array) -> TrialsEvaluation:
        """Signals and white residuals of all trials."""
        signals = self.signals(vector, nuisance)
        return TrialsEvaluation(vector, nuisance, signals, self.white.residuals(signals))

    def columns(self, at: TrialsEvaluation, warm: TrialColumns | None = None, share: float = 1.0) -> TrialColumns:
        """Derivatives by differences; `warm` lends those by the base's nuisances and the trials'.

        `share` of the usual steps is taken for the effects' parameters.
        """
        first = 0 if warm is None else self.shape_count
        changes = [self._change(at, k, share if k >= self.shape_count else 1.0) for k in range(first, self.size)]
        count = len(at.signals)
        own = [np.column_stack([c[i] for c in changes]) if changes else np.zeros((0, 0)) for i in range(count)]
        if warm is None:
            return TrialColumns(own, self.nuisance_columns(at))
        shapes = [columns[:, : self.shape_count] for columns in warm.vector]
        return TrialColumns(
            [np.hstack([s, o]) if o.size else s for s, o in zip(shapes, own, strict=True)], warm.nuisance
        )

    def _change(self, at: TrialsEvaluation, k: int, share: float) -> list[Array]:
        """White derivative of each trial by one number of the vector, by a share of its usual step."""
        step = share * self._step(at.vector, k)
        moved = at.vector.copy()
        moved[k] += step
        changed = self.signals(moved, at.nuisance)
        return [self.white.flat(i, (changed[i] - signals) / step) for i, signals in enumerate(at.signals)]

    def _step(self, vector: Array, k: int) -> float:
        if k < self.shape_count:
            return SHAPE_STEP
        _, p = self.parameters[k - self.shape_count]
        size = 0.02 if p.logarithmic else max(0.02 * abs(vector[k]), 1e-5 * (p.high - p.low))
        return size if vector[k] + size <= self.bounds[1][k] else -size

    def nuisance_columns(self, at: TrialsEvaluation) -> list[Array]:
        """White derivatives (N, q) of each trial by its nuisances."""
        study = self.problem.study
        steps = self._nuisance_steps
        moved = {}
        for k, step in steps.items():
            other = at.nuisance.copy()
            other[:, k] += step
            moved[k] = self.signals(at.vector, other)
        out = []
        for i, base in enumerate(at.signals):
            columns = np.zeros((*base.shape, at.nuisance.shape[1]))
            columns[:, 0, 1] = 1.0
            for k, step in steps.items():
                columns[..., k] = (moved[k][i] - base) / step
            if study.layout is not None:
                for k, place in enumerate(study.layout.zero_columns, start=len(OWN)):
                    columns[:, 1 + place, k] = 1.0
            out.append(np.column_stack([self.white.flat(i, columns[..., k]) for k in range(columns.shape[2])]))
        return out

    @cached_property
    def _nuisance_steps(self) -> Mapping[int, float]:
        """By which log gain, time shift, depth at touch and thickness are changed to differentiate."""
        study = self.problem.study
        deepest = max(condition.around.peak_depth for condition in study.conditions)
        steps = {0: 0.01, 2: max(0.2 * study.raw_interval, 1e-3), 3: 1e-3 * deepest}
        return steps | ({OWN.index("thickness"): SHAPE_STEP} if self.problem.prior.thickness else {})


Fit: TypeAlias = TrialsFit[EffectModel]
"""A model fitted to the trials of its problem."""
FINE: WeakKeyDictionary[Fit, Fit] = WeakKeyDictionary()
"""Fits with fine derivatives, by those as they came."""


def fit(
    model: EffectModel, start: Array, nuisance: Array | None = None, warm: TrialColumns | None = None, most: int = MOST
) -> Fit:
    """Fit a model from a start.

    Parameters
    ----------
    model
        What is fitted.
    start
        (p,) vector; logarithmic parameters have their priors round it.
    nuisance
        (R, q) start of the trials' nuisances; zeros by default.
    warm
        Derivatives of the base near the start, whose columns serve for the first steps.
    most
        Steps at most.
    """
    problem = model.problem
    state = np.zeros((len(problem.trials), nuisance_count(problem))) if nuisance is None else nuisance
    return least_squares(model, start, state, warm=warm, search=Search(most))


def finely(fitted: Fit) -> Fit:
    """A fit as it stands, with derivatives by its effects' parameters that are fine enough for what they determine."""
    if not fitted.model.effects:
        return fitted
    if fitted not in FINE:
        at = fitted.model.evaluated(fitted.vector, fitted.nuisance)
        columns = without_jumps(fitted.model.columns(at, fitted.columns, FINER), fitted.columns)
        FINE[fitted] = replace(fitted, columns=columns, blocks=trial_blocks(fitted.model, columns, at))
    return FINE[fitted]


def without_jumps(fine: TrialColumns, usual: TrialColumns) -> TrialColumns:
    """Fine derivatives, but for the usual ones where a jump over the fine step would tell a number to nothing."""
    sizes = [np.sqrt(np.sum([(each**2).sum(axis=0) for each in some.vector], axis=0)) for some in (fine, usual)]
    jumps = sizes[0] > JUMP * sizes[1]
    pairs = zip(fine.vector, usual.vector, strict=True)
    return TrialColumns([np.where(jumps, by_usual, by_fine) for by_fine, by_usual in pairs], fine.nuisance)


def settled(model: EffectModel, vector: Array, nuisance: Array) -> Array:
    """(R, q) nuisances of the trials, all their rows counted, at a vector that stays."""
    if model.problem.mask is not None:
        model = EffectModel(replace(model.problem, mask=None), model.effects)
    return settled_nuisances(model, vector, nuisance)


def ordered(effects: Sequence[Effect], catalogue: Sequence[Effect]) -> tuple[Effect, ...]:
    """Effects in the order of the catalogue, own ones last."""
    slugs = [effect.slug for effect in catalogue]
    return tuple(sorted(effects, key=lambda each: slugs.index(each.slug) if each.slug in slugs else len(slugs)))


def _inner(parameter: EffectParameter, value: float) -> float:
    if not parameter.logarithmic:
        return float(value)
    return float(np.log(max(value, parameter.low, 1e-300)))


def nuisance_count(problem: TrialsProblem) -> int:
    """Nuisances of a trial: those of `OWN`, and the marker zeros."""
    return len(OWN) + len(problem.zeros)


def nuisance_precision(problem: TrialsProblem) -> Array:
    """(q,) prior precisions of a trial's nuisances."""
    prior = problem.prior
    sizes = [getattr(prior, name) or FIXED for name in OWN]
    sizes += [prior.offset if name in PLACED else prior.rest for name in problem.zeros]
    return np.array(sizes) ** -2.0
