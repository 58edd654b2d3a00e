"""What one step promises of an effect, beside what its fit gains."""

import pytest

from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.candidate_fit import fit_candidate, screened
from benchmark.discovery.base.effect_model import EffectModel
from benchmark.discovery.trials.preparing import prepare
from benchmark.physics import catalogue
from tests.benchmark.discovery.quick_session import law

GAP = next(effect for effect in catalogue() if effect.slug == "contact_gap")


def test_an_offset_that_each_trial_could_take_up_is_promised_what_its_fit_gains(session_of):
    """A gap of 0.1 mm beside touches that scatter by 0.03 mm: by a whole start it was promised a tenth of it."""
    session = session_of(force=lambda time, depth, elastic: law(depth - 0.1e-3), noise=0.0005, touch=0.03e-3)
    base = calibrate(session, prepare(session, 90)).base
    found = fit_candidate(base, GAP)
    best, *_ = screened(base, EffectModel(base.model.problem, (GAP,)), GAP)
    assert best.won == pytest.approx(base.objective - found.objective, rel=0.5)
