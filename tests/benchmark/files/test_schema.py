from typing import Literal

import pytest
from pydantic import ValidationError

from benchmark.errors import InputError
from benchmark.files.quantities import Length, problem
from benchmark.files.schema import FileModel, Name, known_keys, nearest, shown_path, validated
from benchmark.files.sources import Source
from benchmark.files.tissue import Hyperelastic, Tissue


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


class Layered(FileModel):
    name: str = "x"
    side: Length = 1.0
    law: Hyperelastic | None = None


class Described(FileModel):
    kind: Literal["a", "b"] = "a"
    parts: tuple[Layered, ...] = ()
    flag: bool = False


def refusal(table, text=""):
    with pytest.raises(InputError) as error:
        validated(Described, table, Source("f.toml", text))
    return str(error.value)


def test_an_unknown_key_names_the_nearest_known_one():
    assert refusal({"kinds": "a"}) == "f.toml, kinds: this key is not known; did you mean kind?"
    assert refusal({"parts": [{"sid": 1}]}) == "f.toml, parts[#1].sid: this key is not known; did you mean side?"


def test_an_unknown_key_with_nothing_near_lists_what_is_known():
    assert refusal({"zzz": 1}) == "f.toml, zzz: this key is not known; known: kind, parts, flag."


def test_a_text_that_is_neither_yes_nor_no_is_told_in_plain_words():
    for value in ("ja", 3.5):
        assert refusal({"flag": value}) == f"f.toml, flag: {value!r} is not allowed; allowed: true, false."


def test_an_unknown_key_of_a_law_is_compared_with_that_law():
    said = refusal({"parts": [{"law": {"law": "gent", "mu": "1 kPa", "jm": 2.0, "jmm": 3.0}}]})
    assert said == "f.toml, parts[#1].law.jmm: this key is not known; did you mean jm?"


def test_a_choice_says_its_value_and_what_is_allowed():
    assert refusal({"kind": "c"}) == "f.toml, kind: 'c' is not allowed; allowed: 'a' or 'b'."


def test_entries_of_a_list_are_called_by_their_name():
    table = {"parts": [{"name": "top", "side": "1 kPa"}]}
    text = 'kind = "a"\n[[parts]]\nname = "top"\nside = "1 kPa"\n'
    assert refusal(table, text).startswith("f.toml, line 4, parts[top].side: '1 kPa' is a pressure, not a length")


def test_all_problems_are_named_in_one_paragraph():
    said = refusal({"kind": "c", "parts": [{"side": "0 mm"}], "oops": 1})
    assert said.startswith("f.toml, oops: this key is not known")
    assert said.endswith("Also wrong: kind, parts[#1].side.")
    assert "\n" not in said


def test_a_list_is_not_wrong_beside_what_is_wrong_in_it():
    layer = {"name": "s", "thickness": "3", "density": "1000 kg", "youngs_modulus": "3 kPa", "poisson_ratio": 0.4}
    with pytest.raises(
        InputError, match=r"layers\[s\]\.thickness: '3' has no unit.*Also wrong: layers\[s\]\.density\.$"
    ):
        validated(Tissue, {"schema": 1, "name": "a", "layers": [layer]}, Source("f.toml"))


@pytest.mark.parametrize("value", [3, "text", [1], None])
def test_a_value_where_a_table_belongs(value):
    assert "no table of keys and values" in refusal({"parts": [value]})


def test_a_list_that_is_none():
    assert refusal({"parts": 5}) == "f.toml, parts: 5 is no list."


def test_a_law_must_be_known_and_named():
    assert "allowed: 'neo_hookean'" in refusal({"parts": [{"law": {"law": "hooke"}}]})
    assert "it must name its law" in refusal({"parts": [{"law": {"c10": "1 kPa"}}]})


def test_a_long_value_is_shortened():
    assert len(refusal({"kind": "c" * 5000})) < 200


@pytest.mark.parametrize("number", [0, 2, "1", True, 1.5])
def test_another_schema_number_is_refused_before_anything_else(number):
    assert refusal({"schema": number, "zzz": 1}).startswith(f"f.toml, schema: {number!r} is not a schema")


def test_braces_in_a_value_stay_as_they_are():
    assert "'{kind}'" in refusal({"kind": "{kind}"})
    assert "{x}" in str(problem("{x}"))


def test_nearest_words():
    assert nearest("epidermiss", ["dermis", "epidermis", "fat"]) == "did you mean epidermis or dermis?"
    assert nearest("zz", ["a", "b"]) == "known: a, b."
    assert nearest("SKIN-5N", ["paper", "skin-5N"]) == "did you mean skin-5N?"


def test_paths_for_people():
    table = {"a": [{"name": "x"}, {}]}
    assert shown_path(("a", 0, "b"), table) == "a[x].b"
    assert shown_path(("a", 1, "b"), table) == "a[#2].b"
    assert shown_path((), table) == ""


def test_known_keys_are_those_of_files():
    assert known_keys(Described) == ["kind", "parts", "flag"]
