import numpy as np
import pytest

from wavemodel import Prony, WaveError
from wavemodel.physics.contact import Adhesion, PermanentSet
from wavemodel.physics.quasi_static_press import Physics, QuasiStaticPress, joined
from wavemodel.physics.time_dependent import PoroelasticDrainage, ViscousDamping

SERIES = Prony((0.3, 0.2), (0.4, 6.0))


def test_a_ramp_and_hold_is_the_closed_form():
    """F = K v int G over the ramp: (1 - sum g) t + sum g tau (1 - e^(-t / tau)), shifted in the hold."""
    time, ramp, g, tau = np.linspace(0.1, 12.0, 120), 2.0, np.array([0.3, 0.2]), np.array([0.4, 6.0])
    found = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES)).force(time, np.minimum(time, ramp) * 1e-3)
    start, end = np.maximum(time - ramp, 0.0)[:, None], np.minimum(time, ramp)
    fading = (g * tau * (np.exp(-start / tau) - np.exp(-time[:, None] / tau))).sum(axis=1)
    np.testing.assert_allclose(found, 0.5 * (0.5 * end + fading), rtol=1e-12)


def test_forgets():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES))
    time = np.array([1.0, 2.0, 3.0, 300.0, 301.0])
    again = press.force(time, np.array([1e-3, 3e-3, 0.0, 0.0, 1e-3]))
    assert again[-1] == pytest.approx(again[0], rel=1e-12)


def test_a_history_that_begins_at_zero_begins_relaxed():
    held = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES)).force(
        np.array([0.0, 5.0]), np.full(2, 1e-3)
    )
    np.testing.assert_allclose(held, 0.25)


def test_a_tool_lifted_faster_than_the_tissue_follows_is_not_pulled():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES))
    force = press.force(np.array([1.0, 60.0, 60.1, 60.2]), np.array([3e-3, 3e-3, 0.1e-3, 0.1e-3]))
    assert force[1] == pytest.approx(0.75, rel=1e-3)
    np.testing.assert_array_equal(force[2:], 0.0)


def unilateral(time, depth, fine=400):
    """Force and depth (n,) of a surface that creeps back by itself, by small steps: y_j' = (g_j e - y_j) / tau_j."""
    g, tau = np.array(SERIES.strength), np.array(SERIES.time)
    lags, before, deep, force, stands = np.zeros(2), 0.0, 0.0, [], []
    for now, goal in zip(time, depth, strict=True):
        step = (now - before) / fine
        for k in range(fine):
            tool = 500.0 * max(deep + (k + 1) / fine * (goal - deep), 0.0)
            elastic = max(tool, lags.sum())
            lags += step * (g * elastic - lags) / tau
        before, deep = now, goal
        force.append(max(tool - lags.sum(), 0.0))
        stands.append(max(tool, lags.sum()) / 500.0)
    return np.array(force), np.array(stands)


TURNS = [0.0, 0.5, 3.0, 3.05, 3.4, 3.6, 5.0]


@pytest.mark.parametrize("up", [0.1e-3, -1e-3])
@pytest.mark.parametrize(("rows", "close"), [(50, 8e-3), (400, 1e-3)])
def test_a_tool_that_comes_back_meets_the_surface_where_it_has_crept_to(up, rows, close):
    """With the memory of a tool that sticks the second press was up to 7 and 12 % stronger."""
    time = np.union1d(np.linspace(5.0 / rows, 5.0, rows), TURNS[1:])
    depth = np.interp(time, TURNS, [0.0, 2e-3, 2e-3, up, up, 2e-3, 2e-3])
    found = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES)).trace(time, depth)
    force, stands = unilateral(time, depth)
    np.testing.assert_allclose(found.force, force, atol=close)
    np.testing.assert_allclose(found.surface, stands, atol=2e-3 * close)
    assert found.surface[~found.touching].min() > 0.4e-3


