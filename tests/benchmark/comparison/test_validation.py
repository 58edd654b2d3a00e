"""Error against uncertainty, by hand."""

import numpy as np
import pytest
import scipy

from benchmark.comparison import ComparisonError, Validation, input_uncertainty, replicate_uncertainty


def test_the_uncertainties_add_in_squares() -> None:
    found = Validation(simulation=5.2, data=5.0, numerical=0.03, inputs=0.04, measured=0.12)
    assert found.error == pytest.approx(0.2)
    assert found.uncertainty == pytest.approx(0.13)
    assert found.interval == pytest.approx((0.07, 0.33))
    assert not found.within
    assert found.missing == ()


def test_what_was_not_assessed_is_named() -> None:
    found = Validation(5.05, 5.0, None, None, 0.06)
    assert found.missing == ("u_num", "u_input")
    assert found.uncertainty == pytest.approx(0.06)
    assert found.within


def test_replicates_give_the_standard_error_of_their_mean() -> None:
    values = [4.9, 5.1, 5.0, 5.3]
    assert replicate_uncertainty(values) == pytest.approx(float(scipy.stats.sem(values)), abs=1e-15)
    assert replicate_uncertainty([5.0]) is None
    with pytest.raises(ComparisonError):
        replicate_uncertainty([1.0, np.nan])


def test_an_interval_becomes_a_standard_uncertainty() -> None:
    width = float(scipy.stats.norm.ppf(0.975))
    assert input_uncertainty(-2.0, (1.0 - width * 0.1, 1.0 + width * 0.1)) == pytest.approx(0.2, rel=1e-12)
