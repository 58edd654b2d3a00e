"""Rival models in another protocol: what each expects, and how far apart two of them are."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from benchmark.discovery.base.effect_model import Fit, nuisance_count
from benchmark.discovery.base.setup_priors import is_setup
from benchmark.discovery.base.trials_problem import OWN
from benchmark.discovery.discovery_result import Array
from benchmark.discovery.trials.rows import acceleration
from benchmark.discovery.workflow import Findings
from benchmark.files import Tool
from benchmark.physics import Motion
from benchmark.response.elastic_table import ElasticTable

Item = TypeVar("Item")


@dataclass(frozen=True, eq=False)
class Rival:
    """A model that the data left standing: its slugs and its fit."""

    slugs: tuple[str, ...]
    fit: Fit

    @property
    def vector(self) -> Array:
        """(p,) its parameters, for `expected`."""
        return self.fit.vector

    @property
    def covariance(self) -> Array:
        """(p, p) of `vector`."""
        return self.fit.covariance

    @property
    def values(self) -> Mapping[str, Mapping[str, float]]:
        """Values of the effects' parameters by slug, SI."""
        return self.fit.model.values(self.fit.vector)


def rivals(found: Findings) -> tuple[Rival, ...]:
    """The answer first, then its look-alikes, nearest first."""
    chosen = [found.selection.chosen]
    for others in found.selection.rivals.values():
        chosen += others
    return tuple(Rival(tuple(e.slug for e in fit.model.effects), fit) for fit in chosen)


def nearest(standing: Sequence[Rival]) -> tuple[Rival, Rival]:
    """The two that are to be told apart: the answer and its nearest look-alike.

    Where the answer is the set-up alone that is the nearest with an effect, if there is one: which part of a set-up is
    off matters less than whether it is the set-up.
    """
    first, *others = standing
    effects = [] if _has_effect(first) else [each for each in others if _has_effect(each)]
    return first, (effects or others)[0]


def _has_effect(rival: Rival) -> bool:
    return not all(is_setup(slug) for slug in rival.slugs)


def under(rival: Rival, condition: str, tool: Tool, table: ElasticTable) -> Rival:
    """The rival on the specimen of a condition under another tool, whose elastic answer is `table`."""
    model = rival.fit.model
    problem = model.problem
    place = [one.name for one in problem.study.conditions].index(condition)
    was = problem.study.conditions[place]
    force = float(np.interp(was.around.peak_depth, table.depth, table.force))
    moved = replace(was, tool=tool, around=replace(was.around, tool_radius=tool.radius, peak_force=force))
    study = replace(problem.study, conditions=_put(problem.study.conditions, place, moved))
    changed = replace(problem, study=study, tables=_put(problem.tables, place, table))
    return Rival(rival.slugs, replace(rival.fit, model=replace(model, problem=changed)))


def _put(items: tuple[Item, ...], place: int, item: Item) -> tuple[Item, ...]:
    return (*items[:place], item, *items[place + 1 :])


@dataclass(frozen=True, eq=False)
class Expected:
    """Signals (n, C) of a trial, their names (C,), and the standard deviation (C,) of a raw sample's noise."""

    signals: Array
    names: tuple[str, ...]
    noise: Array


def expected(rival: Rival, condition: str, time: Array, depth: Array, vector: Array | None = None) -> Expected:
    """What a rival expects of a motion on the specimen and set-up of one condition.

    Parameters
    ----------
    rival
        From `rivals`.
    condition
        Whose tool and support are taken.
    time, depth
        (n,) s and m, evenly spaced in time, as the actuator would report them.
    vector
        Other parameters than the rival's own, (p,).
    """
    model = rival.fit.model
    names = [one.name for one in model.problem.study.conditions]
    number = names.index(condition)
    motion = Motion(
        np.asarray(time, float), np.asarray(depth, float), acceleration(np.asarray(time), np.asarray(depth))
    )
    at = rival.vector if vector is None else vector
    readings = model.pipelines[number].readings(model.shaped(at)[number], model.values(at), motion)
    signals = model.as_signals(readings, 0.0, np.zeros(nuisance_count(model.problem) - len(OWN)))
    noise = np.median(model.problem.noise.scale, axis=0)
    return Expected(signals, model.problem.study.names, noise)


Signals = Callable[[Array], Array]
"""Parameters (p,) of a model to its signals (n, C) in an experiment."""
STEP = 0.1
"""Of a parameter's standard deviation, for differences."""


def separation(first: Array, rival: Signals, at: Array, covariance: Array, noise: Array, time: Array) -> float:
    """T = min over the rival's parameters of |m_A - m_B|^2, in squared standard deviations of one trial.

    The rival may move its parameters, at the price of what the session says of them, and each trial has a gain, a
    zero of every channel and a time shift of its own. Linear in all of these (optimal design for discrimination:
    A. C. Atkinson and V. V. Fedorov 1975, Biometrika 62:57).

    Parameters
    ----------
    first : (n, C) array
        What the first expects.
    rival : (p,) to (n, C)
        The second.
    at, covariance : (p,) and (p, p)
        The second's parameters by the session.
    noise : (C,) array
        Standard deviation of a row.
    time : (n,) array
        s.
    """
    second = rival(at)
    whole = ((first - second) / noise).ravel()
    spread = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    moved = [
        ((rival(at + STEP * size * unit) - second) / (STEP * noise)).ravel()
        for size, unit in zip(spread, np.eye(at.size), strict=True)
        if size > 0.0
    ]
    columns = np.column_stack([*moved, *_nuisances(second, noise, time)])
    prices = np.zeros((len(moved), columns.shape[1]))
    kept = spread > 0.0
    if moved:
        correlation = covariance[np.ix_(kept, kept)] / np.outer(spread[kept], spread[kept])
        values, vectors = np.linalg.eigh(correlation)
        prices[:, : len(moved)] = (vectors / np.sqrt(np.maximum(values, 1e-9))).T
    design = np.vstack([columns, prices])
    wanted = np.concatenate([whole, np.zeros(len(moved))])
    found = np.linalg.lstsq(design, wanted, rcond=1e-10)[0]
    return float(np.sum((wanted - design @ found) ** 2))


def _nuisances(signals: Array, noise: Array, time: Array) -> list[Array]:
    """Gain, time shift, and the zero of each channel, as columns."""
    shifted = np.gradient(signals, time, axis=0)
    zeros = [np.broadcast_to(row, signals.shape).ravel() for row in np.eye(signals.shape[1])]
    return [(signals / noise).ravel(), (shifted / noise).ravel(), *zeros]
