"""Reading configuration files."""

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ConfigDict, Field

from bench_hw.configuration import parse_quantity, read_toml, validated
from bench_hw.errors import InputError


class Inner(BaseModel):
    model_config = ConfigDict(extra="forbid")
    depth: int = Field(gt=0)


class Outer(BaseModel):
    model_config = ConfigDict(extra="forbid")
    name: str
    inner: Inner


def test_reads_tables_and_text(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text('name = "x"\n')
    assert read_toml(path) == ({"name": "x"}, 'name = "x"\n')


@pytest.mark.parametrize("content", [b"name = ", b"\xff\xfe", b"a = 1\na = 2\n"])
def test_names_the_file_that_is_no_toml(tmp_path, content):
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"bad\.toml"):
        read_toml(path)


def test_names_the_file_that_is_missing(tmp_path):
    with pytest.raises(InputError, match=r"gone\.toml"):
        read_toml(tmp_path / "gone.toml")


def test_names_every_wrong_key():
    with pytest.raises(InputError) as caught:
        validated(Outer, {"inner": {"depth": -1, "colour": 3}}, "rig.toml")
    message = str(caught.value)
    assert message.startswith("rig.toml: ")
    assert "key name: is missing" in message
    assert "key inner.colour: is unknown here" in message
    assert "key inner.depth = -1" in message
    assert "greater than 0" in message


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