def test_a_tool_that_is_withdrawn_slowly_loses_nothing():
    """Boltzmann's integral of a ramp down, as if it stuck, as long as that is a push."""
    time = np.linspace(0.1, 12.0, 120)
    depth = np.interp(time, [0.0, 1.0, 12.0], [0.0, 2e-3, 1e-3])
    found = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES)).force(time, depth)
    g, tau = np.array([0.3, 0.2]), np.array([0.4, 6.0])

    def ramped(t):
        return 0.5 * t + (g * tau * -np.expm1(-t[:, None] / tau)).sum(axis=1)  # K v = 1 N/s

    expected = ramped(time) - (1.0 + 0.5 / 11.0) * ramped(np.maximum(time - 1.0, 0.0))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_a_damped_surface_comes_back_in_its_time():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(damping=ViscousDamping(0.2)))
    found = press.trace(np.array([1.0, 1.001, 1.1, 1.2, 1.3]), np.array([1e-3, 0.0, 0.0, 0.0, 0.9e-3]))
    np.testing.assert_allclose(found.surface[1:4], 1e-3 * np.exp(-np.array([0.001, 0.1, 0.2]) / 0.2), rtol=6e-3)
    assert found.force[-1] == pytest.approx(500.0 * (0.9e-3 + 0.2 * (0.9e-3 - found.surface[3]) / 0.1))


@pytest.mark.parametrize("damping", [None, ViscousDamping(0.2)])
def test_a_sample_without_a_duration_lets_nothing_creep(damping):
    """Lost in such a sample, or free over it, the surface stands after it as without it; damped it does not move."""
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES, damping=damping))
    _, held = press.follow(np.array([0.1, 3.0]), np.array([2e-3, 2e-3]), press.rest())
    lost, away = press.follow(np.array([0.0 if damping else 1e-9]), np.zeros(1), held)
    steps = np.full(20, 0.05)
    plain, _ = press.follow(steps, np.zeros(20), away)
    after, _ = press.follow(np.append(0.0, steps), np.zeros(21), away)
    assert lost.surface[-1] == pytest.approx(2e-3 if damping else 0.8e-3, rel=0.2)
    assert plain.surface[-1] < 0.9 * lost.surface[-1]
    np.testing.assert_allclose(after.surface, np.append(lost.surface, plain.surface), rtol=1e-6)


def test_drained_tissue_fills_again_before_it_is_met_where_it_was():
    """F = 0 with one lag after the other: sample by sample, the depth at which a held body answers with nothing."""
    option = PoroelasticDrainage(0.5, 1e-6, 2e-3)
    press = QuasiStaticPress(lambda d: 200.0 * d + 4e4 * d**2, Physics(relaxation=SERIES, drainage=option))
    time = np.linspace(0.01, 5.0, 500)
    found = press.trace(time, np.interp(time, TURNS, [0.0, 1e-3, 1e-3, 0.0, 0.0, 1e-3, 1e-3]))
    free = np.flatnonzero(~found.touching)
    assert free.size > 30
    state = press.rest()
    for duration, depth, touching in zip(np.diff(time, prepend=0.0), found.surface, found.touching, strict=True):
        trace, state = press.follow(np.array([duration]), np.array([depth]), state, held=True)
        if not touching:
            assert abs(trace.force[0]) < 2e-5


def test_a_surface_drains_alike_however_it_is_cut_and_however_far_the_tool_is_away():
    """Under an edge by the depth at which it was last touched, which depends on where it is lost and met."""
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(drainage=PoroelasticDrainage(0.5, 1e-6, 2e-3, 2e-3)))
    time = np.linspace(0.02, 5.0, 250)
    duration, surfaces = np.diff(time, prepend=0.0), []
    for up in (0.05e-3, -1e-3):
        depth = np.interp(time, TURNS, [0.0, 1e-3, 1e-3, 0.0, 0.0, 1e-3, 1e-3])
        depth = np.where((time > 3.0) & (time < 3.4), up, depth)
        whole, state, parts = press.trace(time, depth), press.rest(), []
        for step, goal in zip(duration, depth, strict=True):
            part, state = press.follow(np.array([step]), np.array([goal]), state)
            parts.append(part)
        np.testing.assert_allclose(joined(parts).surface, whole.surface, rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(joined(parts).force, whole.force, rtol=1e-9, atol=1e-12)
        assert (~whole.touching).sum() > 15
        surfaces.append(whole.surface)
    np.testing.assert_allclose(*surfaces, rtol=1e-9, atol=1e-15)


def test_a_surface_that_keeps_a_set_is_free_where_it_would_answer_with_nothing():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES, permanent_set=PermanentSet(0.3)))
    time = np.linspace(0.01, 5.0, 500)
    found = press.trace(time, np.interp(time, TURNS, [0.0, 1e-3, 1e-3, 0.0, 0.0, 1e-3, 1e-3]))
    assert (~found.touching).sum() > 30
    held, _ = press.follow(np.diff(time, prepend=0.0), found.surface, press.rest(), held=True)
    assert np.abs(held.force[~found.touching]).max() < 1e-6


