import numpy as np
import pytest

from fem.assembly.sliding import Sliding


def test_it_gives_elastically_slides_at_the_limit_and_comes_back():
    slider = Sliding(np.array([1]), np.array([2.0]), np.array([3.0]), np.zeros(1))
    force, slope = [], []
    for u in (1.0, 1.5, 4.0, 3.0, 0.5):
        y = np.array([9.0, u])
        force.append(slider.force(y)[0])
        slope.append(slider.stiffness(y)[0])
        slider = slider.after(y)
    np.testing.assert_allclose(force, [2.0, 3.0, 3.0, 1.0, -3.0])
    np.testing.assert_allclose(slope, [2.0, 2.0, 0.0, 2.0, 0.0])
    np.testing.assert_allclose(slider.anchor, [2.0])


def test_the_stiffness_is_the_derivative_of_the_force():
    slider = Sliding(np.arange(3), np.array([1.0, 2.0, 3.0]), np.ones(3), np.array([0.0, 0.1, -5.0]))
    y, step = np.array([0.5, -0.2, 0.3]), 1e-7
    slope = (slider.force(y + step) - slider.force(y - step)) / (2.0 * step)
    np.testing.assert_allclose(slider.stiffness(y), slope, atol=1e-8)


@pytest.mark.parametrize(("moved", "everywhere"), [(0.9, False), (1.1, True)])
def test_everywhere(moved, everywhere):
    slider = Sliding(np.arange(2), np.ones(2), np.ones(2), np.zeros(2))
    assert slider.everywhere(np.array([2.0, moved])) is everywhere
