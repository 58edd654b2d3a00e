"""Reading and writing trial CSV files: what is accepted, and each refusal with its place."""

import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bench_hw.errors import InputError
from bench_hw.tables import (
    MarkerTable,
    TableError,
    TrialTable,
    read_marker_csv,
    read_trial_csv,
    write_marker_csv,
    write_trial_csv,
)


def test_columns_come_back_in_si(good_lines, write):
    table = read_trial_csv(write(good_lines))
    np.testing.assert_array_equal(table.time, np.arange(24) / 10)
    np.testing.assert_allclose(table.depth, np.arange(24) / 4e3, rtol=1e-15)
    np.testing.assert_array_equal(table.force, np.arange(24) / 8)
    np.testing.assert_allclose(table.extra["gap"], (12 - np.arange(24) / 4) * 1e-3, rtol=1e-15)
    assert table.extra_units == {"gap": "mm"}
    assert table.source.endswith("trial.csv")


def test_totals_in_the_last_row_are_refused(good_lines, write):
    """A spreadsheet's sums were the deepest row of the press; a last row far beyond one column alone is none."""
    depth, force = sum(range(24)) / 4, sum(range(24)) / 8
    with pytest.raises(TableError, match=r"row 26.*the last row holds the sums of the columns depth_mm and force_N"):
        read_trial_csv(write([*good_lines, f"27.6,{depth},{force},0"]))
    assert len(read_trial_csv(write([*good_lines, f"27.6,{depth},3.0,0"])).time) == 25


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_line_ends_and_byte_order_mark_do_not_matter(good_lines, write, end, encoding):
    assert len(read_trial_csv(write(good_lines, end, encoding)).time) == 24


def test_a_missing_last_line_end_and_blank_lines_at_the_end_do_not_matter(good_lines, tmp_path):
    for tail in ("", "\n", "\n\n\r\n"):
        path = tmp_path / "trial.csv"
        path.write_text("\n".join(good_lines) + tail)
        assert len(read_trial_csv(path).time) == 24


def test_columns_in_any_order_with_blanks_and_quotes(good_lines, write):
    lines = ['"force_N", time_s ,depth_mm', *(f'"{i / 8}", {i} , {i}' for i in range(20))]
    table = read_trial_csv(write(lines))
    np.testing.assert_array_equal(table.force, np.arange(20) / 8)
    np.testing.assert_array_equal(table.time, np.arange(20))


@pytest.mark.parametrize("numbered", [False, True], ids=["at the end", "of row numbers"])
def test_columns_without_a_name_are_left_out(good_lines, write, numbered):
    """As a spreadsheet writes an empty column, and a data frame its index."""
    head, *rows = good_lines
    changed = [f",{head}", *(f"{n},{row}" for n, row in enumerate(rows))] if numbered else [f"{x}," for x in good_lines]
    table, other = read_trial_csv(write(changed)), read_trial_csv(write(good_lines))
    np.testing.assert_array_equal(table.force, other.force)
    assert table.extra.keys() == other.extra.keys()


def test_rows_of_commas_at_the_end_do_not_matter(good_lines, write):
    commas = "," * good_lines[0].count(",")
    table, other = read_trial_csv(write([*good_lines, commas, commas])), read_trial_csv(write(good_lines))
    np.testing.assert_array_equal(table.force, other.force)
    with pytest.raises(TableError, match=r"row 5.*the cell is empty"):
        read_trial_csv(write([*good_lines[:4], commas, *good_lines[4:]]))


def test_text_columns_are_left_out_and_numbers_without_unit_carried(good_lines, write):
    lines = [f"{line},{'phase' if i == 0 else 'hold'},{'cycle' if i == 0 else 3}" for i, line in enumerate(good_lines)]
    table = read_trial_csv(write(lines))
    assert set(table.extra) == {"gap", "cycle"}
    assert (table.extra["cycle"] == 3).all()
    assert "cycle" not in table.extra_units


def spoilt(lines: list[str], row: int, column: int, cell: str) -> list[str]:
    cells = lines[row - 1].split(",")
    cells[column] = cell
    return [*lines[: row - 1], ",".join(cells), *lines[row:]]


