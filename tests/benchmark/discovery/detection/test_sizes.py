"""The size of a misfit: what trials share counts as what they do not, against a tolerance stated beforehand."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.detection.sizes import channel_sizes
from benchmark.discovery.discovery_result import PHASES

LOAD, HOLD = PHASES.index("load"), PHASES.index("hold")


def fitted(*missed):
    """Trials of one condition with a peak of 8 N whose force misses by `missed` in the hold, N; markers by 10 um."""
    phase, rows = np.array([LOAD, LOAD, HOLD, HOLD]), 4
    condition = SimpleNamespace(
        phase=phase, cycle=np.ones(rows, dtype=int), part=np.zeros(rows, dtype=int), name="one",
        signals=np.zeros((len(missed), rows, 2)), count=np.ones((len(missed), rows, 2)),
        around=SimpleNamespace(peak_force=8.0),
    )  # fmt: skip
    trials = tuple(
        SimpleNamespace(
            condition=0,
            signals=np.column_stack([np.where(phase == HOLD, force, 0.0), np.full(rows, 1e-5)]),
            count=np.ones((rows, 2)),
        )
        for force in missed
    )
    study = SimpleNamespace(conditions=(condition,), channels=("force_z", "marker_x"))
    problem = SimpleNamespace(study=study, trials=trials)
    model = SimpleNamespace(problem=problem, signals=lambda vector, nuisance: [np.zeros((rows, 2))] * len(trials))
    return SimpleNamespace(model=model, vector=None, nuisance=None)


def test_two_newtons_of_eight_are_beyond_the_tolerance_whatever_their_signs():
    shared, apart, small = fitted(2.0, 2.0, 2.0, 2.0), fitted(2.0, -2.0, 2.0, -2.0), fitted(0.1, 0.1, 0.1, 0.1)
    for each in (shared, apart):
        force, marker = channel_sizes(each, small)
        assert (force.channel, force.before, force.after) == ("force_z", pytest.approx(2.0), pytest.approx(0.1))
        assert force.tolerance == pytest.approx(0.16)  # 2 % of the peak force
        assert force.within
        assert (marker.after, marker.tolerance, marker.within) == (pytest.approx(1e-5), 5e-5, True)
        assert not channel_sizes(small, each)[0].within
