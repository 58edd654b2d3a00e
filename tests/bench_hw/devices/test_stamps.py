"""Stamping samples that were read together."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.devices.stamps import TICK, back_dated


def test_the_newest_is_stamped_now_and_the_others_by_their_distance():
    times = back_dated(10.0, -np.inf, np.array([5, 6, 7]), 1e-3)
    assert times == pytest.approx([9.998, 9.999, 10.0], abs=1e-5)


def test_a_gap_stays_a_gap():
    times = back_dated(10.0, -np.inf, np.array([5, 9, 10]), 1e-3)
    assert times == pytest.approx([9.995, 9.999, 10.0], abs=1e-5)


def test_a_late_one_stands_after_those_that_overtook_it():
    times = back_dated(10.0, -np.inf, np.array([5, 7, 6, 8]), 1e-3)
    assert times[2] == pytest.approx(times[1] + TICK, abs=1e-9)


def test_nothing_read_nothing_stamped():
    assert len(back_dated(1.0, 0.5, np.zeros(0, np.int64), 1e-3)) == 0


@given(
    st.lists(st.lists(st.integers(0, 50), min_size=1, max_size=20), min_size=1, max_size=10),
    st.floats(1e-4, 0.1),
    st.floats(0.0, 1e-2),
)
def test_stamps_increase_strictly_within_and_across_calls(calls, period, between):
    previous, now, stamps = -np.inf, 100.0, []
    for offsets in calls:
        times = back_dated(now, previous, np.array(offsets), period)
        stamps += times.tolist()
        previous, now = times[-1], now + between
    assert all(after - before >= 0.5 * TICK for before, after in pairwise(stamps))


@given(st.lists(st.integers(0, 1000), min_size=1, max_size=50, unique=True).map(sorted))
def test_an_orderly_batch_is_never_in_the_future(offsets):
    times = back_dated(5.0, -np.inf, np.array(offsets), 1e-3)
    assert times[-1] <= 5.0 + TICK * len(offsets)