@pytest.mark.parametrize(("column", "name"), [(0, "time_s"), (1, "depth_mm"), (2, "force_N"), (3, "gap_mm")])
@pytest.mark.parametrize("cell", ["abc", "nan", "NaN", "inf", "-Infinity", "", "1_0", "0x10", "1 2", "1e999", "１"])
def test_a_cell_that_is_no_finite_number_is_named(good_lines, write, column, name, cell):
    path = write(spoilt(good_lines, 7, column, cell))
    with pytest.raises(TableError) as caught:
        read_trial_csv(path)
    assert (caught.value.path, caught.value.row, caught.value.column) == (path, 7, name)
    assert caught.value.value == ("inf" if cell == "1e999" else cell)
    for part in (str(path), "row 7", name, "allowed: a finite number"):
        assert part in str(caught.value)


@pytest.mark.parametrize("cell", ["0.3", "0.29999", "-4"])
def test_time_that_does_not_increase_is_named(good_lines, write, cell):
    with pytest.raises(TableError, match=r"row 6, column 'time_s'.*does not increase.*allowed: strictly increasing"):
        read_trial_csv(write(spoilt(good_lines, 6, 0, cell)))


@pytest.mark.parametrize("name", ["time_s", "depth_mm", "force_N"])
def test_a_missing_column_is_named_with_those_that_are_there(good_lines, write, name):
    lines = [good_lines[0].replace(name, "other"), *good_lines[1:]]
    with pytest.raises(TableError, match=rf"row 1, column '{name}'.*missing.*'other'"):
        read_trial_csv(write(lines))


def test_a_file_with_semicolons_says_commas(good_lines, write):
    with pytest.raises(TableError, match="separated by commas"):
        read_trial_csv(write([line.replace(",", ";") for line in good_lines]))


@pytest.mark.parametrize("count", [0, 1, 3, 19])
def test_too_few_rows(good_lines, write, count):
    with pytest.raises(TableError, match=rf"has {count} rows; allowed: at least 20 rows"):
        read_trial_csv(write(good_lines[: count + 1]))


def test_twenty_rows_are_enough(good_lines, write):
    assert len(read_trial_csv(write(good_lines[:21])).time) == 20


def test_two_columns_of_one_name_or_one_quantity(good_lines, write):
    with pytest.raises(TableError, match=r"'force_N'.*there 2 times"):
        read_trial_csv(write([good_lines[0].replace("gap_mm", "force_N"), *good_lines[1:]]))
    with pytest.raises(TableError, match="'depth_mm' and 'depth_um' are the same quantity"):
        read_trial_csv(write([good_lines[0].replace("gap_mm", "depth_um"), *good_lines[1:]]))


@pytest.mark.parametrize(("row", "count"), [("1.25,2,3", 3), ("1.25,2,3,4,5", 5)])
def test_a_ragged_row_is_named(good_lines, write, row, count):
    with pytest.raises(TableError, match=rf"\(row 14\): the row has {count} cells; allowed: 4 cells"):
        read_trial_csv(write([*good_lines[:13], row, *good_lines[14:]]))


def test_a_blank_row_or_a_comment_in_the_middle_is_named(good_lines, write):
    with pytest.raises(TableError, match=r"\(row 14\): the row is blank"):
        read_trial_csv(write([*good_lines[:13], "", *good_lines[13:]]))
    with pytest.raises(TableError, match=r"\(row 14\): the row has 1 cells"):
        read_trial_csv(write([*good_lines[:13], "# a remark", *good_lines[13:]]))


def test_a_quoted_cell_over_two_lines_and_an_endless_quote_are_named(good_lines, write):
    for bad in ('1.25,2,3,"4\n5"', '1.25,2,3,"4'):
        with pytest.raises(TableError, match="cannot be split"):
            read_trial_csv(write([*good_lines[:13], bad, *good_lines[14:]]))


@pytest.mark.parametrize("content", [b"", b"\n\n", b"\xef\xbb\xbf", b"  \r\n "])
def test_an_empty_file(tmp_path, content):
    path = tmp_path / "trial.csv"
    path.write_bytes(content)
    with pytest.raises(TableError, match="the file is empty"):
        read_trial_csv(path)


