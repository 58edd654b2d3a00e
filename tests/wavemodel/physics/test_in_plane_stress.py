import numpy as np
import pytest
from scipy.special import j1

from wavemodel import DiscTool, LayeredWave, NotCoveredError, WaveDiscretisation, WaveError, WaveLayer
from wavemodel.physics.in_plane_stress import AnisotropicTension, InPlaneStress, in_plane_stress

SHEET = WaveLayer("sheet", 1e-3, 1000.0, 1e5, 0.3)


def sheet(pretension):
    return LayeredWave(
        [SHEET],
        DiscTool(20e-3),
        "free",
        WaveDiscretisation(window=200e-3, modes=40, static_correction=False),
        pretension=pretension,
        large_press="linear",
    )


def test_a_sheet_is_a_plate_with_tension():
    """Mode by mode w = q / (D k^4 + h (sigma_x kx^2 + sigma_y ky^2)), a wide load on a thin sheet."""
    wave = sheet((4e3, 1e3))
    domain, bending = wave.press.field.domain, 1e5 * 1e-9 / 12 / (1 - 0.3**2)
    k, share = domain.wavenumber, domain.direction
    x = k * 20e-3
    stress = 4e3 * share + 1e3 * (1 - share)
    plate = 2 * j1(x) / x / (bending * k**4 + 1e-3 * stress * k**2)
    assert wave.press.unit[0] @ domain.axis_weight == pytest.approx(plate @ domain.axis_weight, rel=3e-3)


def test_the_dent_is_longer_along_the_larger_stress():
    wave = sheet((4e3, 1e3))
    surface = wave.surface(np.linspace(-0.05, 0.05, 3), np.linspace(-0.05, 0.05, 3))
    frame = surface.frame(wave.static_state(0.1))[0].copy()
    assert frame[2, 1] > 1.1 * frame[1, 2]
    turned = sheet((1e3, 4e3))
    other = turned.surface(np.linspace(-0.05, 0.05, 3), np.linspace(-0.05, 0.05, 3)).frame(turned.static_state(0.1))[0]
    np.testing.assert_allclose(other, frame.T, rtol=1e-9)


def test_the_automatic_wave_is_what_many_modes_come_to(skin):
    auto = LayeredWave(skin(), DiscTool(5e-3), pretension=2e4, large_press="linear")
    brute = LayeredWave(
        skin(),
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=auto.window, modes=400, sublayers=(1, 4, 6), static_correction=False),
        pretension=2e4,
        large_press="linear",
    )
    np.testing.assert_allclose(auto.press.unit_axis, brute.press.unit_axis, rtol=2e-3)
    assert auto.press.compliance < 0.97 * LayeredWave(skin(), DiscTool(5e-3), large_press="linear").press.compliance


def test_a_rigid_tool_on_stressed_skin_leaves_a_flat_face(skin):
    wave = LayeredWave(skin(), DiscTool(5e-3, "rigid_bonded"), pretension=2e4, large_press="linear")
    solution = wave.run("depth", np.array([1.0]), np.array([1e-4]))
    np.testing.assert_allclose(solution.profile(0, np.linspace(0, 4.5e-3, 10))[0], 1e-4, rtol=5e-3)


def test_equal_stresses_are_one_stress(skin):
    one, two = (
        LayeredWave(skin(), DiscTool(5e-3), pretension=p, large_press="linear").press.compliance
        for p in (2e4, (2e4, 2e4))
    )
    assert one == two
    each = InPlaneStress((2e4,) * 3, (2e4,) * 3)
    assert LayeredWave(skin(), DiscTool(5e-3), pretension=each, large_press="linear").press.compliance == one


def test_off_without_stress(skin):
    assert in_plane_stress(0.0, 3) is None
    assert in_plane_stress(None, 3) is None


def test_vibrates_faster_under_tension(skin):
    assert sheet(1e4).first_frequency > 1.2 * sheet(None).first_frequency


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (-1.0, "-1 Pa"),
        ((1.0, 2.0, 3.0), "one for x and one for y"),
        (InPlaneStress((1.0,), (1.0,)), "1 and 1 stresses for 3 layers"),
    ],
)
def test_refuses(skin, given, message):
    with pytest.raises(WaveError, match=message):
        LayeredWave(skin(), DiscTool(5e-3), pretension=given, large_press="linear")


def test_a_large_press_does_not_cover_it(skin):
    with pytest.raises(NotCoveredError, match="pretension"):
        LayeredWave(skin(), DiscTool(5e-3), pretension=1e4, large_press="corrected")


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


def test_anisotropy_refuses():
    with pytest.raises(WaveError, match="ratio = 0"):
        AnisotropicTension(0.0)
