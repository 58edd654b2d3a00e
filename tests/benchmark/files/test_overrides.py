import pytest

from benchmark.errors import InputError
from benchmark.files.overrides import layer_path, parsed_value, put_in, replaced
from benchmark.files.sources import Source


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("120 kPa", "120 kPa"),
        ('"120 kPa"', "120 kPa"),
        ("linear", "linear"),
        ("0.45", 0.45),
        ("512", 512),
        ("true", True),
        ('["1 mm", "0 mm"]', ["1 mm", "0 mm"]),
        ('{ law = "yeoh" }', {"law": "yeoh"}),
        ("2023-03-31", "2023-03-31"),
        ("1\nother = 2", "1\nother = 2"),
        ("", ""),
        ("[" * 5000, "[" * 5000),
    ],
)
def test_a_value_is_toml_where_it_reads_as_such(text, value):
    assert parsed_value(text) == value


def test_layers_are_found_by_name_the_longest_first():
    assert layer_path("fat.thickness", ["skin", "fat"]) == ("layers", 1, "thickness")
    assert layer_path("fat.upper.thickness", ["fat", "fat.upper"]) == ("layers", 1, "thickness")
    assert layer_path("fat.hyperelastic.c10", ["fat"]) == ("layers", 0, "hyperelastic", "c10")
    assert layer_path("fat", ["fat"]) is None
    assert layer_path("fatty.thickness", ["fat"]) is None


def test_a_value_is_put_into_a_copy():
    table = {"a": {"b": 1}, "list": [{"c": 2}]}
    assert replaced(table, ("a", "b"), 5, "a.b") == {"a": {"b": 5}, "list": [{"c": 2}]}
    assert replaced(table, ("list", 0, "c"), 5, "x.c")["list"] == [{"c": 5}]
    assert replaced(table, ("new", "key"), 5, "new.key")["new"] == {"key": 5}
    assert table == {"a": {"b": 1}, "list": [{"c": 2}]}


def test_a_single_value_has_no_keys():
    with pytest.raises(InputError, match=r"--set a\.b\.c: 'b' is a single value \(1\)"):
        replaced({"a": {"b": 1}}, ("a", "b", "c"), 5, "a.b.c")
    for path in (("list", "c"), ("list", "c", "d")):
        with pytest.raises(InputError, match="leads through a list; give the whole list"):
            replaced({"list": [{"c": 1}]}, path, 5, ".".join(path))


def test_the_source_knows_what_was_put_in():
    table, source = put_in({}, Source("f", prefix=("p",)), {"k.x": ("k", "x")}, {"k.x": "5"})
    assert table == {"k": {"x": 5}}
    assert source.place(("k", "x"), "k.x") == "--set k.x"
