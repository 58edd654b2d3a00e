"""Losses counted from sequence numbers equal the losses injected."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.trial_file.sequence import check_sequence


def verdict(numbers, samples=None):
    check = check_sequence(np.array(numbers, dtype=np.int64), samples)
    return check.lost, check.gaps, check.reordered, check.duplicates, check.restarts


def test_nothing_and_one_record():
    assert verdict([]) == (0, 0, 0, 0, 0)
    assert verdict([77]) == (0, 0, 0, 0, 0)


@pytest.mark.parametrize(
    ("numbers", "expected"),
    [
        ([1, 2, 3, 4], (0, 0, 0, 0, 0)),
        ([1, 2, 5, 6, 9], (4, 2, 0, 0, 0)),
        ([1, 2, 4, 3, 5], (0, 0, 1, 0, 0)),
        ([1, 2, 5, 3, 6], (1, 1, 1, 0, 0)),
        ([1, 2, 2, 3, 2, 4], (0, 0, 0, 2, 0)),
        ([2**32 - 2, 2**32 - 1, 0, 1], (0, 0, 0, 0, 0)),
        ([2**32 - 2, 1, 2**32 - 1, 2], (1, 1, 1, 0, 0)),
        ([1000, 1001, 1, 2, 4], (1, 1, 0, 0, 1)),
    ],
)
def test_small_cases(numbers, expected):
    assert verdict(numbers) == expected


def test_a_counter_that_begins_anew_soon_is_told_by_its_samples():
    numbers, samples = [1, 2, 3, 1, 2, 3], np.array([7, 14, 21, 28, 35, 42])
    assert verdict(numbers, samples) == (0, 0, 0, 0, 1)
    assert verdict(numbers) == (0, 0, 0, 3, 0)


def test_rows_in_order_are_neither_late_nor_doubled():
    check = check_sequence(np.array([5, 6, 9, 7, 9, 10, 10, 11]))
    assert check.in_order.tolist() == [True, True, True, False, False, True, False, True]


@given(
    start=st.integers(0, 2**32 - 1),
    count=st.integers(3, 400),
    dropped=st.sets(st.integers(1, 398)),
    twice=st.sets(st.integers(0, 399)),
    swapped=st.sets(st.integers(1, 397)),
)
def test_injected_faults_are_counted_exactly(start, count, dropped, twice, swapped):
    inner = sorted(number for number in dropped if number < count - 1)
    left = [number for number in range(count) if number not in inner]
    swaps = 0
    for place in sorted(swapped):
        if 0 < place < len(left) - 2 and left[place] < left[place + 1] and left[place - 1] < left[place]:
            left[place], left[place + 1] = left[place + 1], left[place]
            swaps += 1
    arrived = [number for number in left for _ in range(2 if number in twice else 1)]
    lost, gaps, reordered, duplicates, restarts = verdict([(start + number) % 2**32 for number in arrived])
    runs = sum(number - 1 not in inner for number in inner)
    assert (lost, gaps, restarts) == (len(inner), runs, 0)
    assert duplicates == len(arrived) - len(left)
    assert reordered == sum(number < max(left[: row + 1]) for row, number in enumerate(left))
    assert (reordered > 0) == (swaps > 0)
