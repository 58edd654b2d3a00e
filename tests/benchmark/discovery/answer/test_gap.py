"""What is closed and what trials share: told from round-off and from what each has of its own."""

import numpy as np
import pytest

from benchmark.discovery.answer.gap import share_closed, share_left, shared_misfit
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.trials.preparing import prepare
from benchmark.physics import catalogue


@pytest.mark.parametrize(
    ("before", "after", "floor", "expected"),
    [
        (4.0, 2.0, 1.0, 2.0 / 3.0),
        (4.0, 0.5, 1.0, 1.0),  # below the floor: all that can be closed
        (4.0, 5.0, 1.0, -1.0 / 3.0),
        (1.0, 0.25, 0.0, 0.75),
    ],
)
def test_share_of_what_lies_above_the_floor(before, after, floor, expected) -> None:
    assert share_closed(before, after, floor) == pytest.approx(expected, abs=1e-6)


def test_nothing_to_close_where_the_base_reaches_the_floor() -> None:
    assert share_closed(1.04, 1.0, 1.0) is None
    assert share_closed(0.9, 0.8, 1.0) is None


def test_round_off_is_not_a_share() -> None:
    assert str(share_closed(2.0, 2.0 * (1.0 + 1e-13), 1.0)) == "0.0"


BY_SLUG = {effect.slug: effect for effect in catalogue()}


def drifting(time, depth, elastic):
    return elastic + 0.02 * (time - time[0])


def test_the_right_effect_leaves_little_and_a_wrong_one_nearly_all(session_of):
    session = session_of(force=drifting, noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    assert shared_misfit(base) > 200.0
    assert share_left(base, fit_candidate(base, BY_SLUG["force_drift"])) < 0.1
    assert share_left(base, fit_candidate(base, BY_SLUG["tool_inertia"])) > 0.7


def test_noise_alone_is_not_shared(session_of):
    session = session_of(noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    rows = sum(trial.signals.size for trial in base.model.problem.trials[::4])
    assert shared_misfit(base) == pytest.approx(0.0, abs=6.0 * np.sqrt(2.0 * rows))
