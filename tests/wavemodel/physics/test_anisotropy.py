import numpy as np
import pytest

from wavemodel import WaveError
from wavemodel.physics.anisotropy import AnisotropicTension

X, Y = np.meshgrid(np.linspace(-4e-3, 4e-3, 9), np.linspace(-3e-3, 3e-3, 8))


def test_the_dent_of_a_point_solves_the_equation_of_the_sheet():
    """ln r' satisfies T_x w_xx + T_y w_yy = 0 away from the point."""
    rho, h = 3.0, 1e-5
    dent = AnisotropicTension(rho)

    def w(x, y):
        return np.log(dent.radius(x, y))

    xx = (w(X + h, Y) - 2 * w(X, Y) + w(X - h, Y)) / h**2
    yy = (w(X, Y + h) - 2 * w(X, Y) + w(X, Y - h)) / h**2
    np.testing.assert_allclose(rho * xx + yy, 0.0, atol=2e-3 * np.abs(xx).max())


def test_the_gradient_is_that_of_the_field():
    dent, h = AnisotropicTension(0.4), 1e-8
    found = dent.gradient(X, Y, 2.0 * dent.radius(X, Y))
    expected = [
        (dent.radius(X + h, Y) ** 2 - dent.radius(X - h, Y) ** 2) / (2 * h),
        (dent.radius(X, Y + h) ** 2 - dent.radius(X, Y - h) ** 2) / (2 * h),
    ]
    np.testing.assert_allclose(found, expected, atol=1e-8)


def test_off_at_one():
    np.testing.assert_allclose(AnisotropicTension(1.0).radius(X, Y), np.hypot(X, Y))


def test_areas_are_kept():
    """The transformation has the determinant one: contours keep their area, so the mean dent stays."""
    dent = AnisotropicTension(5.0)
    unit = dent.radius(np.array([1.0, 0.0]), np.array([0.0, 1.0]))
    assert unit.prod() == pytest.approx(1.0)


def test_refuses():
    with pytest.raises(WaveError, match="ratio = 0"):
        AnisotropicTension(0.0)
