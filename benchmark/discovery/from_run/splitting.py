"""Which loads of a run are fitted and which are held out, and the gap in each layer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmark.discovery.discovery_result import Array
from benchmark.discovery.from_run.body import NOTHING, Body, body_of
from benchmark.discovery.from_run.candidates import History
from benchmark.discovery.from_run.reading import FinishedRun
from benchmark.discovery.report.discovery_record import LayerGap
from benchmark.errors import InputError
from wavemodel.physics import Physics

HALF = 0.5
LEAST = 5
"""Load levels that a fit needs."""


@dataclass(frozen=True, eq=False)
class Case:
    """A run with its body, its history, and the rows (n,) that the fit does not see."""

    run: FinishedRun
    body: Body
    history: History
    held: np.ndarray

    @property
    def before(self) -> Array:
        """(n,) N of the wave model at the reference's depths."""
        return self.body.pressed(self.history.time, self.history.depth)


def split(run: FinishedRun, other: FinishedRun | None) -> tuple[Case, Case]:
    """The case that is fitted, and the case whose held-out rows count: the upper half of loads, or the other run.

    Raises
    ------
    InputError
        Too few loads to fit.
    """
    whole = np.ones(run.force.size, dtype=bool)
    fitted = whole if other is not None else run.force <= HALF * run.force.max() * (1.0 + 1e-9)
    if np.unique(run.force[fitted & (run.force > 0.0)]).size < LEAST or run.force.max() <= 0.0:
        raise InputError(
            f"run {run.name}: its load history has fewer than {LEAST} loads to fit; raise load.observations, or press "
            "instead of pulling"
        )
    first = _case(run, fitted, ~fitted)
    if other is None:
        return first, first
    return first, _case(other, np.ones(other.force.size, dtype=bool), np.ones(other.force.size, dtype=bool))


def _case(run: FinishedRun, fitted: np.ndarray, held: np.ndarray) -> Case:
    history = History(run.time, run.reference[:, 0], run.force, fitted)
    return Case(run, body_of(run), history, held)


def layer_gaps(case: Case, physics: Physics = NOTHING) -> tuple[LayerGap, ...]:
    """The gap of each layer under the run's force, before and with `physics`."""
    run = case.run
    after = case.body.deflections(run.time, run.force, physics)
    return tuple(_layer_gap(name, run, column, after[:, column], case.held) for column, name in enumerate(run.layers))


def _layer_gap(name: str, run: FinishedRun, column: int, after: Array, held: np.ndarray) -> LayerGap:
    reference, before = run.reference[:, column], run.wave[:, column]
    peak = int(np.abs(run.force).argmax())
    errors = [100.0 * float((each[peak] - reference[peak]) / reference[peak]) for each in (before, after)]
    sizes = [float(np.sqrt(np.mean((each - reference)[held] ** 2))) for each in (before, after)]
    return LayerGap(name, run.force, reference, before, after, *sizes, *errors)
