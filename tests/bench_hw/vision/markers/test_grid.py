"""Layouts as text."""

import pytest

from bench_hw.errors import InputError
from bench_hw.vision.markers import Layout, parse_layout


def test_a_layout_is_rows_by_columns():
    assert parse_layout("3x6") == Layout(3, 6)
    assert parse_layout("4X5").count == 20
    assert str(Layout(3, 6)) == "3 x 6"


@pytest.mark.parametrize("text", ["", "3", "x", "3x", "-3x6", "3x6x1", "a", "1x3", "100x100", "0x9"])
def test_other_text_is_refused(text):
    with pytest.raises(InputError, match="allowed"):
        parse_layout(text)
