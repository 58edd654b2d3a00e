"""Reading configuration files."""

import pytest
from pydantic import BaseModel, ConfigDict, Field

from bench_hw.configuration import read_toml, validated
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
