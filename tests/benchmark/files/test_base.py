import pytest
from pydantic import ValidationError

from benchmark.files.base import FileModel, Name


class Part(FileModel):
    name: Name = "x"
    size: float | None = None


class Whole(FileModel):
    parts: tuple[Part, ...] = ()
    part: Part = Part()


def test_what_is_not_given_is_left_out_of_the_table():
    assert Whole(parts=(Part(), Part(size=2.0))).to_table() == {
        "parts": [{"name": "x"}, {"name": "x", "size": 2.0}],
        "part": {"name": "x"},
    }


def test_a_model_writes_itself_as_toml():
    assert Part(name='a "b"').to_toml() == 'name = "a \\"b\\""\n'


def test_unknown_keys_and_changes_are_refused():
    with pytest.raises(ValidationError, match="extra_forbidden"):
        Part(nme="y")
    with pytest.raises(ValidationError, match="frozen"):
        Part().name = "y"
