"""What rival models expect of another protocol: the planner's view of a discovery."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from benchmark.discovery.fit import Fit
from benchmark.discovery.model import nuisance_count
from benchmark.discovery.problem import OWN
from benchmark.discovery.reading import acceleration
from benchmark.discovery.result import Array
from benchmark.discovery.workflow import Findings
from benchmark.physics import Motion


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
    simulator = model.simulators[number]
    motion = Motion(
        np.asarray(time, float), np.asarray(depth, float), acceleration(np.asarray(time), np.asarray(depth))
    )
    at = rival.vector if vector is None else vector
    bent = simulator.bent(model.shape(at))
    readings = simulator.readings(bent, model.values(at), motion)
    signals = model.as_signals(readings, 0.0, np.zeros(nuisance_count(model.problem) - len(OWN)))
    noise = np.median(model.problem.noise.scale, axis=0)
    return Expected(signals, model.problem.study.names, noise)
