import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.physics.body import Physics
from wavemodel.physics.permanent_set import PermanentSet
from wavemodel.physics.quasi_static_press import QuasiStaticPress

LASTING = Physics(permanent_set=PermanentSet(0.1))


def test_the_first_loading_is_the_base_law(press):
    depth = np.linspace(0.0, 3e-3, 31)
    np.testing.assert_allclose(press(LASTING, depth), 500.0 * depth, rtol=1e-13)


def test_later_cycles_meet_the_surface_later(press, path):
    depth = path(0.0, 3e-3, 0.0, 3e-3, points=601)
    found, peak = press(LASTING, depth), int(np.argmax(depth >= 3e-3 - 1e-12))
    expected = 500.0 * np.maximum(depth - 0.3e-3, 0.0) * 3.0 / 2.7
    np.testing.assert_allclose(found[peak:], expected[peak:], atol=1e-13)
    assert found[-1] == pytest.approx(found[peak])


def test_the_surface_stays_where_it_was_left():
    trace = QuasiStaticPress(lambda d: 500.0 * d, LASTING).trace(
        np.arange(1.0, 5.0), np.array([2e-3, 4e-3, 1e-3, -1e-3])
    )
    np.testing.assert_allclose(trace.surface, [2e-3, 4e-3, 1e-3, 0.4e-3])
    np.testing.assert_array_equal(trace.touching, [True, True, True, False])


def test_depths_up_to_the_onset_leave_none(press, path):
    depth = path(0.0, 2e-3, 0.0)
    np.testing.assert_allclose(press(Physics(permanent_set=PermanentSet(0.2, 2e-3)), depth), 500.0 * depth, atol=1e-15)


def test_off_at_zero(press, path):
    depth = path(0.0, 3e-3, 0.0)
    np.testing.assert_array_equal(press(Physics(permanent_set=PermanentSet(0.0)), depth), 500.0 * depth)


@pytest.mark.parametrize("wrong", [(1.0, 0.0), (-0.1, 0.0), (0.1, -1e-3)])
def test_refuses(wrong):
    with pytest.raises(WaveError, match="permanent set"):
        PermanentSet(*wrong)
