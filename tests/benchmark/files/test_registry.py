from pathlib import Path

import pytest

from benchmark.errors import InputError
from benchmark.files.registry import find, shipped_scenarios, shipped_tissues


def test_what_ships():
    assert {"skin_forearm", "ecoflex_00_30", "dragon_skin_10", "rtv3498_sheet"} <= set(shipped_tissues())
    assert {"skin-5N", "paper", "phantom"} <= set(shipped_scenarios())
    assert all(entry.path.is_file() and entry.name == entry.path.stem for entry in shipped_tissues().values())


def test_a_name_means_what_ships():
    assert find("skin_forearm", "tissue") == shipped_tissues()["skin_forearm"].path


@pytest.mark.parametrize("text", ["mine.toml", "./mine", "a/b", "a\\b"])
def test_a_path_is_taken_as_one(text, tmp_path):
    assert find(text, "tissue", tmp_path) == tmp_path / text


def test_a_path_object_is_a_path_whatever_its_name():
    assert find(Path("skin_forearm"), "tissue") == Path("skin_forearm")


def test_a_plain_name_may_be_a_file(tmp_path):
    (tmp_path / "mine").write_text("")
    assert find("mine", "tissue", tmp_path) == tmp_path / "mine"


def test_a_name_that_is_nothing_lists_the_nearest():
    with pytest.raises(InputError, match="did you mean skin_forearm"):
        find("skin_forarm", "tissue")
    with pytest.raises(InputError, match="known: paper, phantom, skin-5N"):
        find("zzzz", "scenario")
    for odd in ("", "x" * 400, "a\0b"):
        with pytest.raises(InputError):
            find(odd, "tissue")
