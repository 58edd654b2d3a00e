"""A hand's device on the tissue: the right force, nothing given back that was not put in, streams replayed."""

import numpy as np
import pytest

from wavemodel import Prony, WaveError
from wavemodel.control import (
    EnergyBound,
    HapticLoop,
    InteractiveTissue,
    RecordedDevice,
    SimulatedDevice,
    layered_body,
    with_quick_law,
)

DT = 1e-3
PLACE = (40e-3, 30e-3)


@pytest.fixture(scope="module")
def body(wave, grid):
    return with_quick_law(layered_body(wave, grid))


def stream(depth):
    """Positions (n, 3) at one place through depths (n,), m; negative in the air."""
    return np.column_stack([np.full(depth.size, PLACE[0]), np.full(depth.size, PLACE[1]), depth])


def loop_on(body, grid, depth, bound=None, **tissue):
    device = RecordedDevice(DT * np.arange(depth.size), stream(depth), DT)
    return HapticLoop(InteractiveTissue(body, grid, **tissue), [device], DT, bound)


def cycles(count, rng, deepest):
    """Press, hold, release, wait in the air: random depths, speeds and waits; depths and where each cycle ends."""
    pieces, ends = [], []
    for _ in range(count):
        depth, waits = rng.uniform(0.02, 1.0) * deepest, rng.integers(2, 8, 2)
        way_in, way_out = (2 + int((depth + 1e-4) / (DT * rng.uniform(0.02, 0.14))) for _ in range(2))
        pieces += [
            np.linspace(-1e-4, depth, way_in + 1),
            np.full(waits[0], depth),
            np.linspace(depth, -1e-4, way_out + 1),
            np.full(waits[1], -1e-4),
        ]
        ends.append(sum(map(len, pieces)) if not ends else ends[-1] + sum(map(len, pieces[-4:])))
    return np.concatenate(pieces), np.array(ends)


def gained(forces, depth, ends):
    """(cycles,) what each cycle gave to the hand, J: a force is held until the next sample."""
    work = np.append(0.0, np.cumsum(-forces[:-1] * np.diff(depth)))
    return np.diff(np.append(0.0, work[ends - 1]))


@pytest.mark.parametrize(
    ("count", "series"), [(200, Prony()), (1000, Prony((0.3, 0.2), (0.03, 0.5)))], ids=["elastic", "with memory"]
)
def test_random_presses_give_the_hand_no_energy(body, grid, count, series):
    depth, ends = cycles(count, np.random.default_rng(16), 1.6e-3)
    loop = loop_on(body, grid, depth, EnergyBound, series=series)
    forces, [bound] = loop.run(depth.size)[:, 0], loop.bounds
    gain = gained(forces, depth, ends)
    assert bound.overspeed == 0
    assert gain.max() <= 1e-15
    assert forces.max() > 0.9 * body.elastic(1.3e-3) * series.long_term


def test_without_the_bound_an_elastic_tissue_gives_energy_away(body, grid):
    depth, ends = cycles(50, np.random.default_rng(16), 3e-3)
    forces = loop_on(body, grid, depth).run(depth.size)[:, 0]
    assert (gained(forces, depth, ends) > 0.0).mean() > 0.9


def test_touches_drawn_back_at_once_gain_no_more_than_the_loan(body, grid):
    depth = np.tile([-1e-4, 4e-5, 1e-5, -1e-4], 500)
    loop = loop_on(body, grid, depth, EnergyBound)
    forces = loop.run(depth.size)[:, 0]
    assert np.cumsum(-forces[:-1] * np.diff(depth)).max() <= loop.bounds[0].loan


def test_the_bound_leaves_a_press_as_it_is(body, grid):
    depth = np.concatenate([np.linspace(-1e-4, 2e-3, 200), np.full(50, 2e-3), np.linspace(2e-3, 1e-3, 100)])
    plain, bounded = (loop_on(body, grid, depth, bound).run(depth.size)[:, 0] for bound in (None, EnergyBound))
    np.testing.assert_array_equal(bounded, plain)
    np.testing.assert_allclose(plain, [body.elastic(max(one, 0.0)) for one in depth], rtol=1e-12)


