"""The statistics of the time gate on synthetic timings of a known product on a drifting machine."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from benchmark.gate.statistics import caught, change, false_alarm, log_ratio, power, trimmed_mean

LIMIT = math.log(1.12)
PROCESSES = 4
BLOCKS = 24


def process(generator: np.random.Generator, *, slower: float = 0.0, drift: float = 0.0) -> float:
    """The log ratio of one process: the machine slows work and references alike, each block has noise and spikes."""
    machine = np.exp(drift + 0.3 * generator.random(BLOCKS))
    noise, spikes = generator.normal(0.0, 0.03, (3, BLOCKS)), generator.pareto(3.0, (3, BLOCKS))
    own = np.exp(noise + 0.02 * spikes) * machine
    layout = generator.normal(0.0, 0.015)
    return log_ratio(np.exp(0.7 + slower + layout) * own[0], own[1:])


def estimates(seed: int, *, slower: float, checks: int = 300) -> np.ndarray:
    generator = np.random.default_rng(seed)
    found = []
    for _ in range(checks):
        base = [process(generator) for _ in range(6)]
        now = [process(generator, slower=slower, drift=0.5) for _ in range(PROCESSES)]
        found.append(change(now, base, paired=False, seed=0).estimate)
    return np.array(found)


def test_an_unchanged_product_is_not_called_slower_while_the_machine_slows_down() -> None:
    found = estimates(1, slower=0.0)
    assert (found > LIMIT).sum() == 0
    assert abs(found.mean()) < 0.005


def test_a_quarter_slower_is_always_found() -> None:
    found = estimates(2, slower=math.log(1.25))
    assert (found > LIMIT).sum() == found.size
    assert found.mean() == pytest.approx(math.log(1.25), abs=0.005)


def test_without_references_the_same_machine_would_give_alarms() -> None:
    generator = np.random.default_rng(3)
    machine = np.exp(0.5 + 0.3 * generator.random(BLOCKS))
    flat = np.ones((2, BLOCKS))
    assert log_ratio(machine, flat) > LIMIT
    assert log_ratio(machine, np.stack([machine, machine])) == pytest.approx(0.0, abs=1e-12)


def test_pairs_cancel_what_a_round_has_in_common() -> None:
    generator = np.random.default_rng(4)
    rounds = generator.normal(0.0, 0.2, 6)
    base = rounds + generator.normal(0.0, 0.005, 6)
    now = rounds + 0.1 + generator.normal(0.0, 0.005, 6)
    paired, apart = (change(now, base, paired=each, seed=0) for each in (True, False))
    assert paired.estimate == pytest.approx(0.1, abs=0.01)
    assert paired.high - paired.low < 0.1 * (apart.high - apart.low)
    assert paired.noise < 0.1 * apart.noise


def test_the_interval_covers_about_as_often_as_said() -> None:
    generator = np.random.default_rng(5)
    hits = 0
    for _ in range(400):
        found = change(generator.normal(0, 0.02, 6), generator.normal(0, 0.02, 6), paired=False, seed=1)
        hits += found.low <= 0.0 <= found.high
    assert 0.80 < hits / 400 < 0.97


def test_the_same_seed_gives_the_same_interval() -> None:
    now, base = [0.1, 0.12, 0.09], [0.0, 0.01, 0.02]
    assert change(now, base, paired=False, seed=7) == change(now, base, paired=False, seed=7)


def test_a_single_process_has_no_noise_to_speak_of() -> None:
    found = change([0.2], [0.1], paired=False, seed=0)
    assert found.estimate == pytest.approx(0.1)
    assert (found.low, found.high) == pytest.approx((0.1, 0.1))
    assert math.isnan(found.noise)


def test_standard_error_is_that_of_two_samples() -> None:
    now, base = np.array([0.10, 0.13, 0.12, 0.11]), np.array([0.0, 0.02, 0.01])
    expected = math.sqrt(stats.sem(now) ** 2 + stats.sem(base) ** 2)
    assert change(now, base, paired=False, seed=0).noise == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("cut", [0.0, 0.1, 0.2, 0.4])
@pytest.mark.parametrize("count", [1, 4, 5, 24])
def test_the_trimmed_mean_is_scipys(cut: float, count: int) -> None:
    values = np.random.default_rng(6).normal(size=count)
    assert trimmed_mean(values, cut) == pytest.approx(stats.trim_mean(values, cut), rel=1e-12)


def test_chances_of_error_are_those_of_a_normal_error() -> None:
    assert false_alarm(LIMIT, 0.03) == pytest.approx(stats.norm.sf(LIMIT / 0.03), rel=1e-12)
    assert power(math.log(1.25), LIMIT, 0.03) == pytest.approx(
        stats.norm.sf((LIMIT - math.log(1.25)) / 0.03), rel=1e-12
    )
    slowdown = caught(LIMIT, 0.03)
    assert power(slowdown, LIMIT, 0.03) == pytest.approx(0.95, rel=1e-9)
    assert false_alarm(LIMIT, 0.02) < 1e-7 < 1e-3 < false_alarm(LIMIT, 0.04)


@given(
    factor=st.floats(1e-3, 1e3),
    seconds=st.lists(st.floats(1e-6, 10.0), min_size=3, max_size=30),
)
def test_a_machine_that_is_slower_throughout_changes_nothing(factor: float, seconds: list[float]) -> None:
    times = np.array(seconds)
    references = np.stack([times[::-1] + 1e-4, times + 1e-3])
    assert log_ratio(factor * times, factor * references) == pytest.approx(log_ratio(times, references), abs=1e-9)
