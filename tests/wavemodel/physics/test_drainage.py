import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.physics.body import Physics
from wavemodel.physics.drainage import PoroelasticDrainage
from wavemodel.physics.quasi_static_press import QuasiStaticPress


def hold(time, radius, strength=0.4, depth=1e-3):
    """After a step of depth within a nanosecond."""
    option = PoroelasticDrainage(strength, 1e-8, radius)
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(drainage=option))
    return press.force(np.concatenate([[1e-9], time]), np.full(time.size + 1, depth))[1:]


def test_drains_by_the_square_root_of_time_at_first():
    time = np.array([2.0, 4.0, 8.0])
    xi = 1e-8 * time / 4e-6
    np.testing.assert_allclose(hold(time, 2e-3), 0.5 * (1 - 0.4 * 2 * np.sqrt(xi / np.pi)), rtol=2e-3)


def test_goes_down_to_what_the_solid_carries_alone():
    assert hold(np.array([1e5]), 2e-3)[0] == pytest.approx(0.5 * 0.6, rel=1e-9)


def test_takes_longer_by_the_square_of_the_contact_size():
    time = np.geomspace(1.0, 1e4, 9)
    np.testing.assert_allclose(hold(4.0 * time, 4e-3), hold(time, 2e-3), rtol=1e-7)


def test_a_dome_drains_slower_as_it_sinks_in():
    domed = PoroelasticDrainage(0.4, 1e-8, 5e-3, dome=10e-3)
    np.testing.assert_allclose(domed.contact_radius(np.array([-1.0, 0.2e-3, 1.0])), [0.25e-3, 2e-3, 5e-3])
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(drainage=domed))
    time = np.array([1e-6, 10.0, 20.0])
    kept = [press.force(time, np.full(3, depth))[1] / depth for depth in (0.2e-3, 1e-3)]
    assert kept[0] < 0.99 * kept[1]


def test_off_at_zero():
    np.testing.assert_allclose(hold(np.array([1.0, 100.0]), 2e-3, strength=0.0), 0.5, rtol=1e-14)


@pytest.mark.parametrize("wrong", [(1.0, 1e-8, 1e-3), (0.3, 0.0, 1e-3), (0.3, 1e-8, 0.0), (0.3, 1e-8, 1e-3, 0.0)])
def test_refuses(wrong):
    with pytest.raises(WaveError, match="drainage"):
        PoroelasticDrainage(*wrong)
