import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reports.figures.arrays import (
    column,
    last_value,
    layer_of,
    matrix,
    optional_column,
    optional_matrix,
    peak,
    shared_limits,
    stopped_at,
    thinned,
)

NAN = np.nan


def test_none_is_nan():
    assert np.array_equal(column("x", [1, None, 2.5]), [1, NAN, 2.5], equal_nan=True)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: column("x", [[1]]), r"x has shape \(1, 1\), allowed: \(1,\)"),
        (lambda: column("x", [1, 2], 3), r"x has shape \(2,\), allowed: \(3,\)"),
        (lambda: matrix("fem_mm", [[1, 2]], (2, 1)), r"fem_mm has shape \(1, 2\), allowed: \(2, 1\)"),
        (lambda: column("x", [0, np.inf]), r"x is infinite at index \[1\]"),
        (lambda: matrix("m", [[0, -np.inf]], (1, 2)), r"m is infinite at index \[0, 1\]"),
    ],
)
def test_what_is_no_such_array_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_an_array_without_a_value_is_none():
    assert optional_column("x", None, 2) is None
    assert optional_column("x", [NAN, NAN], 2) is None
    assert optional_matrix("x", [[NAN]], (1, 1)) is None
    assert layer_of(np.array([[1.0, NAN], [2.0, NAN]]), 1) is None
    assert layer_of(None, 0) is None
    assert layer_of(np.array([[1.0, NAN], [2.0, NAN]]), 0).tolist() == [1.0, 2.0]


@pytest.mark.parametrize(
    ("values", "last", "stop"),
    [([1, 2], 1, None), ([1, NAN], 0, 0), ([NAN, 1], 1, None), ([NAN, NAN], None, None), ([], None, None)],
)
def test_a_series_stops_where_only_nan_follows(values, last, stop):
    values = np.array(values, dtype=float)
    assert last_value(values) == last
    assert stopped_at(values) == stop


def test_the_peak_of_nothing_is_nan():
    assert peak(np.array([1.0, NAN, -3.0])) == 1.0
    assert np.isnan(peak(np.array([NAN])))


@given(st.integers(1, 2000), st.integers(10, 300), st.integers(0, 9))
def test_a_thinned_line_keeps_its_ends_and_extremes(count, limit, seed):
    x = np.arange(float(count))
    y = np.random.default_rng(seed).normal(size=count)
    new_x, new_y = thinned(x, y, limit)
    assert len(new_x) <= max(limit, 0)
    assert {x[0], x[-1], x[y.argmin()], x[y.argmax()]} <= set(new_x)
    assert np.array_equal(y[new_x.astype(int)], new_y)
    assert (np.diff(new_x) > 0).all()


def test_alike_series_share_their_limits():
    low, high = shared_limits([np.array([0.0, 1.0]), np.array([NAN, 2.0])])
    assert low == 0
    assert 2 < high < 2.5
    low, high = shared_limits([np.array([-1.0]), np.array([0.5, 1.0])])
    assert low < -1
    assert high > 1


@pytest.mark.parametrize("series", [[np.array([1.0]), np.array([9.0])], [np.array([NAN])], [np.zeros(3)], []])
def test_series_that_differ_or_hold_nothing_share_none(series):
    assert shared_limits(series) is None
