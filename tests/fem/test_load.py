import numpy as np
import pytest

import fem
from fem import FemError


def test_lists_become_arrays():
    load = fem.Load("force", [1, 2], [0.5, 1])
    assert load.time.dtype == np.float64
    assert load.value.tolist() == [0.5, 1.0]


@pytest.mark.parametrize(
    ("time", "value", "message"),
    [
        ([], [], "at least one step"),
        ([1.0, 2.0], [1.0], "one length"),
        ([1.0, 1.0], [1.0, 2.0], r"load.time\[1\] = 1 s after 1 s: time must increase"),
        ([1.0, np.inf], [1.0, 2.0], r"load.time\[1\] = inf s: must be finite"),
        ([1.0, 2.0], [1.0, np.nan], r"load.value\[1\] = nan m: must be finite"),
    ],
)
def test_bad_histories_are_refused(time, value, message):
    with pytest.raises(FemError, match=message):
        fem.Load("depth", time, value)


def test_control_is_force_or_depth():
    with pytest.raises(FemError, match="allowed are depth, force"):
        fem.Load("stress", [1.0], [1.0])
