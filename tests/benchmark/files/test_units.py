import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.files import units
from benchmark.files.units import DIMENSIONS, QuantityError, format_quantity, parse_quantity, shown_quantity

finite = st.floats(allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("120 kPa", units.PRESSURE, 120e3),
        ("1e6 MPa", units.PRESSURE, 1e12),
        ("0.16 N/mm^2", units.PRESSURE, 0.16e6),
        ("11.6 mm", units.LENGTH, 0.0116),
        ("0.1 mm", units.LENGTH, 1e-4),
        ("5mm", units.LENGTH, 5e-3),
        ("  75 um ", units.LENGTH, 75e-6),
        ("75 µm", units.LENGTH, 75e-6),
        ("2 inch", units.LENGTH, 0.0508),
        ("-0.5 N", units.FORCE, -0.5),
        (".5 mN", units.FORCE, 0.5e-3),
        ("2 min", units.DURATION, 120.0),
        ("1110 kg/m3", units.DENSITY, 1110.0),
        ("1.07 g/cm^3", units.DENSITY, 1070.0),
        ("1110 kg m^-3", units.DENSITY, 1110.0),
        ("180 deg", units.ANGLE, math.pi),
        ("90°", units.ANGLE, math.pi / 2),
        ("2 %", units.FRACTION, 0.02),
        ("2%", units.FRACTION, 0.02),
        ("0.02", units.FRACTION, 0.02),
        ("1 kHz", units.FREQUENCY, 1000.0),
        ("3 mm/s", units.SPEED, 3e-3),
    ],
)
def test_reads_a_number_with_a_unit_exactly(text, dimension, value):
    assert parse_quantity(text, dimension) == value


@pytest.mark.parametrize(
    ("text", "dimension", "says"),
    [
        ("5 kPa", units.LENGTH, "'5 kPa' is a pressure, not a length"),
        ("5 mm", units.PRESSURE, "'5 mm' is a length, not a pressure"),
        ("2 %", units.ANGLE, "is a plain number, not an angle"),
        ("2 deg", units.FRACTION, "is an angle, not a fraction"),
        ("20 degC", units.LENGTH, "is a quantity in kelvin, not a length"),
        ("5 kg", units.FORCE, "is a quantity in kilogram, not a force"),
        ("5", units.LENGTH, "'5' has no unit"),
        ("5 parsnip", units.LENGTH, "the unit 'parsnip' is not known"),
        ("5 kpa", units.PRESSURE, "the unit 'kpa' is not known for a pressure; did you mean kPa?"),
        ("5 mpa", units.PRESSURE, "the unit 'mpa' is not known for a pressure; did you mean MPa?"),
        ("nan mm", units.LENGTH, "is not a finite number"),
        ("inf kPa", units.PRESSURE, "is not a finite number"),
        ("-inf kPa", units.PRESSURE, "is not a finite number"),
        ("1e9999 m", units.LENGTH, "is too large"),
        ("1e99999999 m", units.LENGTH, "is not a finite number"),
        ("", units.LENGTH, "is not a finite number"),
        ("mm", units.LENGTH, "is not a finite number"),
        ("5 mm + 2 mm", units.LENGTH, "is not known"),
        ("1 2 mm", units.LENGTH, "is not a finite number"),
        ("5 m**999999", units.LENGTH, "not a length"),
        ("__import__('os')", units.LENGTH, "is not a finite number"),
        ("1 " + "m" * 100, units.LENGTH, "is not a finite number"),
    ],
)
def test_refuses_what_is_no_quantity_of_that_dimension(text, dimension, says):
    with pytest.raises(QuantityError, match=re.escape(says)) as refusal:
        parse_quantity(text, dimension)
    assert dimension.name in str(refusal.value)


@pytest.mark.parametrize("dimension", DIMENSIONS, ids=lambda each: each.name)
@given(value=finite)
def test_what_is_written_reads_back_as_the_same_float(dimension, value):
    assert parse_quantity(format_quantity(value, dimension), dimension) == value


def read_or_refused(text, dimension):
    try:
        return math.isfinite(parse_quantity(text, dimension))
    except QuantityError as refusal:
        return dimension.example in str(refusal) or "too large" in str(refusal)


@given(
    text=st.text(max_size=60)
    | st.from_regex(r"-?\d{1,3}(\.\d)?(e-?\d{1,3})? ?[a-zµ%°*/^()\d. -]{0,12}", fullmatch=True)
)
def test_any_text_is_read_or_refused(text):
    for dimension in (units.LENGTH, units.FRACTION):
        assert read_or_refused(text, dimension)


@pytest.mark.parametrize(
    ("value", "dimension", "text"),
    [
        (120e3, units.PRESSURE, "120 kPa"),
        (1.5e6, units.PRESSURE, "1.5 MPa"),
        (110.0, units.PRESSURE, "0.11 kPa"),
        (0.0116, units.LENGTH, "11.6 mm"),
        (1e-4, units.LENGTH, "0.1 mm"),
        (2.5e-6, units.LENGTH, "2.5 um"),
        (30.0, units.LENGTH, "30 m"),
        (0.0, units.LENGTH, "0 mm"),
        (0.01, units.FORCE, "0.01 N"),
        (0.02, units.FRACTION, "2 %"),
        (math.pi / 4, units.ANGLE, "45 deg"),
        (0.1, units.DURATION, "0.1 s"),
    ],
)
def test_writes_the_unit_a_person_would_choose(value, dimension, text):
    assert format_quantity(value, dimension) == text


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_does_not_write_what_is_not_finite(value):
    with pytest.raises(QuantityError, match="not finite"):
        format_quantity(value, units.LENGTH)


def test_shows_six_digits():
    assert shown_quantity(1.23456789e-3, units.LENGTH) == "1.23457 mm"
    assert shown_quantity(math.radians(60), units.ANGLE) == "60 deg"
