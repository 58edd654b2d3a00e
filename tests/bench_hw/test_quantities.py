"""Quantities with units."""

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.quantities import parse_quantity


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("2 mm", "m", 0.002),
        ("-2 mm", "m", -0.002),
        ("1 mm/s", "m/s", 0.001),
        ("50 ms", "s", 0.05),
        ("6 N", "N", 6.0),
        ("1 kHz", "Hz", 1000.0),
        ("0", "m", 0.0),
        (0, "m", 0.0),
    ],
)
def test_reads_si(text, unit, value):
    assert parse_quantity(text, unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    "text", ["2", 2, 2.0, True, None, "mm", "2 mm^2", "2 furlongs_", "nan mm", "inf mm", "2 N", []]
)
def test_refuses_what_is_no_length(text):
    with pytest.raises(ValueError, match="allowed"):
        parse_quantity(text, "m")


@given(st.floats(-1e6, 1e6, allow_nan=False))
def test_millimetres_are_a_thousandth(value):
    assert parse_quantity(f"{value!r} mm", "m") == pytest.approx(value / 1000.0, rel=1e-12, abs=1e-300)


@given(st.text(max_size=20))
def test_any_text_is_read_or_refused_with_what_is_allowed(text):
    with suppress(ValueError):
        assert isinstance(parse_quantity(text, "m"), float)
        return
    with pytest.raises(ValueError, match="allowed"):
        parse_quantity(text, "m")
