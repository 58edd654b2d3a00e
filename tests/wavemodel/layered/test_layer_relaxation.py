"""Layers that relax each in its own way."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from wavemodel import Damping, DiscTool, LayeredWave, NotCoveredError, Prony, WaveDiscretisation, WaveError, WaveLayer
from wavemodel.layered.dynamics import assemble
from wavemodel.layered.layer_relaxation import _corresponding, of_shape, one_series, series_of, shared
from wavemodel.layered.stack.sublayers import quadratic_stiffness

SERIES = Prony((0.3,), (1.0,))


def test_one_series_is_for_all_layers():
    assert series_of(SERIES, 3) == (SERIES,) * 3
    assert shared(series_of(SERIES, 3)) == SERIES
    assert series_of(None, 2) == (Prony(),) * 2


def test_layers_may_differ_and_some_be_elastic():
    series = series_of([None, SERIES], 2)
    assert series == (Prony(), SERIES)
    assert shared(series) is None
    with pytest.raises(NotCoveredError, match="inertia"):
        one_series(series)


def test_as_many_series_as_layers():
    with pytest.raises(WaveError, match="1 series for 2 layers"):
        series_of([SERIES], 2)


EACH = [None, Prony((0.3,), (0.5,)), Prony((0.2, 0.25), (0.1, 4.0))]
TRIANGLE = np.concatenate([np.arange(1, 13), np.arange(11, -1, -1)]) / 12.0


def few_modes(layers, **options):
    return LayeredWave(
        layers,
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=24e-3, modes=5, sublayers=(1, 1, 2)),
        integrator="quasi_static",
        **{"large_press": "linear", **options},
    )


def dense_history(wave, k, load, eta, step, force):
    """Top deflections (n, L) of one wavenumber: every branch of every sub-layer as states of one exponential."""
    stack = wave.press.stack
    blocks = quadratic_stiffness(np.array([k]), stack)[0]
    layer = np.searchsorted(stack.top_of_layer, np.arange(stack.sublayers), side="right") - 1
    whole = assemble(blocks[None], stack.base)[0]
    d, branches = whole.shape[0], []
    for s in range(stack.sublayers):
        for g, tau in zip(wave.relaxation[layer[s]].strength, wave.relaxation[layer[s]].time, strict=True):
            alone = np.zeros_like(blocks)
            alone[s] = blocks[s]
            branches.append((g, tau, assemble(alone[None], stack.base)[0]))
    inverse = np.linalg.inv(whole)
    size = d * len(branches)
    push = np.zeros(d)
    push[:2] = load
    if eta:
        rows = [np.concatenate([-np.eye(d), *(g * inverse @ one for g, _, one in branches)], axis=1)[None][0] / eta]
        source = inverse @ push / eta
        follow = [np.concatenate([np.eye(d), np.zeros((d, size))], axis=1)] * len(branches)
        rows += [(one - np.eye(d + size)[d * (i + 1) : d * (i + 2)]) / branches[i][1] for i, one in enumerate(follow)]
        system, drive = np.concatenate(rows), np.concatenate([source, np.zeros(size)])
        first = np.eye(d + size)[:d]
    else:
        back = np.concatenate([g * inverse @ one for g, _, one in branches], axis=1)
        taus = np.repeat([tau for _, tau, _ in branches], d)
        system = (np.tile(back, (len(branches), 1)) - np.eye(size)) / taus[:, None]
        drive = np.tile(inverse @ push, len(branches)) / taus
        first = back
    count = system.shape[0]
    big = np.zeros((count + 2, count + 2))
    big[:count, :count], big[:count, count], big[count, count + 1] = system, drive, 1.0
    transfer, state, before, out = expm(big * step), np.zeros(count), 0.0, []
    rows = 4 * stack.top_of_layer + 1
    for value in force:
        state = (transfer @ np.concatenate([state, [before, (value - before) / step]]))[:count]
        before = value
        out.append((first @ state + (0.0 if eta else value) * (inverse @ push))[rows])
    return np.array(out)


@pytest.mark.parametrize("eta", [0.0, 0.05])
def test_equals_a_dense_solution_of_the_same_equations(skin, eta):
    wave = few_modes(skin(), relaxation=EACH, damping=Damping(0.0, eta))
    time = np.arange(1, 25) * 0.15
    solution = wave.run("force", time, TRIANGLE)
    domain, load = wave.press.field.domain, wave.press.load
    expected = sum(
        weight * dense_history(wave, k, f, eta, 0.15, TRIANGLE)
        for k, f, weight in zip(domain.wavenumber, load, domain.axis_weight, strict=True)
    )
    peak = np.abs(expected).max()
    np.testing.assert_allclose(solution.top_deflection / peak, expected / peak, atol=1e-10)


@pytest.mark.parametrize("eta", [0.0, 0.05])
@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_frictionless"])
def test_depth_control_is_the_inverse_of_force_control(skin, contact, eta):
    """Force that comes out, taken as linear in short steps, gives the depth back as the steps get shorter."""
    wave = LayeredWave(
        skin(), DiscTool(5e-3, contact), relaxation=EACH, damping=Damping(0.0, eta), large_press="linear"
    )
    errors = []
    for count in (50, 100):
        time = np.linspace(0.0, 5.0, count + 1)[1:]
        depth = 1e-3 * np.sin(0.5 * time) ** 2
        driven = wave.run("depth", time, depth)
        np.testing.assert_allclose(driven.depth, depth)
        errors.append(np.abs(wave.run("force", time, driven.force).depth - depth).max() / 1e-3)
    assert errors[1] < (0.03 if eta else 1e-3)
    assert errors[1] < (0.6 if eta else 0.3) * errors[0]


@pytest.mark.parametrize("eta", [0.0, 0.05])
def test_depth_control_does_not_depend_on_how_a_line_is_cut_into_steps(skin, eta):
    wave = few_modes(skin(), relaxation=EACH, damping=Damping(0.0, eta))
    corners, depth = np.array([0.5, 1.5, 4.0]), np.array([1e-3, 1e-3, 2e-4])
    time = np.sort(np.concatenate([corners, np.linspace(0.07, 3.97, 23)]))
    coarse = wave.run("depth", corners, depth)
    fine = wave.run("depth", time, np.interp(time, [0.0, *corners], [0.0, *depth]))
    at = np.searchsorted(time, corners)
    np.testing.assert_allclose(fine.force[at], coarse.force, rtol=1e-9)
    np.testing.assert_allclose(fine.top_deflection[at], coarse.top_deflection, rtol=1e-9)


@pytest.mark.parametrize("eta", [0.0, 0.05])
def test_depth_control_of_nearly_equal_layers_relaxes_by_the_closed_form(skin, eta):
    """F = (G(t) + eta d/dt) of a ramp and hold; a difference of 1e-9 in time sends it through the general way."""
    g, tau, ramp = 0.4, 0.8, 0.5
    wave = few_modes(
        skin(), relaxation=[Prony((g,), (tau * (1 + 1e-9 * i),)) for i in range(3)], damping=Damping(0.0, eta)
    )
    assert wave.body.unit.shape[0] > 1
    time = np.array([0.25, 0.5, 0.75, 1.0, 3.0])
    solution = wave.run("depth", time, 1e-3 * np.minimum(time / ramp, 1.0))
    start, end = np.maximum(time - ramp, 0.0), np.minimum(time, ramp)
    kept = (1 - g) * end + g * tau * (np.exp(-start / tau) - np.exp(-time / tau))
    expected = (kept + eta * (time <= ramp)) / ramp * 1e-3 / wave.press.compliance
    np.testing.assert_allclose(solution.force, expected, rtol=1e-7)


def test_in_the_end_it_is_the_stack_of_the_moduli_that_are_left(skin, oracle):
    """Modes, remainder and profile, under a rigid tool too but for the shift of its traction."""
    layers, series = skin(), [Prony((0.2,), (0.05,)), Prony((0.5,), (0.1,)), Prony((0.4,), (0.3,))]
    left = [
        WaveLayer(one.name, one.thickness, one.density, one.youngs_modulus * fade.long_term, one.poisson_ratio)
        for one, fade in zip(layers, series, strict=True)
    ]
    radii = np.linspace(0.0, 0.02, 9)
    for contact, tolerance in (("uniform_pressure", 1e-3), ("rigid_frictionless", 3e-3)):
        wave = LayeredWave(
            layers,
            DiscTool(5e-3, contact),
            discretisation=WaveDiscretisation(window=80e-3, modes=48),
            relaxation=series,
            large_press="linear",
        )
        other = LayeredWave(
            left,
            DiscTool(5e-3, contact),
            discretisation=WaveDiscretisation(window=80e-3, modes=48),
            large_press="linear",
        )
        found = wave.run("force", np.array([1e-6, 100.0]), np.array([1.0, 1.0]))
        expected = other.run("force", np.array([100.0]), np.array([1.0]))
        assert found.depth[-1] == pytest.approx(expected.depth[0], rel=tolerance)
        flat = 0.001 if contact == "uniform_pressure" else 0.03
        np.testing.assert_allclose(found.profile(1, radii), expected.profile(0, radii), atol=flat * expected.depth[0])
        start = LayeredWave(
            layers,
            DiscTool(5e-3, contact),
            discretisation=WaveDiscretisation(window=80e-3, modes=48),
            large_press="linear",
        ).press.compliance
        assert found.depth[0] == pytest.approx(start, rel=1e-4)


def test_frames_agree_with_the_profile(skin):
    wave = LayeredWave(skin(), DiscTool(5e-3), relaxation=EACH, large_press="linear")
    solution = wave.run("force", np.array([0.5, 1.0]), np.array([1.0, 1.0]))
    x = np.linspace(0.0, 0.015, 7)
    frame = wave.surface(x, np.zeros(1)).frame(solution.faces.snapshot(1))[:, :, 0]
    np.testing.assert_allclose(frame, solution.profile(1, x), atol=2e-6)


def test_series_that_are_alike_are_one_series(skin):
    time, force = np.linspace(0.2, 4.0, 20), np.ones(20)
    series = Prony((0.3, 0.1), (0.5, 3.0))
    one = LayeredWave(skin(), DiscTool(5e-3), relaxation=series, large_press="linear").run("force", time, force)
    each = LayeredWave(skin(), DiscTool(5e-3), relaxation=[series] * 3, large_press="linear").run("force", time, force)
    np.testing.assert_array_equal(one.depth, each.depth)
    almost = Prony((0.3, 0.1), (0.5, 3.0 * (1 + 1e-7)))
    nearly = LayeredWave(skin(), DiscTool(5e-3), relaxation=[series, series, almost], large_press="linear").run(
        "force", time, force
    )
    np.testing.assert_allclose(nearly.top_deflection, one.top_deflection, rtol=1e-6)


def test_refuses(skin):
    with pytest.raises(WaveError, match="2 series for 3 layers"):
        LayeredWave(skin(), DiscTool(5e-3), relaxation=[None, None], large_press="linear")
    with pytest.raises(NotCoveredError, match="each in its own way"):
        LayeredWave(skin(), DiscTool(5e-3), relaxation=EACH, integrator="exact", large_press="linear")


@given(st.floats(0.05, 0.9), st.floats(0.0, 0.95), st.floats(1e-3, 1e3))
def test_a_standard_solid_in_series_with_a_spring_is_one_with_another_time(g, spring, time):
    """Compliances add: k = 1 / (a + (1 - a) / m) relaxes with tau / (1 - a g) (Christensen 1982, section 1.6)."""
    at = [1.0 / (spring + (1.0 - spring) / m) for m in (1.0 - 0.5 * g, 1.0 - g)]
    found = _corresponding(Prony((g,), (time,)), *at)
    assert found.time == pytest.approx((time / (1.0 - spring * g),))
    assert found.long_term == pytest.approx(at[1])


@given(st.floats(0.0, 0.95), st.lists(st.floats(0.05, 0.3), min_size=1, max_size=3))
def test_a_spring_beside_takes_its_share_and_no_time(beside, strength):
    series = Prony(tuple(strength), tuple(0.1 * 7.0**n for n in range(len(strength))))
    at = [beside + (1.0 - beside) * m for m in (0.5 * (1.0 + series.long_term), series.long_term)]
    found = _corresponding(series, *at)
    order = np.argsort(found.time)
    assert np.array(found.time)[order] == pytest.approx(series.time)
    assert np.array(found.strength)[order] == pytest.approx((1.0 - beside) * np.array(strength))


def test_the_series_of_a_stack_follows_its_elastic_stiffness():
    """Along the way, by the definition of the correspondence: s times the transform of the relaxation is k(m(s))."""
    layers = [WaveLayer("a", 2e-3, 1e3, 1e5, 0.40), WaveLayer("b", 4e-3, 1e3, 3e4, 0.45)]
    series, tool = Prony((0.3, 0.4), (0.3, 5.0)), DiscTool(5e-3, "rigid_bonded")

    def compliance(changed):
        return LayeredWave(changed, tool, large_press="linear").press.compliance

    def of_modulus(left):
        changed = []
        for one in layers:
            shear, bulk = left * one.shear_modulus, one.lame_modulus + 2.0 * one.shear_modulus / 3.0
            ratio = (3.0 * bulk - 2.0 * shear) / (6.0 * bulk + 2.0 * shear)
            changed.append(WaveLayer(one.name, one.thickness, 1e3, 2.0 * shear * (1.0 + ratio), ratio))
        return compliance(layers) / compliance(changed)

    def transform(one, s):
        return 1.0 - sum(g / (1.0 + s * time) for g, time in zip(one.strength, one.time, strict=True))

    found = of_shape(layers, (series, series), compliance(layers), compliance)
    assert found[0] == found[1]
    for s in (1e-3, 0.05, 0.3, 1.0, 5.0, 1e3):
        assert transform(found[0], s) == pytest.approx(of_modulus(transform(series, s)), rel=2e-3)


def test_layers_that_keep_their_volume_or_do_not_relax_stay_as_they_are():
    layers = [WaveLayer("a", 2e-3, 1e3, 1e5, 0.4999), WaveLayer("b", 4e-3, 1e3, 3e4, 0.45)]
    series = (Prony((0.3,), (1.0,)), Prony())
    assert of_shape(layers, series, 1.0, pytest.fail) == series


def test_what_relaxes_is_one_of_two():
    with pytest.raises(WaveError, match="relaxing = 'bulk' is not allowed: one of moduli, shape"):
        LayeredWave([WaveLayer("a", 2e-3, 1e3, 1e5, 0.4)], DiscTool(5e-3), relaxing="bulk")
