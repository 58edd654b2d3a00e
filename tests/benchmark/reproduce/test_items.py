import math

import pytest

from benchmark.reproduce.items import compare, half_last_digit, headline, rounding_span


@pytest.mark.parametrize(
    ("printed", "half"),
    [(39.2012, 0.5e-4), (-8.393e-06, 0.5e-9), (-8.1904e-06, 0.5e-10), (0.002, 0.5e-3), (100.0, 0.05), (85.56, 0.005)],
)
def test_half_of_the_last_printed_digit(printed: float, half: float) -> None:
    assert half_last_digit(printed) == pytest.approx(half, rel=1e-6)


@pytest.mark.parametrize(("value", "agrees"), [(1.74094, True), (1.74086, True), (1.74096, False), (-1.7409, False)])
def test_a_number_agrees_if_it_rounds_to_the_printed_one(value: float, agrees: bool) -> None:
    item = compare("x", 1.7409, value, "")
    assert item.agrees is agrees
    assert item.difference == pytest.approx(value - 1.7409)


@pytest.mark.parametrize("value", [None, math.nan, math.inf])
def test_no_value_agrees_with_nothing(value: float | None) -> None:
    item = compare("x", 0.0, value, "none")
    assert (item.recomputed, item.difference, item.agrees) == (None, None, False)
    assert item.to_dict() == {"item": "x", "printed": 0.0, "recomputed": None, "agrees": False, "reason": "none"}


def test_the_span_is_what_the_printed_inputs_leave() -> None:
    assert rounding_span(lambda a, b: a / b, 2.0, 4.0) == pytest.approx((1.95 / 4.05, 2.05 / 3.95))


@pytest.mark.parametrize(
    ("span", "verdict"),
    [((1.0, 1.20), "input rounding"), ((1.0, 1.24), "input rounding"), ((1.0, 1.14), "no"), (None, "no")],
)
def test_a_difference_is_explained_where_the_span_reaches_the_printed_number(span, verdict) -> None:
    item = compare("x", 1.2, 1.1, "", span=span)
    assert item.verdict == verdict
    assert ("explains 1 more" in headline([item])) == (verdict != "no")
    assert compare("x", 1.2, 1.21, "", span=span).verdict == "yes"
