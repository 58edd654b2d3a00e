import re

import numpy as np
import pytest

from benchmark.comparison import (
    describe_equivalence,
    describe_t_test,
    paired_equivalence,
    passing_scale_errors,
    pooled_t_test,
)

CLAIMS = re.compile(r"agree|similar|equivalen|the same|match|consistent|valid", re.IGNORECASE)


@pytest.mark.parametrize("factor", [1.0, 1.1, 1.5])
def test_a_t_test_is_never_called_agreement(triangle, factor):
    text = describe_t_test(pooled_t_test(triangle, factor * triangle), passing_scale_errors(triangle))
    assert not CLAIMS.search(text)
    assert "-15.0 % to +17.7 %" in text
    assert ("does not reject" in text) == (factor < 1.177)


def test_a_t_test_without_outcome_says_why():
    constant = np.ones(5)
    assert "not defined" in describe_t_test(pooled_t_test(constant, constant), passing_scale_errors(constant))


def test_a_test_that_passes_everything_says_so():
    sample = np.array([0.0, 1.0, 0.0])
    assert "any size" in describe_t_test(pooled_t_test(sample, 2 * sample), passing_scale_errors(sample))


def test_equivalence_names_its_margin(triangle):
    shown = describe_equivalence(paired_equivalence(triangle, 1.001 * triangle))
    not_shown = describe_equivalence(paired_equivalence(triangle, 1.1 * triangle))
    assert shown.startswith("Equivalent within 2 % of the FEM's mean")
    assert not_shown.startswith("Equivalence within 2 % of the FEM's mean is not shown")
    assert "+9.04 to +11 % of it" in not_shown
