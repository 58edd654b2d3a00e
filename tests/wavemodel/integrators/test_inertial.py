import numpy as np
import pytest
from scipy.linalg import cholesky, expm

from wavemodel import Damping, DiscTool, LayeredWave, Prony, WaveDiscretisation, WaveError
from wavemodel.layered.dynamics import assemble
from wavemodel.layered.stack.sublayers import consistent_mass, quadratic_stiffness

TRIANGLE = np.concatenate([np.arange(1, 26), np.arange(24, -1, -1)]) / 25.0


def few_modes(layers, damping=None, **options):
    return LayeredWave(
        layers,
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=24e-3, modes=5, sublayers=(1, 1, 1)),
        integrator="exact",
        damping=damping,
        **options,
    )


def dense_history(wave, k, load, damping, step, force):
    """Top deflections (n, L) of one wavenumber by the exponential of its first-order system, in energy coordinates.

    With K = R'R the state is (R q, M^1/2 q'), in which the undamped system is a rotation.
    """
    stack = wave.press.stack
    stiffness = assemble(quadratic_stiffness(np.array([k]), stack), stack.base)[0]
    mass = assemble(consistent_mass(stack), stack.base)
    root, weight = cholesky(stiffness), cholesky(mass)
    d = root.shape[0]
    swap = root @ np.linalg.inv(weight)
    drag = damping.mass_rate * np.eye(d) + damping.stiffness_time * swap.T @ swap
    push = np.zeros(d)
    push[:2] = load
    driven = np.linalg.solve(weight.T, push)
    system = np.block([[np.zeros((d, d)), swap], [-swap.T, -drag]])
    big = np.zeros((2 * d + 2, 2 * d + 2))
    big[: 2 * d, : 2 * d] = system
    big[d : 2 * d, 2 * d] = driven
    big[2 * d, 2 * d + 1] = 1.0
    transfer = expm(big * step)
    state, before, out = np.zeros(2 * d), 0.0, []
    rows = np.linalg.inv(root)[4 * stack.top_of_layer + 1]
    for value in force:
        full = np.concatenate([state, [before, (value - before) / step]])
        state, before = (transfer @ full)[: 2 * d], value
        out.append(rows @ state[:d])
    return np.array(out)


@pytest.mark.parametrize("damping", [Damping(), Damping(300.0, 0.0), Damping(20.0, 2e-5)])
def test_equals_a_dense_solution_of_the_same_equations(skin, damping):
    wave = few_modes(skin(), damping)
    time = np.arange(1, 51) * 2e-4
    solution = wave.run("force", time, TRIANGLE)
    domain, load = wave.press.field.domain, wave.press.load
    expected = sum(
        weight * dense_history(wave, k, f, damping, 2e-4, TRIANGLE)
        for k, f, weight in zip(domain.wavenumber, load, domain.axis_weight, strict=True)
    )
    peak = np.abs(expected).max()
    np.testing.assert_allclose(solution.top_deflection / peak, expected / peak, atol=1e-10)


def test_a_slow_load_gives_the_static_answer(skin):
    time = np.arange(1, 51) * 0.2
    slow = few_modes(skin(), Damping(0.0, 1e-4)).run("force", time, TRIANGLE)
    static = LayeredWave(
        skin(),
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=24e-3, modes=5, sublayers=(1, 1, 1)),
        integrator="quasi_static",
        large_press="linear",
    )
    expected = static.run("force", time, TRIANGLE).top_deflection
    np.testing.assert_allclose(slow.top_deflection, expected, atol=2e-3 * expected.max())


def test_kelvin_voigt_creep_equals_its_closed_form_once_inertia_has_died(skin):
    """The lag is the same for every mode: w = c F (1 - exp(-t / eta)) after a step of force."""
    eta = 0.05
    wave = few_modes(skin(), Damping(0.0, eta))
    time = np.concatenate([[1e-6], np.linspace(0.02, 0.4, 20)])
    solution = wave.run("force", time, np.ones(21))
    expected = wave.press.compliance * (1.0 - np.exp(-time[1:] / eta))
    np.testing.assert_allclose(solution.depth[1:], expected, rtol=2e-3)


def test_does_not_depend_on_how_a_line_is_cut_into_steps(skin):
    wave = few_modes(skin(), Damping(50.0))
    coarse = wave.run("force", np.array([0.003, 0.01]), np.array([1.0, 0.2]))
    time = np.array([0.001, 0.0017, 0.003, 0.004, 0.01])
    fine = wave.run("force", time, np.interp(time, [0, 0.003, 0.01], [0, 1.0, 0.2]))
    np.testing.assert_allclose(fine.top_deflection[[2, 4]], coarse.top_deflection, rtol=1e-9)


@pytest.mark.parametrize("step", [1e-5, 1e-3, 0.1])
@pytest.mark.parametrize("damping", [Damping(), Damping(100.0), Damping(0.0, 1e-3)])
def test_a_rigid_tool_is_driven_by_depth_at_any_step(skin, step, damping):
    wave = LayeredWave(
        skin(),
        DiscTool(5e-3, "rigid_frictionless"),
        discretisation=WaveDiscretisation(window=50e-3, modes=16),
        integrator="exact",
        damping=damping,
        large_press="linear",
    )
    depth = np.minimum(np.arange(1, 301) / 100.0, 1.0) * 1e-3
    solution = wave.run("depth", np.arange(1, 301) * step, depth)
    np.testing.assert_allclose(solution.depth, depth, atol=1e-12)
    static = 1e-3 / wave.press.compliance
    assert np.abs(solution.force).max() < 10.0 * static
    if step == 0.1:
        assert solution.force[-1] == pytest.approx(static, rel=2e-2)


def test_starts_from_the_static_state_of_a_history_that_begins_at_zero(skin):
    wave = few_modes(skin())
    held = wave.run("force", np.array([0.0, 0.001, 0.5]), np.ones(3))
    np.testing.assert_allclose(held.top_deflection, np.tile(wave.press.unit_axis, (3, 1)), rtol=1e-9)


def test_slow_presses_with_and_without_inertia_relax_alike(skin):
    series, modes = Prony((0.4,), (2.0,)), WaveDiscretisation(window=50e-3, modes=16)
    time = np.arange(1, 41) * 0.25
    force, tool = np.minimum(time / 2.0, 1.0), DiscTool(5e-3, "rigid_frictionless")
    damping = Damping(0.0, 1e-3)
    runs = [
        LayeredWave(
            skin(), tool, "bonded", modes, integrator=name, relaxation=series, damping=damping, large_press="linear"
        )
        for name in ("exact", "quasi_static")
    ]
    by_force = [wave.run("force", time, force).depth for wave in runs]
    np.testing.assert_allclose(*by_force, rtol=1e-3)
    by_depth = [wave.run("depth", time, 1e-3 * force) for wave in runs]
    np.testing.assert_allclose(by_depth[0].depth, 1e-3 * force, rtol=1e-9)
    np.testing.assert_allclose(by_depth[0].force[4:], by_depth[1].force[4:], rtol=0.05)
    np.testing.assert_allclose(by_depth[0].force[-1], by_depth[1].force[-1], rtol=2e-3)


def test_refuses_to_drive_one_point_under_a_uniform_pressure(skin):
    with pytest.raises(WaveError, match="rigid tool"):
        few_modes(skin()).run("depth", np.array([0.1]), np.array([1e-4]))
