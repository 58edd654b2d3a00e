"""The area metric against hand computation and SciPy."""

import numpy as np
import pytest
import scipy

from benchmark.comparison import ComparisonError, area_metric


def test_two_steps_by_hand() -> None:
    # reference at 1 and 3, model at 2 and 6: |F| differs by 1/2 on (1, 2) and on (3, 6)
    found = area_metric([1.0, 3.0], [2.0, 6.0])
    assert found.area == pytest.approx(0.5 * 1.0 + 0.5 * 3.0, abs=1e-15)
    assert found.above == pytest.approx(2.0, abs=1e-15)
    assert found.below == 0.0


def test_crossing_distributions_split_into_both_sides() -> None:
    found = area_metric([0.0, 4.0], [1.0, 3.0])
    assert (found.area, found.above, found.below) == pytest.approx((1.0, 0.5, 0.5), abs=1e-15)


def test_a_shift_is_its_own_area_and_parts_add_up() -> None:
    generator = np.random.default_rng(3)
    sample, other = generator.normal(size=37), generator.normal(0.4, 1.3, size=52)
    assert area_metric(sample, sample + 0.25).area == pytest.approx(0.25, abs=1e-12)
    found = area_metric(sample, other)
    assert found.area == pytest.approx(scipy.stats.wasserstein_distance(sample, other), abs=1e-12)
    assert found.above + found.below == pytest.approx(found.area, abs=1e-12)


def test_gaps_are_left_out_and_nothing_is_refused() -> None:
    assert area_metric([1.0, np.nan], [1.0]).area == 0.0
    with pytest.raises(ComparisonError, match="common rows"):
        area_metric([np.nan], [1.0])
