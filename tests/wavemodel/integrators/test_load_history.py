import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.integrators.load_history import checked_load


def test_the_first_step_starts_at_time_zero_unloaded():
    load = checked_load("force", [0.1, 0.2, 0.4], [1.0, 3.0, 3.0])
    np.testing.assert_allclose(load.durations, [0.1, 0.1, 0.2])
    assert load.initial(load.value) == 0.0
    np.testing.assert_allclose(load.line[0], [0.0, 0.1, 0.2, 0.4])


@pytest.mark.parametrize("start", [0.0, -2.0])
def test_a_history_from_zero_on_starts_in_its_first_state(start):
    load = checked_load("depth", np.array([start, start + 1.0]), np.array([2.0, 3.0]))
    np.testing.assert_allclose(load.durations, [0.0, 1.0])
    assert load.initial(load.value) == 2.0


@pytest.mark.parametrize(
    ("control", "time", "value", "message"),
    [
        ("power", [1.0], [1.0], "'power'"),
        ("force", [], [], "at least 1"),
        ("force", [1.0, 2.0], [1.0], "of one length"),
        ("force", [[1.0]], [[1.0]], "one-dimensional"),
        ("force", [1.0, 1.0], [1.0, 2.0], r"time\[1\] = 1 s"),
        ("force", [1.0, 0.5], [1.0, 2.0], r"time\[1\]"),
        ("depth", [1.0, 2.0], [np.nan, 2.0], r"value\[0\] = nan"),
        ("depth", [1.0, np.inf], [1.0, 2.0], r"time\[1\] = inf"),
    ],
)
def test_refuses_what_is_no_history(control, time, value, message):
    with pytest.raises(WaveError, match=message):
        checked_load(control, time, value)


def test_keeps_its_own_copy_of_what_it_was_given():
    time, value = np.array([1.0, 2.0]), np.array([1.0, 2.0])
    load = checked_load("force", time, value)
    time[:], value[:] = 7.0, 9.0
    np.testing.assert_array_equal(load.time, [1.0, 2.0])
    np.testing.assert_array_equal(load.value, [1.0, 2.0])
