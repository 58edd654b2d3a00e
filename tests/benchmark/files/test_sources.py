from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.files.sources import Source, is_file, line_of, read_toml

TEXT = '''\
# [tool] in a comment, and """ too
schema = 1
title = """
[tool]
radius = "not a key"
"""
list = [
  "radius = 1",   # ]
  { radius = 2 },
]
[tool]
radius = "5 mm"     # "quoted # inside"
note = '[[layers]]'

[[layers]]
name = "a"
law = { c10 = "1 kPa" }
[layers.more]
deep = 1
[[layers]]
"name" = "b"
inner.key = 3
[conditions.slow.tool]
radius = "1 mm"
'''


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("schema",), 2),
        (("title",), 3),
        (("list",), 7),
        (("list", 1, "radius"), 7),
        (("tool",), 11),
        (("tool", "radius"), 12),
        (("tool", "missing"), 11),
        (("layers",), 15),
        (("layers", 0), 15),
        (("layers", 0, "name"), 16),
        (("layers", 0, "law", "c10"), 17),
        (("layers", 0, "more", "deep"), 19),
        (("layers", 1, "name"), 21),
        (("layers", 1, "inner", "key"), 22),
        (("layers", 1, "thickness"), 20),
        (("conditions", "slow"), 23),
        (("conditions", "slow", "tool", "radius"), 24),
        (("nothing",), None),
        ((), None),
    ],
)
def test_finds_a_key_or_the_nearest_table_around_it(path, line):
    assert line_of(TEXT, path) == line


def test_an_empty_text_has_no_lines():
    assert line_of("", ("tool",)) is None


def test_a_place_is_file_line_and_key():
    source = Source("a.toml", "x = 1\n[tool]\nradius = 2\n")
    assert source.place(("tool", "radius"), "tool.radius") == "a.toml, line 3, tool.radius"
    assert source.place(("fem",), "fem") == "a.toml, fem"


def test_a_place_the_command_line_replaced_is_its_key():
    source = Source("a.toml", "[tool]\n", overrides={("tool", "radius"): "tool.radius"})
    assert source.place(("tool", "radius"), "tool.radius") == "--set tool.radius"
    assert source.place(("tool", "radius", 0), "tool.radius") == "--set tool.radius (0)"
    assert source.place(("tool",), "tool") == "a.toml, line 1, tool (with --set tool.radius)"


def test_a_prefix_says_where_a_table_stands_in_its_file():
    overrides = {("tissue", "max_force"): "max_force"}
    source = Source("a.toml", "[tissue]\nname = 1\n", overrides=overrides, prefix=("tissue",))
    assert source.place(("name",), "name") == "a.toml, line 2, tissue.name"
    assert source.place(("max_force",), "max_force") == "--set max_force"


def test_reads_a_table_and_its_folder(tmp_path):
    path = tmp_path / "a.toml"
    path.write_bytes(b"\xef\xbb\xbfx = 1\n")
    table, source = read_toml(path, "scenario")
    assert table == {"x": 1}
    assert source.folder == tmp_path


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"x = ", "no valid TOML"),
        (b"x = 1\nx = 2\n", "no valid TOML"),
        (b"<<<<<<< HEAD\nx = 1\n=======\nx = 2\n>>>>>>> main\n", "line 1 has a conflict marker of git"),
        (b"x = 1\r\n>>>>>>> main\r\n", "line 2 has a conflict marker of git"),
        (b'x = 1\n"<<<<<<< x"\n', "no valid TOML: Expected"),
        (b"\xff\xfe", "not UTF-8"),
        (b"x = " + b"[" * 20000, "cannot be read"),
        (b"x = 1" + b"0" * 5000, "cannot be read"),
    ],
)
def test_what_is_no_toml_is_refused_by_name(tmp_path, content, says):
    path = tmp_path / "a.toml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=says) as refusal:
        read_toml(path, "scenario")
    assert str(path) in str(refusal.value)


@pytest.mark.parametrize("name", ["missing.toml", "", "a\0b.toml", "x" * 300])
def test_what_is_no_file_is_refused(tmp_path, name):
    with pytest.raises(InputError):
        read_toml(tmp_path / name, "scenario")
    assert not is_file(tmp_path / name)


def test_a_fault_of_the_file_says_its_line(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text("x = 1\ny ? 2\n")
    with pytest.raises(InputError, match="line 2"):
        read_toml(Path(path), "tissue")
