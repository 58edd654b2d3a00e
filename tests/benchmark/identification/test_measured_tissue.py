"""Real measured tissue by others, found through TISSUEBENCH_DATA; the elastic curve here is made up."""

import os
from pathlib import Path

import numpy as np
import pytest

from benchmark.identification import TrialData, fit_session, predict
from benchmark.response import ForceCurve

DATA = Path(os.environ.get("TISSUEBENCH_DATA", "")) / "pig_indentation"
DAYS = ("2023-03-27", "2023-03-31", "2023-04-03")

pytestmark = pytest.mark.skipif(
    "TISSUEBENCH_DATA" not in os.environ or not DATA.is_dir(), reason="needs the measured trials at TISSUEBENCH_DATA"
)


def read_day(day):
    depth = np.linspace(0, 14e-3, 29)[1:]
    curve = ForceCurve(depth, 300.0 * depth * (1.0 + (depth / 5e-3) ** 1.5))
    trials = []
    for path in sorted((DATA / day).glob("*.csv")):
        table = np.genfromtxt(path, delimiter=",", names=True)
        columns = table["time_s"], 1e-3 * table["depth_mm"], table["force_N"]
        trials.append(TrialData(path.stem, day, *columns, curve))
    return trials


@pytest.mark.parametrize("day", DAYS)
def test_every_trial_is_fitted_and_its_time_dependence_seen(day, silicone):
    trials = read_day(day)
    fit = fit_session(trials, [silicone])
    assert len(fit.trials) == len(trials)
    assert not fit.excluded
    assert all(trial.time_dependent and 40 < trial.hold.decay_percent < 75 for trial in fit.trials)
    assert any("time dependence" in warning for warning in fit.warnings)
    assert any("different specimens" in warning for warning in fit.warnings)
    assert all(abs(trial.zero) < 0.05 * trial.peak for trial in fit.trials)
    assert np.isfinite(predict(fit, trials[0], leave_one_out=True)).all()
