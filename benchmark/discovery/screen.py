"""A quick look at all effects: what each could gain in one step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmark.discovery.candidate_fit import screened
from benchmark.discovery.fit import Fit
from benchmark.discovery.model import Model
from benchmark.discovery.result import Array
from benchmark.physics import Effect


@dataclass(frozen=True, eq=False)
class Screened:
    """An effect, what one step towards it gains in log density over all trials, and the residual along its starts.

    `along` is (starts, R): one number a start and trial, of unit variance where there is nothing but noise.
    """

    effect: Effect
    won: float
    along: Array


def screen(current: Fit, effects: Sequence[Effect]) -> tuple[Screened, ...]:
    """Effects by what one step gains, best first."""
    out = []
    for effect in effects:
        model = Model(current.model.problem, (*current.model.effects, effect))
        ranked = screened(current, model, effect)
        out.append(Screened(effect, ranked[0].won, np.array([start.along for start in ranked])))
    return tuple(sorted(out, key=lambda each: -each.won))