def test_a_missing_file_a_folder_and_another_encoding(good_lines, write, tmp_path):
    with pytest.raises(TableError, match="no such file"):
        read_trial_csv(tmp_path / "none.csv")
    with pytest.raises(TableError, match="cannot be read"):
        read_trial_csv(tmp_path)
    with pytest.raises(TableError, match=r"row 1, value 'byte 0xff'.*no UTF-8"):
        read_trial_csv(write(good_lines, encoding="utf-16"))
    with pytest.raises(TableError, match=r"row 3, .*no UTF-8"):
        read_trial_csv(write(spoilt(good_lines, 3, 3, "µ"), encoding="latin-1"))


def test_a_table_error_is_an_input_error_of_exit_code_two(tmp_path):
    with pytest.raises(ValueError, match="no such file") as caught:
        read_trial_csv(str(tmp_path / "none.csv"))
    assert isinstance(caught.value, InputError)
    assert caught.value.exit_code == 2


def test_a_file_of_a_hundred_thousand_rows_is_read_whole(tmp_path):
    count = 100_000
    table = TrialTable(np.arange(count) * 1e-3, np.linspace(0, 2e-3, count), np.sin(np.arange(count) / 1e4))
    read = read_trial_csv(write_trial_csv(tmp_path / "long.csv", table))
    np.testing.assert_array_equal(read.time, table.time)
    np.testing.assert_allclose(read.force, table.force, rtol=1e-11, atol=1e-15)


finite = st.floats(-999.0, 999.0, allow_subnormal=False)


@st.composite
def tables(draw: st.DrawFn) -> TrialTable:
    count = draw(st.integers(20, 60))
    column = st.lists(finite, min_size=count, max_size=count).map(np.array)
    time = draw(st.lists(finite, min_size=count, max_size=count, unique=True).map(sorted).map(np.array))
    extra = draw(st.dictionaries(st.sampled_from(["gap", "force_x", "cycle", "torque_z"]), column, max_size=3))
    units = {"gap": "um", "force_x": "N", "torque_z": "Nmm"}
    return TrialTable(time, draw(column), draw(column), extra, "", {n: units[n] for n in extra if n in units})


@settings(max_examples=60)
@given(table=tables())
def test_what_is_written_reads_back_the_same(tmp_path_factory, table):
    read = read_trial_csv(write_trial_csv(tmp_path_factory.mktemp("round") / "trial.csv", table))
    np.testing.assert_array_equal(read.time, table.time)
    np.testing.assert_allclose(read.depth, table.depth, rtol=1e-11)
    np.testing.assert_allclose(read.force, table.force, rtol=1e-11)
    assert list(read.extra) == list(table.extra)
    assert read.extra_units == table.extra_units
    for name, values in table.extra.items():
        np.testing.assert_allclose(read.extra[name], values, rtol=1e-11)


@settings(max_examples=200)
@given(content=st.one_of(st.binary(max_size=300), st.text(alphabet='0123456789.,-+eE\n\r" naif#;\t', max_size=300)))
def test_no_content_ends_in_anything_but_a_table_or_a_table_error(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "any.csv"
    body = content if isinstance(content, bytes) else content.encode()
    path.write_bytes(b"time_s,depth_mm,force_N\n" + body)
    outcome = table_or_refusal(path)
    assert str(path) in str(outcome) if isinstance(outcome, TableError) else len(outcome.time) >= 20


def table_or_refusal(path: Path) -> TrialTable | TableError:
    try:
        return read_trial_csv(path)
    except TableError as error:
        return error


def test_a_table_that_could_not_be_read_is_not_written(tmp_path):
    path = tmp_path / "trial.csv"
    path.write_text("before")
    good = np.arange(30.0)
    bad = np.where(good == 4, np.nan, good)
    for time, depth, force, match in (
        (good, bad, good, "row 6, column 'depth_mm', value 'nan'"),
        (good[::-1], good, good, "does not increase"),
        (good, good, good[:-1], r"shape \(29,\)"),
        (good[:5], good[:5], good[:5], "at least 20 rows"),
    ):
        with pytest.raises(TableError, match=match):
            write_trial_csv(path, TrialTable(time, depth, force))
    assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]


DATA = os.environ.get("TISSUEBENCH_DATA", "")


@pytest.mark.skipif(not DATA, reason="TISSUEBENCH_DATA is not set")
def test_every_file_of_the_measured_pig_indentations_reads():
    files = sorted((Path(DATA) / "pig_indentation").glob("*/*.csv"))
    assert len(files) == 95
    for file in files:
        table = read_trial_csv(file)
        assert len(table.time) >= 20
        assert set(table.extra) == {"gap"}
        assert np.abs(table.depth).max() < 0.02


