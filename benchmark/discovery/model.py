"""A model: the base with some effects; its parameters as a vector, and the signals it gives for every trial."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from benchmark.discovery.discovery_result import Array
from benchmark.discovery.problem import OFFSETS, OWN, SHAPE_PRIOR, Problem
from benchmark.discovery.simulator import Bent, Shape, Simulator, ordered
from benchmark.physics import Effect, EffectParameter, Readings, catalogue
from benchmark.physics.effect import Values

FAR_RADIUS = 0.25
"""Relative change of the tool's radius up to which the base's second order serves."""
LOG_PRIOR = 2.5
"""Standard deviation of a logarithmic parameter round its start."""


@dataclass(frozen=True, eq=False)
class Model:
    """Base and effects for a problem.

    The vector is the shape nuisances of the base, then each effect's parameters; logarithmic ones by their logarithm.
    `pinned` nuisances stay at their values.
    """

    problem: Problem
    effects: tuple[Effect, ...]
    pinned: tuple[tuple[str, float], ...] = ()

    @cached_property
    def simulators(self) -> tuple[Simulator, ...]:
        """One a condition."""
        study = self.problem.study
        chosen = ordered(self.effects, catalogue())
        return tuple(
            Simulator(law, condition.around, chosen, study.distance)
            for law, condition in zip(self.problem.laws, study.conditions, strict=True)
        )

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
        reach = [FAR_RADIUS if name == "radius" else np.inf for name in self.problem.shapes]
        shapes = [(held.get(n, -far), held.get(n, far)) for n, far in zip(self.problem.shapes, reach, strict=True)]
        low = [low for low, _ in shapes] + [_inner(p, p.low) for _, p in self.parameters]
        high = [high for _, high in shapes] + [_inner(p, p.high) for _, p in self.parameters]
        return np.array(low), np.array(high)

    def prior(self, start: Array) -> tuple[Array, Array]:
        """Mean and precision (p,) of the priors; logarithmic parameters round their start."""
        mean, precision = np.zeros(self.size), np.zeros(self.size)
        for k, name in enumerate(self.problem.shapes):
            precision[k] = getattr(SHAPE_PRIOR, name) ** -2
        for k, (_, parameter) in enumerate(self.parameters, start=self.shape_count):
            if parameter.logarithmic:
                mean[k], precision[k] = start[k], LOG_PRIOR**-2
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
        return Shape(**dict(zip(self.problem.shapes, vector.tolist(), strict=False)))

    def values(self, vector: Array) -> dict[str, dict[str, float]]:
        """Values of each effect's parameters, in SI."""
        out: dict[str, dict[str, float]] = {effect.slug: {} for effect in self.effects}
        for k, (slug, p) in enumerate(self.parameters, start=self.shape_count):
            raw = float(np.exp(vector[k]) if p.logarithmic else vector[k])
            out[slug][p.name] = min(max(raw, p.low), p.high)
        return out

    def bents(self, vector: Array) -> tuple[Bent, ...]:
        """The bent base of each condition."""
        shape = self.shape(vector)
        return tuple(simulator.bent(shape) for simulator in self.simulators)

    def signals(self, vector: Array, nuisance: Array, only: Sequence[int] | None = None) -> list[Array]:
        """(n, C) signals of each trial.

        Parameters
        ----------
        vector
            (p,) of the model.
        nuisance
            (trials, q): log gain, force zero, time shift, depth at touch, marker zeros.
        only
            Numbers of the trials wanted; all by default.
        """
        bents, values = self.bents(vector), self.values(vector)
        return [
            self.trial_signals(index, bents, values, nuisance[index])
            for index in (range(len(self.problem.trials)) if only is None else only)
        ]

    def trial_signals(self, index: int, bents: Sequence[Bent], values: Mapping[str, Values], nuisance: Array) -> Array:
        """(n, C) signals of one trial."""
        trial = self.problem.trials[index]
        simulator, bent = self.simulators[trial.condition], bents[trial.condition]
        gain, zero, shift, height = nuisance[: len(OWN)].tolist()
        readings = simulator.readings(bent, values, trial.motion, float(np.exp(gain)), shift, height)
        signals = self.as_signals(readings, zero, nuisance[len(OWN) :])
        signals[:, 1:] = trial.at_frames(signals[:, 1:])
        return signals

    def as_signals(self, readings: Readings, zero: float, offsets: Array) -> Array:
        """(n, C): force, then marker combinations, with their zeros."""
        layout = self.problem.study.layout
        force = readings.force[:, None] + zero
        if layout is None or readings.markers is None:
            return force
        markers = layout.signals(readings.markers)
        for k, name in enumerate(OFFSETS):
            markers[:, layout.names.index(name)] += offsets[k]
        return np.concatenate([force, markers], axis=1)


def _inner(parameter: EffectParameter, value: float) -> float:
    if not parameter.logarithmic:
        return float(value)
    return float(np.log(max(value, parameter.low, 1e-300)))


def nuisance_count(problem: Problem) -> int:
    """Nuisances of a trial: gain, zero, shift, height, and the marker zeros."""
    return len(OWN) + (len(OFFSETS) if problem.study.layout is not None else 0)


def nuisance_precision(problem: Problem) -> Array:
    """(q,) prior precisions of a trial's nuisances."""
    prior = problem.prior
    sizes = [getattr(prior, name) for name in OWN] + [prior.offset] * (nuisance_count(problem) - len(OWN))
    return np.array(sizes) ** -2.0
