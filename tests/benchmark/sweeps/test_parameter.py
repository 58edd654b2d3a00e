"""What varies: lists and ranges as typed, their values as --set takes them and as numbers in one unit."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.errors import InputError
from benchmark.files.units import PRESSURE, parse_quantity
from benchmark.sweeps.parameter import parse_parameter


def test_a_list_keeps_its_words() -> None:
    found = parse_parameter("tool.radius=2 mm, 0.5 cm")
    assert found.grid() == ["2 mm", "0.5 cm"]
    assert (found.unit, found.column) == ("mm", "tool.radius_mm")
    assert [found.number_of(text) for text in found.grid()] == [2.0, pytest.approx(5.0, rel=1e-15)]


def test_plain_numbers_and_words() -> None:
    ratio = parse_parameter("dermis.poisson_ratio=0.45,0.48")
    assert (ratio.unit, ratio.column, ratio.numbers) == ("", "dermis.poisson_ratio", (0.45, 0.48))
    contact = parse_parameter("tool.contact=uniform_pressure,rigid_bonded")
    assert contact.numbers is None
    assert contact.number_of("rigid_bonded") is None
    mixed = parse_parameter("tissue=5 mm,skin_forearm")
    assert mixed.numbers is None


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("d.e=50 kPa:500 kPa:3", [50.0, 275.0, 500.0]),
        ("d.e=50 kPa:500 kPa:3:lin", [50.0, 275.0, 500.0]),
        ("d.e=50 kPa:0.5 MPa:3:log", [50.0, 158.1138830, 500.0]),
        ("d.e=5 kPa:1 kPa:2", [5.0, 1.0]),
        ("d.e=0.1:0.4:4", [0.1, 0.2, 0.3, 0.4]),
    ],
)
def test_a_range_on_a_grid(text: str, numbers: list[float]) -> None:
    found = parse_parameter(text)
    assert [found.number_of(each) for each in found.grid()] == pytest.approx(numbers, rel=1e-9)
    assert found.grid()[0] == found.texts[0]
    assert found.grid()[-1] == found.texts[1]


@given(
    low=st.floats(1e-3, 1e3).map(lambda value: float(f"{value:.6g}")),
    ratio=st.floats(1.01, 1e4),
    share=st.floats(0.0, 1.0),
    scale=st.sampled_from(["lin", "log"]),
)
def test_a_value_lies_in_its_range_and_reads_back(low: float, ratio: float, share: float, scale: str) -> None:
    high = float(f"{low * ratio:.6g}")
    found = parse_parameter(f"d.e={low!r} kPa:{high!r} kPa:{scale}")
    text = found.text_at(share)
    number = found.number_of(text)
    assert number is not None
    assert low * (1 - 1e-9) <= number <= high * (1 + 1e-9)
    assert parse_quantity(text, PRESSURE) == pytest.approx(1e3 * number, rel=1e-15)
    exact = low * (high / low) ** share if scale == "log" else low + share * (high - low)
    assert math.isclose(number, exact, rel_tol=1e-9)


def test_a_sample_takes_list_entries_evenly() -> None:
    found = parse_parameter("tool.radius=2 mm,5 mm")
    assert [found.text_at(share) for share in (0.0, 0.49, 0.5, 0.99, 1.0)] == ["2 mm", "2 mm", "5 mm", "5 mm", "5 mm"]


@pytest.mark.parametrize(
    ("unit", "column"),
    [("kPa", "x_kPa"), ("kg/m^3", "x_kg_per_m3"), ("%", "x_percent"), ("µm", "x_um"), ("deg", "x_deg")],
)
def test_the_column_carries_the_unit(unit: str, column: str) -> None:
    assert parse_parameter(f"x=1 {unit},2 {unit}").column == column


@pytest.mark.parametrize("text", ["d.e=50 kPa:500 kPa:10:log", "d.e=1:2:3", "d.e=a,b", "d.e=1 mm:2 mm"])
def test_it_describes_itself_as_typed(text: str) -> None:
    found = parse_parameter(text)
    assert parse_parameter(f"d.e={found.describe()}") == found


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("tool.radius", "KEY=VALUES"),
        ("=2 mm", "KEY=VALUES"),
        ("tool.radius=", "KEY=VALUES"),
        ("tool.radius=2 mm,,3 mm", "empty"),
        ("tool.radius=2 mm,2 mm", "repeated"),
        ("tool.radius=4 mm,5 mm,0.004 m", "4 mm and 0.004 m are one value"),
        ("dermis.poisson_ratio=0.4,0.40", "0.4 and 0.40 are one value"),
        ("d.e=50 kPa:500 kPa:1", "at least 2"),
        ("d.e=50 kPa:500 kPa:many", "no range"),
        ("d.e=50 kPa:500 kPa:3:4", "no range"),
        ("d.e=50 kPa:500 mm:3", "no range"),
        ("d.e=50:500 kPa:3", "no range"),
        ("d.e=a:b:3", "no range"),
        ("d.e=50 kPa:50 kPa:3", "equal"),
        ("d.e=0 kPa:50 kPa:3:log", "log"),
        ("d.e=-1 mm:5 mm:log", "log"),
    ],
)
def test_what_it_refuses(text: str, word: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_parameter(text)
    assert word in str(caught.value)
    assert "--vary" in str(caught.value)


def test_a_range_without_a_number_can_only_be_sampled() -> None:
    found = parse_parameter("d.e=50 kPa:500 kPa:log")
    assert found.text_at(0.5) == "158.113883 kPa"
    with pytest.raises(InputError, match="--sample"):
        found.grid()
