"""Candidates of very many trials are compared on some of them; small sessions are used whole."""

import numpy as np
import pytest

from benchmark.discovery import criteria
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.evidence.gains import effective_size
from benchmark.discovery.evidence.shortlist import Screened, compared, on_all, on_some, promising, remark
from benchmark.discovery.trials.preparing import prepare


@pytest.fixture(scope="module")
def base(tmp_path_factory, quick_session):
    from benchmark.files import load_session

    session = load_session(quick_session.write_session(tmp_path_factory.mktemp("many") / "s", trials=5))
    return calibrate(session, prepare(session, 60)).base


def test_trials_are_spread_over_the_conditions_and_their_order(base):
    assert compared(base) == list(range(10))
    assert compared(base, most=6) == [0, 2, 4, 5, 7, 9]


def test_few_trials_are_used_whole(base):
    assert on_some(base, compared(base)) is base
    assert on_all(base, base) is base
    assert remark(10, 10) == ()


def test_a_fit_to_some_knows_those_alone(base):
    some = on_some(base, compared(base, most=6))
    assert len(some.model.problem.trials) == len(some.nuisance) == len(some.blocks.misfit) == 6
    assert np.isfinite(some.objective)
    assert on_all(base, some) is base
    assert "6 of them" in remark(6, 10)[0]


def test_what_one_step_must_gain_is_what_bic_asks_of_a_parameter(base):
    asked = 0.5 * (np.log(effective_size(base)) - criteria.ACCEPT_BIC)
    assert 3.0 < asked < 10.0

    def ranked(*won):
        return tuple(Screened(None, each, np.zeros((1, 10))) for each in won)

    assert promising(base, ranked(1.001 * asked, 0.1))
    assert not promising(base, ranked(0.999 * asked, 0.1))
    assert not promising(base, ())
