"""Reading and writing marker tracks."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bench_hw.tables import MarkerTable, TableError, read_marker_csv, write_marker_csv


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


@settings(deadline=None, max_examples=40, derandomize=True)
@given(
    frames=st.integers(5, 20),
    markers=st.lists(st.integers(0, 500), min_size=4, max_size=8, unique=True),
    scale=st.floats(1e-6, 1e3),
)
def test_what_is_written_reads_back_the_same(tmp_path_factory, frames, markers, scale):
    time = np.repeat(np.arange(frames) / 29.97, len(markers))
    marker = np.tile(np.array(markers), frames)
    table = MarkerTable(time, marker, np.sin(time + marker) * scale, np.cos(time * marker) * scale)
    read = read_marker_csv(write_marker_csv(tmp_path_factory.mktemp("round") / "markers.csv", table))
    np.testing.assert_array_equal(read.time, table.time)
    np.testing.assert_array_equal(read.marker, table.marker)
    np.testing.assert_allclose(read.x, table.x, rtol=1e-11)
    np.testing.assert_allclose(read.y, table.y, rtol=1e-11)
