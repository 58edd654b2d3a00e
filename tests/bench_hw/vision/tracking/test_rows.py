"""The table of tracks."""

import numpy as np
import pytest

from bench_hw.tables import read_marker_csv
from bench_hw.vision.tracking.rows import table_of_tracks


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
