"""Reading configuration files."""

from contextlib import suppress
from typing import Annotated, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ConfigDict, Field

from bench_hw.configuration import Length, StrictModel, parse_quantity, read_toml, validated
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
    assert "allowed is more than 0" in message


class Shaped(StrictModel):
    kind: Literal["shaped"]
    stretch: int = 0


class Formed(StrictModel):
    kind: Literal["formed"]
    formation: int = 0


class Whole(StrictModel):
    schema_version: Annotated[int, Field(alias="schema")] = 1
    parts: tuple[Annotated[Shaped | Formed, Field(discriminator="kind")], ...] = ()
    own: Inner | None = None
    by_name: dict[str, Inner] = {}  # noqa: RUF012 - a field


@pytest.mark.parametrize(
    ("tables", "says"),
    [
        ({"shema": 1}, "key shema: is unknown here; did you mean schema?"),
        ({"own": {"depth": 1, "dept": 1}}, "key own.dept: is unknown here; did you mean depth?"),
        (
            {"parts": [{"kind": "formed", "fromation": 1}]},
            "key parts[1].fromation: is unknown here; did you mean formation?",
        ),
        ({"parts": [{"kind": "formed", "strech": 1}]}, "key parts[1].strech: is unknown here"),
        ({"by_name": {"a": {"depth": 1, "detph": 2}}}, "key by_name.a.detph: is unknown here; did you mean depth?"),
    ],
)
def test_says_the_key_that_was_meant(tables, says):
    with pytest.raises(InputError) as caught:
        validated(Whole, tables, "rig.toml")
    assert str(caught.value) == f"rig.toml: {says}"


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


class Part(StrictModel):
    kind: Literal["part"]
    length: Annotated[Length, Field(gt=0.0, le=0.1)]
    count: Annotated[int, Field(strict=True)] = 1
    on: bool = True


class Other(StrictModel):
    kind: Literal["other"]


class Parts(StrictModel):
    parts: Annotated[tuple[Annotated[Part | Other, Field(discriminator="kind")], ...], Field(min_length=1)]


@pytest.mark.parametrize(
    ("part", "says"),
    [
        ({"kind": "part", "length": "2 m"}, "key parts[1].length = '2 m': allowed is at most 100 mm"),
        ({"kind": "part", "length": "-1 um"}, "key parts[1].length = '-1 um': allowed is more than 0 mm"),
        ({"kind": "part", "length": "1e400 mm"}, "key parts[1].length: '1e400 mm' is not finite"),
        ({"kind": "part"}, "key parts[1].length: is missing"),
        ({"kind": "prt"}, "key parts[1]: 'prt' is no kind of this; allowed is 'part', 'other'"),
        ({"kind": "part", "length": "1 mm", "count": 1.5}, "key parts[1].count = 1.5: allowed is a whole number"),
        ({"kind": "part", "length": "1 mm", "on": "ja"}, "key parts[1].on = 'ja': allowed is true or false"),
        ("part", "key parts[1] = 'part': allowed is a table of keys and values"),
    ],
)
def test_a_mistake_is_told_in_the_file_s_own_keys_and_units(part, says):
    with pytest.raises(InputError) as caught:
        validated(Parts, {"parts": [part]}, "rig.toml")
    assert says in str(caught.value)
    assert "Input should" not in str(caught.value)
    assert "at least 1" not in str(caught.value), "the list is not too short, its entry is wrong"


def test_a_byte_order_mark_is_no_part_of_a_file(tmp_path):
    (tmp_path / "a.toml").write_bytes(b"\xef\xbb\xbfx = 1\n")
    assert read_toml(tmp_path / "a.toml")[0] == {"x": 1}


@pytest.mark.parametrize("text", ["x = " + "9" * 5000, "x = " + "[" * 100_000])
def test_what_the_parser_cannot_take_is_refused(tmp_path, text):
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(InputError, match=r"a\.toml"):
        read_toml(tmp_path / "a.toml")
