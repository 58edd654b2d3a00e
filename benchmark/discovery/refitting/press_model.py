"""A session's trials by one model with effects in it: the least-squares model, and its expansion wherever a fit goes.

The engine's bends of the base are held at none. What is expanded agrees with the model where the refit stands.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from benchmark.discovery.answer.gap import CONVERGED
from benchmark.discovery.base.base_shape import Shape, ShapedTable
from benchmark.discovery.base.effect_model import EffectModel
from benchmark.discovery.base.setup_priors import is_setup
from benchmark.discovery.base.trials_problem import NoiseModel, TrialsProblem
from benchmark.discovery.discovery_result import Array
from benchmark.discovery.refitting.native_terms import NativeTerm, as_entry, moved
from benchmark.discovery.refitting.solid_press import FemSpecimen, Numbers, Specimen, agreeing
from benchmark.files import Setup
from benchmark.physics import Effect, Motion
from benchmark.physics.effect import Values
from benchmark.physics.setup_entry import PREFIX, setup_key
from benchmark.response.elastic_table import ElasticTable
from benchmark.response.least_squares import TrialsFit, least_squares
from benchmark.response.pipeline import FIRST_STEP, ForceAlone, TrialPipeline, physics_of
from benchmark.response.setup_change import CHOICES

FREE = ("modulus", "grid_scale", "tilt_x", "tilt_y", "lens", "centre_x", "centre_y")
"""Nuisances of the base that a set-up or a camera has; its bends are none. Keys of the set-up are free, too."""
MEMORY = "viscoelastic_relaxation"
PRESS_ROWS = 80
"""About as many steps has a press with a memory."""
COMPARED_FROM = 0.1
"""Of the deepest press, from which a force and its expansion are compared."""
ROUNDS, CLOSE = 6, 2e-3
"""Most rounds of a refit, and how far the model's force and its expansion may differ where it ends, relative."""


@dataclass(frozen=True, eq=False)
class PressModel(EffectModel):
    """The engine's model of a model that is expanded somewhere.

    Attributes
    ----------
    fading : mapping of int to (n,) array
        Force of each condition that is added, N at modulus factor 1: what a memory in the model changes.
    origin : mapping of str to float
        The terms' numbers where it is expanded.
    """

    fading: Mapping[int, Array] = field(default_factory=dict)
    origin: Numbers = field(default_factory=dict)

    def signals(self, vector: Array, nuisance: Array) -> list[Array]:
        """(n, C) signals of each trial; see `EffectModel.signals`."""
        out, modulus = super().signals(vector, nuisance), self.shape(vector).modulus
        for signals, trial, own in zip(out, self.problem.trials, nuisance, strict=True):
            if trial.condition in self.fading:
                signals[:, 0] += np.exp(own[0] + modulus) * self.fading[trial.condition]
        return out


PressFit: TypeAlias = TrialsFit[PressModel]


@dataclass(frozen=True)
class Stand:
    """Where a refit stands.

    Attributes
    ----------
    numbers : mapping of str to float
        Of the terms in the model, by key.
    shape : mapping of str to float
        The base's vector by name: log modulus, set-up.
    values : mapping of str to values
        Of the effects that the model has as the catalogue has them.
    """

    numbers: Numbers
    shape: Mapping[str, float]
    values: Mapping[str, Values]


