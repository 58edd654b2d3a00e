import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.files.load import Load
from benchmark.files.load_history import load_history


def test_the_triangle_behind_table_2():
    time, value = load_history(Load(peak=50.0, duration=10.0, observations=100))
    np.testing.assert_allclose(time, np.arange(1, 101) / 10, rtol=1e-15)
    np.testing.assert_allclose(value, [*range(1, 51), *range(49, -1, -1)], rtol=1e-15)


def test_its_statistics_are_those_the_article_prints():
    value = load_history(Load(peak=0.11016, observations=100)).value
    assert round(value.mean(), 5) == 0.05508
    assert round(value.var(ddof=1), 6) == 0.001022


@given(half=st.integers(1, 300), peak=st.floats(1e-3, 1e3), duration=st.floats(1e-3, 1e4))
def test_a_triangle_rises_to_its_peak_in_the_middle_and_ends_unloaded(half, peak, duration):
    time, value = load_history(Load(peak=peak, duration=duration, observations=2 * half))
    assert value.argmax() == half - 1
    assert value[half - 1] == peak
    assert value[-1] == 0.0
    assert time[-1] == duration
    assert time[0] > 0
    np.testing.assert_allclose(value[: half - 1], value[half:-1][::-1], rtol=1e-12)


def test_an_odd_triangle_steps_over_its_peak():
    value = load_history(Load(peak=5.0, observations=5)).value
    np.testing.assert_allclose(value, [2, 4, 4, 2, 0])


def test_a_ramp_ends_at_its_peak():
    time, value = load_history(Load(peak=-4.0, shape="ramp", duration=2.0, observations=4))
    np.testing.assert_allclose(time, [0.5, 1, 1.5, 2])
    np.testing.assert_allclose(value, [-1, -2, -3, -4])


def test_ramp_and_hold_share_the_rows_by_duration():
    time, value = load_history(Load(peak=3.0, shape="ramp_hold", duration=3.0, hold=1.0, observations=8))
    np.testing.assert_allclose(time, np.arange(1, 9) / 2)
    np.testing.assert_allclose(value, [0.5, 1, 1.5, 2, 2.5, 3, 3, 3])


@given(duration=st.floats(1e-3, 1e3), hold=st.floats(1e-3, 1e3), count=st.integers(2, 200))
def test_the_end_of_the_ramp_and_of_the_hold_are_always_rows(duration, hold, count):
    load = Load(peak=1.0, shape="ramp_hold", duration=duration, hold=hold, observations=count)
    time, value = load_history(load)
    assert len(time) == len(value) == count
    assert (np.diff(time) > 0).all()
    assert time[-1] == duration + hold
    assert value[time == duration].tolist() == [1.0]
    assert value[-1] == 1.0


def table(**keys):
    return Load(shape="table", table=((0.0, 1.0), (1.0, 3.0), (4.0, 0.0)), **keys)


def test_the_rows_of_a_table_are_its_observations():
    time, value = load_history(table())
    assert time.tolist() == [1.0, 4.0]
    assert value.tolist() == [3.0, 0.0]


def test_a_table_is_interpolated_when_observations_are_given():
    time, value = load_history(table(observations=8))
    np.testing.assert_allclose(time, np.arange(1, 9) / 2)
    np.testing.assert_allclose(value, [2, 3, 2.5, 2, 1.5, 1, 0.5, 0])


def test_a_table_without_a_row_at_zero_begins_unloaded():
    load = Load(shape="table", table=((1.0, 2.0), (2.0, 4.0)), observations=4)
    np.testing.assert_allclose(load_history(load).value, [1, 2, 3, 4])


def test_a_table_of_depths():
    load = Load(control="depth", shape="table", table=((1.0, 2e-3),))
    assert load_history(load).value.tolist() == [2e-3]
    assert load.peak == 2e-3


@pytest.mark.parametrize("count", [2, 3, 100, 101])
def test_there_is_no_row_at_time_zero(count):
    assert load_history(Load(peak=1.0, observations=count)).time.min() > 0
