import numpy as np
import pytest

from benchmark.side_by_side.messages import Seconds
from benchmark.side_by_side.timing import median_seconds, speedup


def repeats(*walls: float) -> list[Seconds]:
    return [Seconds(setup=0.5, wall=wall, cpu=0.9 * wall) for wall in walls]


def test_median_of_each_part() -> None:
    assert median_seconds(repeats(3.0, 1.0, 2.0)) == Seconds(0.5, 2.0, pytest.approx(1.8))


def test_ratio_is_taken_pair_by_pair() -> None:
    drifting = speedup(repeats(1.0, 2.0, 4.0), repeats(0.1, 0.2, 0.4), seed=1)
    assert drifting.median == pytest.approx(10.0)
    assert drifting.ci95 == pytest.approx((10.0, 10.0))


def test_interval_spans_what_three_pairs_show() -> None:
    found = speedup(repeats(8.0, 10.0, 12.0), repeats(1.0, 1.0, 1.0), seed=1)
    assert found.median == 10.0
    assert found.ci95 == (8.0, 12.0)
    assert found.repeats == 3


def test_interval_narrows_with_repeats_and_follows_the_seed() -> None:
    generator = np.random.default_rng(3)
    slow = repeats(*generator.normal(10.0, 1.0, 60))
    fast = repeats(*np.ones(60))
    found = speedup(slow, fast, seed=4)
    assert found == speedup(slow, fast, seed=4)
    assert 9.4 < found.ci95[0] < 10.0 < found.ci95[1] < 10.6


def test_unequal_repeats_are_refused() -> None:
    with pytest.raises(ValueError, match="shorter"):
        speedup(repeats(1.0, 1.0), repeats(1.0), seed=0)