@dataclass(frozen=True, eq=False)
class EffectsInModel:
    """Effects in one model.

    Attributes
    ----------
    specimen : Specimen
    terms : tuple of NativeTerm
        Which the model has in its own equations.
    effects : tuple of Effect
        The others; a relaxation has its force in the model added where `remembers`.
    remembers : bool
    """

    specimen: Specimen
    terms: tuple[NativeTerm, ...] = ()
    effects: tuple[Effect, ...] = ()
    remembers: bool = False

    def model(self, problem: TrialsProblem, stand: Stand, *, agrees: bool = True) -> PressModel:
        """The model of a problem's trials, expanded at a stand; there it `agrees` with a press, where that is asked.

        Raises
        ------
        TissuebenchError
            The model does not cover it.
        """
        changes = self._changes(problem, stand)

        def table(setup: Setup, depth: float) -> ElasticTable:
            told = self.specimen.table(setup, depth, stand.numbers)
            if not agrees:
                return told
            return agreeing(told, changes, self.specimen.pressed(setup, depth, stand.numbers, changes))

        return self._built(problem, stand, table)

    def pressed(self, problem: TrialsProblem, stand: Stand) -> PressModel:
        """The model of a problem's trials as presses give it at a stand, without derivatives."""
        if any(setup_key(effect.slug) in CHOICES for effect in self.effects):
            return self.model(problem, stand)
        changes = self._changes(problem, stand)
        return self._built(
            problem, stand, lambda setup, depth: self.specimen.pressed(setup, depth, stand.numbers, changes)
        )

    def _built(self, problem: TrialsProblem, stand: Stand, table: Callable[[Setup, float], ElasticTable]) -> PressModel:
        mine = sorted({trial.condition for trial in problem.trials})
        tables = list(problem.tables)
        for number in mine:
            tables[number] = table(*setup_of(problem, number))
        entries = tuple(as_entry(number, stand.numbers[number.name]) for term in self.terms for number in term.numbers)
        held = tuple((name, 0.0) for name in problem.shapes if name not in FREE and not is_setup(name))
        fading = {number: self._fading(problem, number, stand) for number in mine} if self.remembers else {}
        told = replace(problem, tables=tuple(tables))
        return PressModel(told, (*self.effects, *entries), held, fading, stand.numbers)

    def vector(self, model: PressModel, stand: Stand) -> Array:
        """The vector of a model that is expanded at a stand, there."""
        shape = np.array([stand.shape.get(name, 0.0) for name in model.problem.shapes])
        changes = {effect.slug: {"change": 0.0} for effect in model.effects if effect.slug not in stand.values}
        return model.vector(shape, {**stand.values, **changes})

    def fit(self, problem: TrialsProblem, stand: Stand, nuisance: Array) -> tuple[PressFit, Stand, float]:
        """Fit, press where the fit ended, expand there and fit again, until presses agree with their expansion.

        Returns
        -------
        tuple
            The fit, the stand after it, and how far presses and their expansion differ there, relative.
        """
        return self.settled(self.once(problem, stand, nuisance, agrees=False))

    def settled(self, fitted: PressFit) -> tuple[PressFit, Stand, float]:
        """A fit that goes on, as `fit`, until presses agree with their expansion."""
        for left in reversed(range(ROUNDS)):
            stand = self.stand(fitted)
            apart = self._apart(fitted, stand)
            if apart < CLOSE or not left:
                break
            fitted = self.once(fitted.model.problem, stand, fitted.nuisance)
        return fitted, stand, apart

    def weighed(self, fitted: PressFit, noise: NoiseModel) -> tuple[PressFit, Stand, float]:
        """A fit again with another noise, from where it stands; returns as `fit`."""
        model = replace(fitted.model, problem=replace(fitted.model.problem, noise=noise))
        return self.settled(least_squares(model, fitted.vector, fitted.nuisance, search=CONVERGED))

    def once(self, problem: TrialsProblem, stand: Stand, nuisance: Array, *, agrees: bool = True) -> PressFit:
        """Fit the expansion at a stand."""
        model = self.model(problem, stand, agrees=agrees)
        return least_squares(model, self.vector(model, stand), nuisance, search=CONVERGED)

    def _apart(self, fitted: PressFit, stand: Stand) -> float:
        """Largest relative difference of the forces that a fit's tables and presses of where it ended tell."""
        problem, setup = fitted.model.problem, fitted.model.shape(fitted.vector).setup
        numbers = {trial.condition for trial in problem.trials}
        changes, worst = self._changes(problem, stand), 0.0
        numeric = {key: change for key, change in setup.items() if key not in CHOICES}
        for number in numbers:
            expanded = problem.tables[number]
            press = self.specimen.pressed(*setup_of(problem, number), stand.numbers, changes)
            deep = expanded.depth > COMPARED_FROM * expanded.depth[-1]
            there = np.interp(expanded.depth[deep], press.depth, press.force)
            worst = max(worst, float(np.abs(expanded.force_with(numeric)[deep] / there - 1.0).max()))
        return worst

    def stand(self, fitted: PressFit) -> Stand:
        """Where a fit ended."""
        model = fitted.model
        values = model.values(fitted.vector)
        known = {effect.slug for effect in self.effects}
        numbers = {key: moved(key, now, values[PREFIX + key]["change"]) for key, now in model.origin.items()}
        shape = dict(zip(model.problem.shapes, fitted.vector.tolist(), strict=False))
        return Stand(numbers, shape, {slug: each for slug, each in values.items() if slug in known})

    def _changes(self, problem: TrialsProblem, stand: Stand) -> dict[str, float]:
        """Changes of the set-up as the tables take them."""
        plain = EffectModel(problem, tuple(each for each in self.effects if each.slug.startswith(PREFIX)))
        shape = np.array([stand.shape.get(name, 0.0) for name in problem.shapes])
        return dict(plain.shape(plain.vector(shape, stand.values)).setup)

    def _fading(self, problem: TrialsProblem, number: int, stand: Stand) -> Array:
        """(n,) N by which the force of the model with its memory differs from the quasi-linear one's."""
        assert isinstance(self.specimen, FemSpecimen)
        condition, (setup, deepest) = problem.study.conditions[number], setup_of(problem, number)
        time, depth = condition.time.mean(axis=0), condition.depth.mean(axis=0)
        clock = time - time[0] + FIRST_STEP
        effect = next(each for each in self.effects if each.slug == MEMORY)
        values = stand.values[MEMORY]
        prony = physics_of([(effect, values)], condition.around).relaxation
        if prony is None:
            return np.zeros_like(clock)
        rows = _thinned(condition.phase)
        series = dict(zip(prony.time, prony.strength, strict=True))
        pressed = np.maximum(depth, 0.0)
        inside = np.maximum(self.specimen.fading(setup, (clock[rows], pressed[rows]), stand.numbers, series), 0.0)
        table = self.specimen.table(setup, deepest, stand.numbers)
        law = ForceAlone(ShapedTable(table, Shape(), condition.around.peak_depth).force)
        pipeline = TrialPipeline(replace(condition.around, markers=None), (effect,))
        motion = Motion(clock, depth, np.zeros_like(depth))
        outside = pipeline.readings(law, {MEMORY: values}, motion).force
        change = np.where(pressed[rows] > 0.0, inside - outside[rows], 0.0)
        return np.asarray(np.interp(clock, clock[rows], change))


def setup_of(problem: TrialsProblem, number: int) -> tuple[Setup, float]:
    """The set-up of a condition, and the deepest press of any with the same, m."""
    conditions = problem.study.conditions
    setup = conditions[number].setup
    return setup, max(each.around.peak_depth for each in conditions if each.setup == setup)


def _thinned(phase: NDArray[np.int64]) -> NDArray[np.int64]:
    """Rows of a press: evenly thinned, with those at which its phase changes."""
    step = max(phase.size // PRESS_ROWS, 1)
    turns = np.flatnonzero(np.diff(phase))
    rows = np.concatenate([np.arange(0, phase.size, step), turns, turns + 1, [phase.size - 1]])
    return np.unique(rows)
