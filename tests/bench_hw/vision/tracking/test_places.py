"""What is known of how far markers sank."""

import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.tables import read_marker_csv
from bench_hw.vision.tracking.places import read_sinking, table_of_tracks


def write(tmp_path, text: str):
    path = tmp_path / "sinking.csv"
    path.write_text(text)
    return path


def test_one_history_for_all_markers(tmp_path):
    sinking = read_sinking(write(tmp_path, "time_s,sunk_mm\n0,0\n2,1\n3,3\n"))
    assert np.allclose(sinking.at(1.0, 3), 0.5e-3)
    assert np.allclose(sinking.at(3.0, 2), 3e-3)
    assert np.isnan(sinking.at(3.01, 2)).all()
    assert np.isnan(sinking.at(-0.01, 2)).all()


def test_a_history_for_each_marker_and_none_for_others(tmp_path):
    sinking = read_sinking(write(tmp_path, "time_s,marker,sunk_mm\n0,0,0\n0,2,1\n1,0,2\n1,2,1\n"))
    assert np.allclose(sinking.at(0.5, 3), [1e-3, np.nan, 1e-3], equal_nan=True)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("time_s,depth_mm\n0,0\n", "the column is missing"),
        ("time_s,sunk_mm\n", "no rows"),
        ("time_s,sunk_mm\n0,0\n0,1\n", "does not increase"),
        ("time_s,sunk_mm\n0,x\n", "no finite number"),
        ("time_s,marker,sunk_mm\n0,0.5,0\n", "whole numbers from 0"),
    ],
)
def test_other_tables_are_refused(tmp_path, text, reason):
    with pytest.raises(InputError, match=reason):
        read_sinking(write(tmp_path, text))


def test_missing_markers_have_empty_cells_and_the_reader_takes_it(tmp_path):
    path = tmp_path / "markers.csv"
    with table_of_tracks(path, "mm") as table:
        for frame in range(12):
            places = np.array([[1.0 + frame, -2.0], [np.nan, np.nan], [1 / 3, 1e-7]])
            table.write(frame / 30, places, np.array([1.0, 0.0, 0.87654321]))
        assert table.rows == 36
        assert not path.exists()
    lines = path.read_text().splitlines()
    assert lines[0] == "time_s,marker,x_mm,y_mm,confidence"
    assert lines[4:7] == [
        f"{1 / 30!r},0,2,-2,1.0000",
        f"{1 / 30!r},1,,,0.0000",
        f"{1 / 30!r},2,0.333333333333,1e-07,0.8765",
    ]
    read = read_marker_csv(path)
    assert len(read.time) == 24
    assert set(read.marker.tolist()) == {0, 2}


def test_nothing_is_left_behind_on_failure(tmp_path):
    with pytest.raises(ZeroDivisionError), table_of_tracks(tmp_path / "markers.csv", "px") as table:
        table.write(1 / 0, np.zeros((2, 2)), np.ones(2))
    assert list(tmp_path.iterdir()) == []