@pytest.fixture
def marker_lines() -> list[str]:
    rows = [f"{k / 30!r},{m},{m * 5 + k / 100},{-m + k / 50}" for k in range(10) for m in range(3)]
    return ["time_s,marker,x_mm,y_mm", *rows]


def test_rows_come_back_in_si_and_in_the_files_order(marker_lines, write):
    table = read_marker_csv(write(marker_lines))
    np.testing.assert_array_equal(table.marker, np.tile([0, 1, 2], 10))
    assert table.marker.dtype == np.int64
    np.testing.assert_array_equal(table.time, np.repeat(np.arange(10) / 30, 3))
    np.testing.assert_allclose(table.x[:3], [0, 5e-3, 10e-3], atol=1e-18)
    np.testing.assert_allclose(table.y[-1], (-2 + 9 / 50) * 1e-3)


def test_rows_sorted_by_marker_are_as_good(marker_lines, write):
    by_marker = sorted(marker_lines[1:], key=lambda line: int(line.split(",")[1]))
    assert len(read_marker_csv(write([marker_lines[0], *by_marker])).time) == 30


def test_a_marker_that_was_not_seen_is_a_gap(marker_lines, write):
    lines = [f"{line},{'confidence' if i == 0 else 0.9}" for i, line in enumerate(marker_lines)]
    lines[5] = f"{1 / 30!r},1,,,"
    table = read_marker_csv(write(lines))
    assert len(table.time) == 29
    assert (table.marker == 1).sum() == 9
    assert np.isfinite(table.x).all()


@pytest.mark.parametrize(
    ("row", "match"),
    [
        ("0.5,1,,3", "row 9, column 'x_mm'.*one coordinate is empty"),
        ("0.5,1,3,", "row 9, column 'y_mm'.*one coordinate is empty"),
        ("0.5,1,nan,nan", "row 9, column 'x_mm', value 'nan'.*no finite number"),
        ("0.5,,3,3", "row 9, column 'marker'.*empty"),
        ("0.5,1.5,3,3", "row 9, column 'marker', value '1.5'.*whole number from 0"),
        ("0.5,-1,3,3", "row 9, column 'marker', value '-1'"),
        (",1,3,3", "row 9, column 'time_s'.*empty"),
    ],
)
def test_what_is_wrong_in_a_row_is_named(marker_lines, write, row, match):
    with pytest.raises(TableError, match=match):
        read_marker_csv(write([*marker_lines[:8], row, *marker_lines[9:]]))


def test_time_must_increase_for_each_marker(marker_lines, write):
    lines = [*marker_lines[:8], marker_lines[5], *marker_lines[9:]]
    with pytest.raises(TableError, match=r"row 9, column 'time_s'.*for marker 1 at 0\.0333"):
        read_marker_csv(write(lines))


def test_a_missing_column_and_too_few_rows(marker_lines, write):
    with pytest.raises(TableError, match=r"column 'marker'.*missing"):
        read_marker_csv(write([marker_lines[0].replace("marker", "id"), *marker_lines[1:]]))
    with pytest.raises(TableError, match="has 19 rows"):
        read_marker_csv(write(marker_lines[:20]))


@settings(max_examples=40)
@given(
    frames=st.integers(5, 20),
    markers=st.lists(st.integers(0, 500), min_size=4, max_size=8, unique=True),
    scale=st.floats(1e-6, 1e3),
)
def test_written_tracks_read_back_the_same(tmp_path_factory, frames, markers, scale):
    time = np.repeat(np.arange(frames) / 29.97, len(markers))
    marker = np.tile(np.array(markers), frames)
    table = MarkerTable(time, marker, np.sin(time + marker) * scale, np.cos(time * marker) * scale)
    read = read_marker_csv(write_marker_csv(tmp_path_factory.mktemp("round") / "markers.csv", table))
    np.testing.assert_array_equal(read.time, table.time)
    np.testing.assert_array_equal(read.marker, table.marker)
    np.testing.assert_allclose(read.x, table.x, rtol=1e-11)
    np.testing.assert_allclose(read.y, table.y, rtol=1e-11)
