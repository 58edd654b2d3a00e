import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reports.formatting import (
    counted,
    decimal_padding,
    format_cell,
    format_number,
    is_exact,
    is_number,
    isolated,
    shortened,
)


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (0.0, 4, "0"),
        (1.972017, 7, "1.972017"),
        (0.00102, 3, "0.00102"),
        (-0.0551, 3, "−0.0551"),
        (48_302, 3, "48\u202f302"),
        (1234, 2, "1234"),
        (123456.0, 4, "123\u202f456"),
        (1.5e7, 3, "1.50 × 10⁷"),
        (3.1e-7, 2, "3.1 × 10⁻⁷"),
        (-3.1e-7, 1, "−3 × 10⁻⁷"),
        (99.96, 3, "100"),
        (math.nan, 3, "–"),
        (-math.inf, 3, "−∞"),
    ],
)
def test_numbers_read_like_this(value, digits, text):
    assert format_number(value, digits) == text


@pytest.mark.parametrize(
    ("value", "text"), [(5.0, "5"), (0.1, "0.1"), (1.52, "1.52"), (10.0, "10"), (2e9, "2 × 10⁹"), (100.0, "100")]
)
def test_trimmed_numbers_end_without_zeros(value, text):
    assert format_number(value, 3, trim=True) == text


@given(st.floats(-1e12, 1e12), st.integers(1, 12))
def test_what_is_shown_is_the_number_rounded(value, digits):
    text = format_number(value, digits).replace("−", "-").replace("\u202f", "")
    mantissa, _, power = text.partition(" × 10")
    power = power.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")) or "0"
    shown = float(f"{mantissa}e{power}")
    half_a_digit = 0.5 * 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1) if value else 0.0
    assert abs(shown - value) <= half_a_digit * (1 + 1e-9) + 1e-15 * abs(value)


def test_no_digits_are_refused():
    with pytest.raises(ValueError, match="digits is 0"):
        format_number(1.0, 0)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "–"),
        (np.float64(0.5), "0.5000"),
        (np.bool_(True), "yes"),
        (False, "no"),
        ("<b>", "<b>"),
        (np.int8(3), "3"),
    ],
)
def test_cells_read_like_this(value, text):
    assert format_cell(value) == text


def test_numbers_are_told_from_words():
    assert [is_number(value) for value in (1, 1.5, np.float32(1), True, "1", None)] == [True] * 3 + [False] * 3


def test_exact_is_what_the_digits_hold():
    assert [is_exact(value, 3) for value in (0.1, 5, 1.234, math.pi)] == [True, True, False, False]


@pytest.mark.parametrize(("number", "words"), [(0, "0 points"), (1, "1 point"), (2, "2 points")])
def test_a_count_agrees_with_what_is_counted(number, words):
    assert counted(number, "point") == words


@given(st.text(max_size=30), st.integers(1, 30))
def test_shortened_text_fits(text, length):
    short = shortened(text, length)
    assert len(short) <= length
    assert short == text or (short.endswith("…") and text.startswith(short[:-1]))


def test_padding_brings_decimal_points_in_line():
    texts = ["1.25", "10.5", "7", "3.1 × 10⁻⁷"]
    padding = decimal_padding(texts)
    lengths = [len(text + pad) - len(text.split(".")[0]) for text, pad in zip(texts[:3], padding[:3], strict=True)]
    assert lengths == [3, 3, 3]
    assert padding[3] == ""
    assert decimal_padding([]) == []


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("off by עור +24.7 %, שומן +29.4 %", "off by <עור> +24.7 %, <שומן> +29.4 %"),
        ("רקמת שומן: 3 trials", "<רקמת שומן>: 3 trials"),
        ("جلد", "<جلد>"),
        ("dermis, 皮膚, épiderme", "dermis, 皮膚, épiderme"),
    ],
)
def test_words_from_right_to_left_are_kept_apart(text, wanted):
    assert isolated(text, "<", ">") == wanted
    assert isolated(text) == wanted.replace("<", "\u2068").replace(">", "\u2069")
