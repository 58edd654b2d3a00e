"""Faults on demand."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.errors import InputError
from bench_hw.simulated.faults import StreamFaults, parse_positions


@pytest.mark.parametrize(
    ("text", "positions"),
    [("", set()), ("5", {5}), ("200-202,500", {200, 201, 202, 500}), (" 3 , 7-7 ", {3, 7}), ("1,1-2", {1, 2})],
)
def test_positions(text, positions):
    assert parse_positions(text) == positions


@pytest.mark.parametrize("text", ["0", "-3", "5-3", "a", "1-2-3", "1.5", "3-", "1-99999999999"])
def test_what_is_no_position_is_refused(text):
    with pytest.raises(InputError, match="allowed are numbers from 1"):
        parse_positions(text)


@given(st.sets(st.integers(1, 5000), max_size=30))
def test_positions_come_back_as_they_were_written(positions):
    assert parse_positions(",".join(map(str, positions))) == positions


@pytest.mark.parametrize("chance", [-0.1, 1.1, float("nan")])
def test_a_chance_is_between_nought_and_one(chance):
    with pytest.raises(InputError, match="allowed are 0 to 1"):
        StreamFaults(loss=chance)
