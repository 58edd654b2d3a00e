import pytest

from benchmark.files.toml_lines import line_of

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
