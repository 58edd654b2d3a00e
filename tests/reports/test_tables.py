import csv
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reports.tables import csv_text, read_cell, write_csv

NUMBERS = st.one_of(st.none(), st.floats(), st.integers(-(2**60), 2**60))
TEXTS = st.text(st.characters(codec="utf-8"), max_size=12)


def read(path):
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.reader(stream))


def number(cell):
    return math.nan if cell == "" else float(cell)


@given(values=st.lists(NUMBERS, max_size=30), names=st.lists(TEXTS.filter(bool), min_size=2, max_size=2, unique=True))
@settings(max_examples=60, deadline=None)
def test_what_is_written_reads_back_to_the_same_doubles(tmp_path_factory, values, names):
    path = write_csv(tmp_path_factory.mktemp("t") / "a.csv", {names[0]: values, names[1]: range(len(values))})
    header, *rows = read(path)
    assert [read_cell(name) for name in header] == names
    wanted = [math.nan if value is None else float(value) for value in values]
    assert np.array_equal([number(row[0]) for row in rows], wanted, equal_nan=True)
    assert [int(row[1]) for row in rows] == list(range(len(values)))


@given(texts=st.lists(TEXTS, max_size=10))
@settings(max_examples=60, deadline=None)
def test_any_text_reads_back(tmp_path_factory, texts):
    path = write_csv(tmp_path_factory.mktemp("t") / "a.csv", {"layer": texts, "n": [0] * len(texts)})
    assert [read_cell(row[0]) for row in read(path)[1:]] == texts


def test_the_text_of_a_table_is_this():
    columns = {
        "step": np.array([1, 2]),
        "force_N": np.array([0.1, np.nan]),
        "layer": ["dermis", None],
        "ok": [True, np.False_],
        "mixed": [np.float64(1 / 3), np.int32(7)],
    }
    assert csv_text(columns) == ("step,force_N,layer,ok,mixed\n1,0.1,dermis,true,0.3333333333333333\n2,,,false,7\n")


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"a": [1, 2], "b": [1]}, "got a 2, b 1"),
        ({}, "at least one column"),
        ({"": [1]}, "at least one column, each with a name"),
        ({"a": np.zeros((2, 2))}, "column 'a' has 2 dimensions"),
        ({"a": np.float64(1)}, "column 'a' has 0 dimensions"),
        ({"a": "dermis"}, "column 'a' is one text"),
    ],
)
def test_a_table_that_is_none_is_refused_and_nothing_written(tmp_path, columns, message):
    with pytest.raises(ValueError, match=message):
        write_csv(tmp_path / "a.csv", columns)
    assert list(tmp_path.iterdir()) == []


def test_a_cell_that_is_no_value_is_named():
    with pytest.raises(TypeError, match="column 'a', row 2 is a list"):
        csv_text({"a": [1, [2]]})


def test_a_written_table_is_the_path_given(tmp_path):
    assert write_csv(tmp_path / "tables" / "a.csv", {"a": []}) == tmp_path / "tables" / "a.csv"
    assert (tmp_path / "tables" / "a.csv").read_bytes() == b"a\n"


@pytest.mark.parametrize("text", ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1", "'=1"])
def test_no_spreadsheet_runs_a_text(tmp_path, text):
    path = write_csv(tmp_path / "a.csv", {text: [text], "n": [-1.5]})
    ((name, _), (cell, number)) = read(path)
    assert name == cell == f"'{text}"
    assert read_cell(cell) == text
    assert number == "-1.5"


@pytest.mark.parametrize("text", ["-1.5", "+3e-4", "dermis", "'quoted'", "a=b", ""])
def test_plain_text_and_numbers_stay_as_they_are(tmp_path, text):
    ((_, _), (cell, _)) = read(write_csv(tmp_path / "a.csv", {"layer": [text], "n": [1]}))
    assert (cell, read_cell(cell)) == (text, text)
