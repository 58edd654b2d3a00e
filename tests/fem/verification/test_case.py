import math

import pytest

from fem.verification import Quantity


def quantity(ours: float, reference: float = -2.0) -> Quantity:
    return Quantity("", reference, ours, "mm", 1.0, 10)


def test_error_is_signed_and_relative_to_the_size_of_the_reference():
    assert quantity(-2.01).error_percent == pytest.approx(-0.5)
    assert quantity(-1.99).error_percent == pytest.approx(0.5)


def test_passes_up_to_what_is_allowed():
    assert quantity(-2.0199).passed
    assert not quantity(-2.0201).passed
    assert not quantity(2.0).passed


@pytest.mark.parametrize("ours", [math.nan, math.inf])
def test_what_is_not_finite_never_passes(ours):
    assert not quantity(ours).passed
    assert quantity(ours).share_of_allowed == math.inf
