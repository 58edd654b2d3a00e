"""Baselines on disk: whole, refused with the way out."""

import json
import math
import re
from pathlib import Path

import pytest

from benchmark.errors import InputError, NotComparableError
from benchmark.gate.baseline import (
    Baseline,
    Machine,
    read_baseline,
    write_baseline,
)


def test_what_is_written_reads_back(baseline: Baseline, tmp_path: Path) -> None:
    path = write_baseline(tmp_path / "new" / "b.json", baseline)
    assert read_baseline(path) == baseline
    assert json.loads(path.read_text())["schema"] == 1


def test_without_a_file_it_says_how_to_make_one(tmp_path: Path) -> None:
    path = tmp_path / "b.json"
    with pytest.raises(NotComparableError, match=r"--accept") as caught:
        read_baseline(path)
    assert str(path) in str(caught.value)
    assert caught.value.exit_code == 3


def test_the_way_out_names_the_gate_that_was_asked_for(tmp_path: Path) -> None:
    path, gate = tmp_path / "b.json", Path("my gate.toml")
    with pytest.raises(NotComparableError, match=r"check --gate 'my gate\.toml' --baseline .*b\.json --accept"):
        read_baseline(path, gate)


@pytest.mark.parametrize("text", ["[]", "\x00\x01"])
def test_what_accept_would_not_replace_is_to_be_moved_away(tmp_path: Path, text: str) -> None:
    path = tmp_path / "b.json"
    path.write_text(text)
    with pytest.raises(InputError, match="move it away and make one"):
        read_baseline(path)


@pytest.mark.parametrize("schema", [0, 2, "1", None])
def test_another_schema_cannot_be_compared_with(baseline: Baseline, tmp_path: Path, schema: object) -> None:
    path = write_baseline(tmp_path / "b.json", baseline)
    table = {**json.loads(path.read_text()), "schema": schema}
    path.write_text(json.dumps(table))
    with pytest.raises(NotComparableError, match="schema"):
        read_baseline(path)


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "null", '{"schema": 1}', '{"schema": 1, "gate": 3}', "\x00\x01", "[" * 100_000]
)
def test_what_is_no_baseline_is_bad_input(tmp_path: Path, text: str) -> None:
    path = tmp_path / "b.json"
    path.write_text(text)
    with pytest.raises((InputError, NotComparableError), match=r"b\.json"):
        read_baseline(path)


@pytest.mark.parametrize(
    ("ratios", "says"),
    [
        ([], ": it has 0 entries; allowed: at least 1"),
        (3, ": 3 is no list"),
        ([1.0, 0.0], "[#2]: 0.0 is not allowed; allowed: more than 0"),
        ([-1.0], "[#1]: -1.0 is not allowed; allowed: more than 0"),
        (["2"], "[#1]: '2' is no number"),
        ([None], "[#1]: None is no number"),
        ([math.inf], "[#1]: inf is not finite"),
    ],
)
def test_ratios_must_be_positive_numbers(baseline: Baseline, tmp_path: Path, ratios: object, says: str) -> None:
    path = write_baseline(tmp_path / "b.json", baseline)
    table = json.loads(path.read_text())
    table["timing"]["frame"]["ratios"] = ratios
    path.write_text(json.dumps(table))
    said = f"{path}, timing.frame.ratios{says}; the file is no whole baseline; make one from this version with: "
    with pytest.raises(InputError, match=re.escape(said)):
        read_baseline(path)


def test_a_mistyped_key_is_told_with_the_nearest(baseline: Baseline, tmp_path: Path) -> None:
    path = write_baseline(tmp_path / "b.json", baseline)
    table = json.loads(path.read_text())
    table["timing"]["frame"]["ratio"] = table["timing"]["frame"].pop("ratios")
    path.write_text(json.dumps(table))
    with pytest.raises(InputError, match=r"timing\.frame\.ratio: this key is not known; did you mean ratios\?"):
        read_baseline(path)


def test_an_old_baseline_stays_where_writing_fails(
    baseline: Baseline, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_baseline(tmp_path / "b.json", baseline)

    def full(*_: object) -> None:
        raise OSError("no space left")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match="no space"):
        write_baseline(path, baseline.model_copy(update={"gate": "other"}))
    assert list(tmp_path.iterdir()) == [path]
    assert read_baseline(path) == baseline


def test_ratios_carry_over_to_the_same_processor_and_python() -> None:
    here = Machine(processor="A", python="3.11.7", packages={"numpy": "2.4.6"})
    assert here.same_as(here.model_copy(update={"python": "3.11.9"}))
    assert not here.same_as(here.model_copy(update={"python": "3.12.1"}))
    assert not here.same_as(here.model_copy(update={"processor": "B"}))
    assert here.differences(here) == []
    assert here.differences(here.model_copy(update={"packages": {"numpy": "2.5"}})) == ["numpy 2.4.6 (here 2.5)"]


def test_a_merge_that_was_not_settled_is_told_by_its_line(baseline: Baseline, tmp_path: Path) -> None:
    """The refusal was of JSON, and advised to make a new baseline."""
    path = write_baseline(tmp_path / "b.json", baseline)
    text = path.read_text().replace('"schema": 1,\n', '"schema": 1,\n<<<<<<< HEAD\n', 1)
    path.write_text(text.replace('"gate"', '=======\n"gate"').replace('"made"', '>>>>>>> main\n"made"'))
    with pytest.raises(InputError, match=r"line 3 has a conflict marker of git.*settle it, or make one"):
        read_baseline(path)


def test_a_merge_that_kept_both_sides_is_refused(baseline: Baseline, tmp_path: Path) -> None:
    path = write_baseline(tmp_path / "b.json", baseline)
    text = path.read_text()
    assert '"value": 5.0,' in text
    path.write_text(text.replace('"value": 5.0,', '"value": 5.1,\n"value": 5.0,'))
    with pytest.raises(InputError, match=r"the key 'value' is there twice.*--accept"):
        read_baseline(path)
