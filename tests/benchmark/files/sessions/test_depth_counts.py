import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.tables import TrialTable
from benchmark.files.sessions.depth_counts import between_counts, count_of, even_depths

COUNT = 48.8e-6
TIME = np.arange(0.0, 12.0, 0.01)


def _motion(speed: float = 1e-3, start: float = -1e-3) -> np.ndarray:
    """Rest, a press that stops where it enters a count, a hold of 4 s, the way back; m."""
    deepest = (np.floor((start + 3.0 * speed) / COUNT) + 0.55) * COUNT
    instants = [0.0, 1.0, 1.0 + (deepest - start) / speed, 8.0, 8.0 + (deepest - start) / speed, 12.0]
    return np.interp(TIME, instants, [start, start, deepest, deepest, start, start])


def _read(depth: np.ndarray) -> np.ndarray:
    return COUNT * np.round(depth / COUNT)


def test_the_count_is_found_and_the_depth_between() -> None:
    true = _motion()
    read = _read(true)
    assert count_of(read) == pytest.approx(COUNT, rel=1e-6)
    pressed = (TIME > 1.1) & (TIME < 10.5)
    error = (between_counts(TIME, read, COUNT) - true)[pressed]
    assert np.abs(read - true)[pressed].max() > 0.45 * COUNT
    assert np.abs(error).max() < 0.25 * COUNT
    assert np.sqrt(np.mean(error**2)) < 0.2 * np.sqrt(np.mean((read - true)[pressed] ** 2))


def test_a_quick_turn_goes_beyond_the_boundary() -> None:
    true = np.interp(TIME, [0.0, 6.0, 12.0], [0.0, 6.02e-3, 0.0])
    found = between_counts(TIME, _read(true), COUNT)
    assert np.abs(found - true)[50:-50].max() < 0.25 * COUNT


def test_counts_of_slower_readings_are_found_behind_the_rows_of_the_force() -> None:
    true, rows = _motion(), np.arange(0.5, 11.0, 1e-3)
    read = _read(true)
    joined = np.interp(rows, TIME, read)
    assert count_of(joined) is None
    table = TrialTable(rows, joined, np.zeros(len(rows)), readings=(TIME, read))
    (found,), said = even_depths([table])
    assert "comes in counts of 0.0488 mm" in said[0]
    assert found.readings is None
    pressed = (rows > 1.1) & (rows < 10.5)
    left = np.interp(rows, TIME, true)
    assert np.abs(found.depth - left)[pressed].max() < 0.25 * COUNT < 0.4 * COUNT < np.abs(joined - left)[pressed].max()


@given(st.floats(0.2e-3, 3e-3), st.floats(-2e-3, 0.0))
def test_no_row_is_further_than_a_count_from_its_reading(speed: float, start: float) -> None:
    read = _read(_motion(speed, start))
    found = between_counts(TIME, read, COUNT)
    assert np.abs(found - read).max() <= COUNT * (1.0 + 1e-6)


def test_flicker_stays_at_the_boundary() -> None:
    read = _read(np.where(np.arange(len(TIME)) % 5 == 0, 0.6, 0.4) * COUNT)
    found = between_counts(TIME, read, COUNT)
    assert np.abs(found[10:-10] - 0.5 * COUNT).max() < 0.5 * COUNT


def test_readings_with_decimals_are_counts_too() -> None:
    assert count_of(np.round(_read(_motion()), 6)) == pytest.approx(COUNT, rel=0.01)


@pytest.mark.parametrize(
    "depth",
    [
        _motion() + np.random.default_rng(3).normal(0.0, 1e-6, len(TIME)),  # noise, no counts
        1e-7 * np.round(_motion() / 1e-7),  # counts too fine to matter
        5e-5 * np.round(np.linspace(0.0, 0.1, len(TIME)) / 5e-5),  # a new count in each row
        np.interp(TIME, [0.0, 6.0, 6.5, 7.0, 12.0], [0.0, 0.0, 4e-3, 0.0, 0.0]).round(5),  # quick and exact
        np.zeros(len(TIME)),
        np.where(TIME > 6.0, 1e-3, 0.0),  # one step
    ],
    ids=["noise", "fine", "fast", "quick", "still", "step"],
)
def test_what_does_not_come_in_counts(depth: np.ndarray) -> None:
    assert count_of(depth) is None


def test_even_steps_and_a_long_hold_are_no_counts() -> None:
    way = np.concatenate([np.linspace(0.0, 2e-3, 101), np.full(1000, 2e-3), np.linspace(2e-3, 0.0, 101)])
    assert count_of(np.round(way, 7)) is None


def test_only_trials_in_counts_are_changed_and_it_is_said() -> None:
    plain = TrialTable(TIME, _motion(), np.zeros(len(TIME)))
    counted = TrialTable(TIME, _read(_motion()), np.zeros(len(TIME)))
    (first, second), said = even_depths([plain, counted])
    assert first is plain
    assert np.abs(second.depth - counted.depth).max() > 0.0
    assert len(said) == 1
    assert said[0].startswith("the depth of 1 of 2 trials comes in counts of 0.0488 mm")
    assert even_depths([plain]) == ([plain], [])
