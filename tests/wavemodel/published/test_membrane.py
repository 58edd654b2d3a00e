import numpy as np
import pytest
from scipy.integrate import dblquad

from wavemodel import PublishedWave, WaveError, WaveLayer
from wavemodel.domains.rectangle import Rectangle
from wavemodel.integrators.oscillators import oscillator_step
from wavemodel.layered.stack.laminate import laminate
from wavemodel.layered.stack.sublayers import consistent_mass, quadratic_stiffness
from wavemodel.published import membrane as printed
from wavemodel.published import table_one


def test_b_11_of_the_equations_and_of_the_slip():
    assert PublishedWave("corrected").coefficient[0, 0] * 1e3 == pytest.approx(31.7788, abs=5e-5)
    assert PublishedWave("as_printed").coefficient[0, 0] * 1e3 == pytest.approx(39.20117, abs=5e-6)


@pytest.mark.parametrize(("m", "n"), [(1, 1), (2, 3), (4, 1)])
def test_coefficients_are_the_double_integrals_of_eq_3(m, n):
    a = printed.SIDE
    integral, _ = dblquad(
        lambda y, x: (
            printed.PARABOLA_X(x) * printed.PARABOLA_Y(y) * np.sin(m * np.pi * x / a) * np.sin(n * np.pi * y / a)
        ),
        0.0, a, 0.0, a, epsabs=1e-10,
    )  # fmt: skip
    expected = 4 * printed.DEPTH_FACTOR / a**2 * integral
    assert PublishedWave(modes=4).coefficient[m - 1, n - 1] * 1e3 == pytest.approx(expected, rel=1e-8)


def test_frequency_as_printed_and_in_si():
    assert PublishedWave("as_printed").frequency[0, 0] == pytest.approx(1.7409, abs=5e-5)
    assert PublishedWave("corrected").frequency[0, 0] == pytest.approx(1740.97, abs=0.01)


def test_mode_sums_converge_to_the_initial_displacement():
    x = np.array([0.3, 0.5, 0.62]) * printed.SIDE * 1e-3
    errors = []
    for modes in (8, 32, 128):
        wave = PublishedWave(modes=modes)
        errors.append(np.abs(wave.deflection(x, x, 0.0) - wave.initial(x, x)).max())
    assert errors[0] > 2 * errors[1] > 4 * errors[2]
    assert errors[2] < 0.02 * printed.DEPTH_FACTOR * 1e-3


def test_deflection_solves_the_wave_equation():
    wave, x = PublishedWave(modes=3), np.array([7e-3])
    h = 1e-6
    at = lambda dx, dy, dt: wave.deflection(x + dx, x + dy, 2e-4 + dt)[0, 0]  # noqa: E731
    acceleration = (at(0, 0, h) - 2 * at(0, 0, 0) + at(0, 0, -h)) / h**2
    d = 1e-5
    laplacian = (at(d, 0, 0) + at(-d, 0, 0) + at(0, d, 0) + at(0, -d, 0) - 4 * at(0, 0, 0)) / d**2
    assert acceleration == pytest.approx(printed.SPEED_SQUARED * laplacian, rel=1e-4)


def test_eq_8_corrected_returns_what_it_was_fed_and_as_printed_the_amplitude_times_that():
    depth = np.array([0.0, 0.2e-3, 0.9e-3])
    middle = 0.5 * printed.SIDE * 1e-3
    corrected, as_printed = PublishedWave("corrected"), PublishedWave("as_printed")
    np.testing.assert_allclose(corrected.replay(depth, middle, middle), depth, atol=1e-15)
    np.testing.assert_allclose(as_printed.replay(depth, middle, middle), 39.20117 * depth, rtol=1e-6, atol=1e-15)


def test_eq_8_off_the_middle():
    wave = PublishedWave("corrected")
    time = wave.time_of_depth(np.array([1e-3]), 5e-3, 9e-3)
    assert wave.deflection(np.array([5e-3]), np.array([9e-3]), time[0])[0, 0] == pytest.approx(1e-3)


@pytest.mark.parametrize(("variant", "depth"), [("as_printed", 1.01e-3), ("corrected", 32e-3)])
def test_eq_8_refuses_depths_beyond_its_reach(variant, depth):
    middle = 0.5 * printed.SIDE * 1e-3
    with pytest.raises(WaveError, match=r"eq\. \(8\) reaches"):
        PublishedWave(variant).time_of_depth(np.array([depth]), middle, middle)


@pytest.mark.parametrize(("options", "message"), [({"variant": "both"}, "'both'"), ({"modes": 0}, "modes = 0")])
def test_refuses(options, message):
    with pytest.raises(WaveError, match=message):
        PublishedWave(**options)


def test_it_is_the_one_layer_one_mode_special_case_of_the_layered_wave():
    """A layer that moves as one, with G / rho = c^2, on one mode of the rectangle, released from B_11."""
    paper = PublishedWave("corrected")
    density, thickness = 1116.0, 1.5e-3
    shear = printed.SPEED_SQUARED * density
    layer = WaveLayer("dermis", thickness, density, 2.9 * shear, 0.45)
    stack = laminate([layer], [(1.0,)], "free")
    domain = Rectangle(paper.side, paper.side, 1)
    rigid = np.array([0.0, 1.0, 0.0, 1.0, 0.0, 1.0])
    stiffness = rigid @ quadratic_stiffness(domain.wavenumber, stack)[0, 0] @ rigid
    mass = rigid @ consistent_mass(stack)[0] @ rigid
    step = oscillator_step(np.array([np.sqrt(stiffness / mass)]), np.zeros(1), 1e-4)
    amplitude, velocity = paper.coefficient[0].copy(), np.zeros(1)
    middle = np.array([0.5 * paper.side])
    for n in range(1, 60):
        step.advance(amplitude, velocity, 0.0, 0.0)
        mode = amplitude[0] * (domain.sines(np.zeros(1)) @ domain.sines(np.zeros(1)).T)[0, 0]
        assert mode == pytest.approx(paper.deflection(middle, middle, n * 1e-4)[0, 0], abs=1e-12)


def test_what_agrees_and_what_does_not():
    rows = table_one()
    assert [row.agrees for row in rows] == [False, True, False, True]
    assert [row.value for row in rows] == pytest.approx([9.24986, 1.74092, 31.7788, 39.20117], rel=1e-5)
    assert all(row.reason for row in rows)