def test_adhesion_holds_a_tissue_that_relaxes_up_to_its_force():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES, adhesion=Adhesion(0.1)))
    time = np.linspace(0.01, 5.0, 500)
    found = press.trace(time, np.interp(time, TURNS, [0.0, 1e-3, 1e-3, 0.0, 0.0, 1e-3, 1e-3]))
    assert -0.1 <= found.force.min() < -0.05
    assert found.touching[found.force < 0.0].all()
    assert not found.touching.all()


def test_what_adhesion_holds_is_lost_like_nothing_where_it_is_little():
    time = np.linspace(0.01, 5.0, 500)
    depth = np.interp(time, TURNS, [0.0, 1e-3, 1e-3, 0.0, 0.0, 1e-3, 1e-3])
    loose, sticky = (
        QuasiStaticPress(lambda d: 500.0 * d, Physics(relaxation=SERIES, adhesion=adhesion)).force(time, depth)
        for adhesion in (None, Adhesion(1e-9))
    )
    np.testing.assert_allclose(sticky, loose, atol=1e-8)


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


def test_a_ball_touches_as_hertz_says():
    ball = PoroelasticDrainage(0.4, 1e-8, 5e-3, 5e-3)
    depth = np.array([-1.0, 0.2e-3, 1e-3, 1.0])
    np.testing.assert_allclose(ball.contact_radius(depth), [0.25e-3, 1e-3, np.sqrt(5.0) * 1e-3, 5e-3], rtol=1e-9)


@pytest.mark.parametrize("touched", [3.2e-3, 4.0e-3, 4.9e-3])
def test_a_rounded_edge_touches_as_sneddon_says(touched):
    flat, edge = 3e-3, 2e-3
    angle = np.linspace(np.arcsin(flat / touched), 0.5 * np.pi, 20001)
    sunk = touched * np.trapezoid((touched * np.sin(angle) - flat) / edge, angle)
    contact = PoroelasticDrainage(0.4, 1e-8, flat + edge, edge).contact_radius(np.array([0.0, sunk]))
    np.testing.assert_allclose(contact, [flat, touched], rtol=1e-5)


def test_a_ball_drains_slower_as_it_sinks_in():
    press = QuasiStaticPress(lambda d: 500.0 * d, Physics(drainage=PoroelasticDrainage(0.4, 1e-8, 5e-3, 5e-3)))
    time = np.array([1e-6, 10.0, 20.0])
    kept = [press.force(time, np.full(3, depth))[1] / depth for depth in (0.2e-3, 1e-3)]
    assert kept[0] < 0.99 * kept[1]


def test_drainage_is_off_at_zero():
    np.testing.assert_allclose(hold(np.array([1.0, 100.0]), 2e-3, strength=0.0), 0.5, rtol=1e-14)


@pytest.mark.parametrize("wrong", [(1.0, 1e-8, 1e-3), (0.3, 0.0, 1e-3), (0.3, 1e-8, 0.0), (0.3, 1e-8, 1e-3, 1.1e-3)])
def test_drainage_refuses(wrong):
    with pytest.raises(WaveError, match="drainage"):
        PoroelasticDrainage(*wrong)


DAMPED = Physics(damping=ViscousDamping(0.2))


def test_adds_the_speed_times_eta_and_stiffness(press):
    depth = np.linspace(0.0, 2e-3, 21)[1:]
    np.testing.assert_allclose(press(DAMPED, depth, speed=1e-2), 500.0 * (depth + 0.2 * 1e-2), rtol=1e-12)


def test_is_gone_in_a_hold(press):
    depth = np.array([1e-3, 2e-3, 2e-3])
    assert press(DAMPED, depth)[-1] == pytest.approx(1.0)


def test_loses_energy_with_the_speed(press, path):
    depth = path(1e-3, 3e-3, 2e-3, 3e-3, points=2001)
    cycle = slice(np.argmax(depth), None)
    lost = [np.trapezoid(press(DAMPED, depth, speed)[cycle], depth[cycle]) for speed in (1e-3, 2e-3)]
    assert lost[1] / lost[0] == pytest.approx(2.0, rel=1e-2)
    assert lost[0] == pytest.approx(500.0 * 0.2 * 1e-3 * 2e-3, rel=1e-2)


def test_damping_is_off_at_zero(press, path):
    depth = path(0.0, 3e-3, 0.0)
    np.testing.assert_array_equal(press(Physics(damping=ViscousDamping(0.0)), depth), 500.0 * depth)


def test_damping_refuses():
    with pytest.raises(WaveError, match="retardation = -1 s"):
        ViscousDamping(-1.0)