def test_the_quick_law_is_the_law(wave, grid, body):
    exact = layered_body(wave, grid)
    for depth in (0.0, 1e-5, 1.234e-3, body.deepest):
        assert body.elastic(depth) == pytest.approx(exact.elastic(depth), rel=1e-9)


def test_a_simulated_hand_sinks_in_until_both_springs_agree(body, grid):
    device = SimulatedDevice(lambda _: np.array([*PLACE, 3e-3]), DT)
    device.position[2] = -1e-3
    loop = HapticLoop(InteractiveTissue(body, grid), [device], DT)
    loop.run(3000)
    stiffness = body.elastic(1e-3) / 1e-3
    assert device.position[2] == pytest.approx(3e-3 * 400.0 / (400.0 + stiffness), rel=1e-3)
    assert device.force[2] == pytest.approx(-400.0 * (3e-3 - device.position[2]), rel=1e-3)
    assert device.energy < 0.0


def test_a_tool_off_the_tissue_or_too_deep_is_no_fault(body, grid):
    x = np.array([40e-3, 40e-3, 200e-3, 40e-3, 40e-3])
    depth = np.array([1e-3, 1.0, 1e-3, 1e-3, -1e-3])
    device = RecordedDevice(DT * np.arange(5), np.column_stack([x, np.full(5, 30e-3), depth]), DT)
    forces = HapticLoop(InteractiveTissue(body, grid), [device], DT, None).run(5)[:, 0]
    assert forces[1] == pytest.approx(body.elastic(body.deepest))
    np.testing.assert_array_equal(forces[[2, 4]], 0.0)
    assert forces[0] == forces[3] > 0.0


def test_two_hands_share_a_tissue(body, grid):
    tissue = InteractiveTissue(body, grid)
    hands = [RecordedDevice(np.array([0.0, 1.0]), np.tile([x, 30e-3, 1e-3], (2, 1)), DT) for x in (30e-3, 37e-3)]
    forces = HapticLoop(tissue, hands, DT, None).run(5)[-1]
    alone = loop_on(body, grid, np.full(3, 1e-3)).run(3)[-1, 0]
    assert 0.0 < forces[1] < alone


@pytest.mark.parametrize(
    ("time", "position"),
    [
        ([0.0, 0.0], np.zeros((2, 3))),
        ([0.0, 1.0], np.zeros((2, 2))),
        ([0.0, 1.0], np.full((2, 3), np.nan)),
        ([0.0], np.zeros((1, 3))),
    ],
)
def test_unusable_streams_are_refused(time, position):
    with pytest.raises(WaveError, match="stream"):
        RecordedDevice(np.array(time), position)


class StutteringDevice(RecordedDevice):
    """Every seventh sample is no number."""

    def read(self):
        at = super().read()
        return np.full(3, (np.nan, np.inf)[self._next % 2]) if self._next % 7 == 0 else at


def test_samples_that_are_no_numbers_are_dropped_and_give_nothing_away(body, grid):
    depth, _ends = cycles(50, np.random.default_rng(3), 1.6e-3)
    device = StutteringDevice(DT * np.arange(depth.size), stream(depth), DT)
    loop = HapticLoop(InteractiveTissue(body, grid, series=Prony((0.3,), (0.1,))), [device], DT, EnergyBound)
    forces = loop.run(depth.size)[:, 0]
    felt = np.where(np.arange(1, depth.size + 1) % 7 == 0, np.append(0.0, depth[:-1]), depth)
    assert loop.dropped == depth.size // 7
    assert np.isfinite(forces).all()
    assert np.cumsum(-forces[:-1] * np.diff(felt)).max() <= loop.bounds[0].loan


def test_a_loop_needs_a_tool_and_a_time(body, grid):
    tissue, device = InteractiveTissue(body, grid), RecordedDevice(np.array([0.0, 1.0]), np.zeros((2, 3)))
    with pytest.raises(WaveError, match="contact"):
        HapticLoop(tissue, [device] * 5)
    with pytest.raises(WaveError, match="dt"):
        HapticLoop(tissue, [device], dt=0.0)
