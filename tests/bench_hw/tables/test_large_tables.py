"""Large tables are read piece by piece, to the same numbers and the same errors."""

import numpy as np
import pytest

from bench_hw.errors import TableError
from bench_hw.tables import columns, read_marker_csv, read_trial_csv

ROWS = "".join(f"{0.01 * k:.2f},{0.001 * k:.3f},{k % 7}e-1\n" for k in range(500))


@pytest.fixture
def in_pieces(monkeypatch):
    """As if each file were large."""
    read = []
    whole = columns._piece
    monkeypatch.setattr(columns, "LARGE", 0)
    monkeypatch.setattr(columns, "PIECE", 1000)
    monkeypatch.setattr(columns, "_piece", lambda *arguments: read.append(1) or whole(*arguments))
    return read


def write(path, header, body, end="\n", mark=b""):
    path.write_bytes(mark + (header + "\n" + body).replace("\n", end).encode())
    return path


@pytest.mark.parametrize(("end", "mark"), [("\n", b""), ("\r\n", b""), ("\n", b"\xef\xbb\xbf")])
def test_the_numbers_are_the_same(tmp_path, in_pieces, monkeypatch, end, mark):
    path = write(tmp_path / "a.csv", "time_s, depth_mm,force_N", ROWS, end, mark)
    pieces = read_trial_csv(path)
    assert len(in_pieces) > 5
    monkeypatch.setattr(columns, "LARGE", 1 << 40)
    whole = read_trial_csv(path)
    for name in ("time", "depth", "force"):
        np.testing.assert_array_equal(getattr(pieces, name), getattr(whole, name))


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ("3.00,abc,1\n", "row 302, column 'depth_mm', value 'abc'"),
        ("3.00,1\n", "row 302.*the row has 2 cells"),
        ("\n", "row 302.*the row is blank"),
        ("3.00,1e308,1\n", "row 302, column 'depth_mm', value '1e.308'.*too large"),
        ("3.00,1e999,1\n", "row 302, column 'depth_mm'.*beyond what a double holds"),
        ("0.00,1,1\n", "row 302, column 'time_s'.*does not increase"),
    ],
)
def test_the_errors_are_the_same(tmp_path, in_pieces, wrong, says):
    lines = ROWS.splitlines(keepends=True)
    path = write(tmp_path / "a.csv", "time_s,depth_mm,force_N", "".join([*lines[:300], wrong, *lines[301:]]))
    with pytest.raises(TableError, match=says):
        read_trial_csv(path)


def test_a_missing_column_and_gaps_in_marker_tracks(tmp_path, in_pieces):
    with pytest.raises(TableError, match=r"column .force_N.*the column is missing"):
        read_trial_csv(write(tmp_path / "a.csv", "time_s,depth_mm,load_N", ROWS))
    tracks = "".join(f"{0.1 * k:.1f},0,{k},0\n" if k % 9 else f"{0.1 * k:.1f},0,,\n" for k in range(200))
    table = read_marker_csv(write(tmp_path / "m.csv", "time_s,marker,x_mm,y_mm", tracks))
    assert len(table.time) == 200 - 23
