"""Levels of a series: steps that are there are found, noise makes none."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmark.gate.history.steps import level_steps


@settings(max_examples=50, deadline=None)
@given(
    lengths=st.lists(st.integers(2, 12), min_size=1, max_size=4),
    heights=st.lists(st.integers(-5, 5).filter(bool), min_size=4, max_size=4),
)
def test_levels_without_scatter_are_found_exactly(lengths: list[int], heights: list[int]) -> None:
    levels = np.cumsum(heights)[: len(lengths)]
    found = level_steps(np.repeat(levels, lengths), least=1)
    assert [step.place for step in found] == np.cumsum(lengths)[:-1].tolist()
    np.testing.assert_allclose([step.after for step in found], levels[1:])
    np.testing.assert_allclose([step.before for step in found], levels[:-1])


@pytest.mark.parametrize("length", [10, 30, 100])
def test_noise_makes_few_steps_and_a_jump_of_five_scatters_is_seen(length: int) -> None:
    generator = np.random.default_rng(3)
    silent = [level_steps(generator.normal(size=length), least=2) for _ in range(100)]
    assert sum(map(bool, silent)) <= 8
    jump = np.where(np.arange(length) < length // 2, 0.0, 5.0)
    seen = [level_steps(generator.normal(size=length) + jump, least=2) for _ in range(100)]
    assert sum(len(steps) == 1 and abs(steps[0].place - length // 2) <= 1 for steps in seen) >= 80


def test_one_odd_check_is_no_level_of_its_own() -> None:
    odd = [1.0, 1.01, 0.99, 1.0, 9.0, 1.01, 1.0, 0.99, 1.0, 1.01]
    assert level_steps(odd, least=2) == ()
    assert [step.place for step in level_steps(odd, least=1)] == [4, 5]


@pytest.mark.parametrize("series", [[], [1.0], [1.0, 2.0, 3.0]])
def test_too_few_checks_have_no_steps(series: list[float]) -> None:
    assert level_steps(series, least=2) == ()
