import numpy as np

from wavemodel.taper import Taper


def test_modes_and_remainder_share_the_whole_load():
    k = np.linspace(1.0, 300.0, 50)
    taper = Taper(200.0)
    np.testing.assert_allclose(taper.modes(k) + taper.remainder(k), 1.0)


def test_long_waves_go_to_the_modes_and_waves_beyond_them_do_not():
    taper = Taper(200.0)
    assert taper.remainder(np.array([10.0]))[0] < 1e-8
    assert taper.modes(np.array([200.0]))[0] < 1e-3


def test_inactive_it_leaves_all_to_the_modes():
    np.testing.assert_array_equal(Taper(1.0, active=False).modes(np.array([0.5, 9.0])), 1.0)
