from dataclasses import replace

import numpy as np
import pytest

from benchmark.identification import FittingError
from benchmark.identification.trial_data import reduced, rows_of, up_to_depth


def test_reduced_keeps_the_means(trial):
    whole = trial(rows=1000)
    short = reduced(whole, 130)
    assert short.rows == 125
    assert short.force.mean() == pytest.approx(whole.force.mean())
    assert short.depth[3] == pytest.approx(whole.depth[24:32].mean())
    assert (np.diff(short.time) > 0).all()


def test_an_unfilled_last_group_is_averaged_too(trial):
    whole = trial(rows=1003)
    assert reduced(whole, 130).force[-1] == pytest.approx(whole.force[1000:].mean())


def test_a_short_trial_stays_as_it_is(trial):
    whole = trial()
    assert reduced(whole, 160) is whole


def test_rows_by_depth(trial):
    whole = trial()
    part = up_to_depth(whole, 1e-3)
    assert part is not None
    assert part.depth.max() <= 1e-3
    assert up_to_depth(whole, -1.0) is None
    assert rows_of(whole, slice(0, 30)).rows == 30


@pytest.mark.parametrize(
    ("channel", "change", "found"),
    [
        ("force", lambda x: x[:-1], r"trial a \(slow\): force has shape"),
        ("depth", lambda x: np.where(np.arange(160) == 4, np.nan, x), "depth has a value that is not finite in row 5"),
        ("time", lambda x: np.where(np.arange(160) == 9, x[8], x), "time does not increase at row 10"),
    ],
)
def test_unusable_channels_are_refused(trial, channel, change, found):
    whole = trial()
    with pytest.raises(FittingError, match=found):
        replace(whole, **{channel: change(getattr(whole, channel))})


def test_19_rows_are_too_few(trial):
    with pytest.raises(FittingError, match="19 rows; at least 20"):
        rows_of(trial(), slice(0, 19))
