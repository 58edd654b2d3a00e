"""A trial as tables: raw rows exactly, pictures byte for byte."""

import csv
from pathlib import Path

import numpy as np
import pytest

from bench_hw.errors import TrialFileError
from bench_hw.tables import read_trial_csv
from bench_hw.tables.output import csv_text
from bench_hw.trial_file import ForceRecord, FrameRecord, PositionRecord, read_trial_mcap
from bench_hw.trial_file.export import ExportOptions, export_trial


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_force_rows_come_back_exactly(make_records, record, tmp_path):
    records = make_records(1.0)
    export_trial(record(records), tmp_path / "out")
    rows = rows_of(tmp_path / "out" / "force.csv")
    assert list(rows[0]) == [
        "time_s",
        "force_x_N",
        "force_y_N",
        "force_z_N",
        "torque_x_Nm",
        "torque_y_Nm",
        "torque_z_Nm",
        "rdt_sequence",
        "ft_sequence",
        "status",
    ]
    samples = [item for item in records if isinstance(item, ForceRecord)]
    assert len(rows) == len(samples) == 1000
    for row, item in zip(rows, samples, strict=True):
        assert tuple(float(row[f"force_{axis}_N"]) for axis in "xyz") == item.force
        assert tuple(float(row[f"torque_{axis}_Nm"]) for axis in "xyz") == item.torque
        assert float(row["time_s"]) == pytest.approx(item.time - 50.0, abs=1e-9)
        assert (int(row["rdt_sequence"]), int(row["ft_sequence"])) == (item.rdt_sequence, item.ft_sequence)
        assert row["status"] == "0"


def test_depth_and_camera_rows(make_records, record, tmp_path):
    records = make_records(1.0)
    records.append(PositionRecord(51.02, 1e-3))
    export_trial(record(records), tmp_path)
    depth = rows_of(tmp_path / "depth.csv")
    assert list(depth[0]) == ["time_s", "depth_mm", "target_mm", "counts"]
    assert (depth[50]["time_s"], depth[50]["depth_mm"]) == ("0.5", "2")
    assert depth[50]["counts"] == "50"
    assert (depth[-1]["target_mm"], depth[-1]["counts"]) == ("", "")
    camera = rows_of(tmp_path / "camera.csv")
    assert list(camera[0]) == ["time_s", "frame", "format", "bytes"]
    frames = [item for item in records if isinstance(item, FrameRecord)]
    assert [int(row["bytes"]) for row in camera] == [len(item.data) for item in frames]
    assert [int(row["frame"]) for row in camera] == list(range(30))


def test_trial_csv_is_the_joined_table(three_seconds, tmp_path):
    result = export_trial(three_seconds, tmp_path / "out")
    assert rows_of(tmp_path / "out" / "trial.csv")[0].keys() == {"time_s", "depth_mm", "force_N"}
    table, direct = read_trial_csv(tmp_path / "out" / "trial.csv"), read_trial_mcap(three_seconds)
    np.testing.assert_array_equal(table.time, direct.time)
    np.testing.assert_array_equal(table.force, direct.force)
    np.testing.assert_allclose(table.depth, direct.depth, rtol=1e-11, atol=1e-18)
    assert dict(result.rows) == {"force": 3000, "depth": 301, "camera": 90, "trial": 3000}
    assert result.complete
    assert result.warnings == ()


def test_pictures_come_back_byte_for_byte(make_records, record, tmp_path):
    records = make_records(1.0)
    result = export_trial(record(records), tmp_path / "out", ExportOptions(frames=True))
    frames = [item.data for item in records if isinstance(item, FrameRecord)]
    listed = [row["file"] for row in rows_of(tmp_path / "out" / "camera.csv")]
    assert [(tmp_path / "out" / name).read_bytes() for name in listed] == frames
    assert listed[0] == "frames/000000.jpg"
    assert result.frames == 30


def test_a_picture_of_no_known_encoding_stays_in_its_folder(record, tmp_path):
    path = record([FrameRecord(50.0, 0, b"x", "../../evil")])
    export_trial(path, tmp_path / "out", ExportOptions(frames=True))
    assert (tmp_path / "out" / "frames" / "000000.bin").read_bytes() == b"x"


def test_parquet_holds_the_same(three_seconds, tmp_path):
    import pyarrow.parquet as pq

    result = export_trial(three_seconds, tmp_path, ExportOptions(parquet=True))
    assert len(result.files) == 8
    force = pq.read_table(tmp_path / "force.parquet")
    rows = rows_of(tmp_path / "force.csv")
    assert force.column_names == list(rows[0])
    assert force["force_x_N"].to_pylist() == [float(row["force_x_N"]) for row in rows]
    assert force["rdt_sequence"].to_pylist() == [int(row["rdt_sequence"]) for row in rows]
    assert pq.read_table(tmp_path / "trial.parquet").num_rows == 3000


def test_tables_that_exist_are_kept_unless_told_otherwise(three_seconds, tmp_path):
    (tmp_path / "depth.csv").write_text("a measurement")
    with pytest.raises(TrialFileError, match=r"depth\.csv: the table exists"):
        export_trial(three_seconds, tmp_path)
    assert (tmp_path / "depth.csv").read_text() == "a measurement"
    assert not (tmp_path / "force.csv").exists()
    export_trial(three_seconds, tmp_path, ExportOptions(overwrite=True))
    assert len(rows_of(tmp_path / "depth.csv")) == 301


def test_a_cut_trial_gives_what_is_whole_and_says_so(three_seconds, tmp_path):
    content = three_seconds.read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(content[: len(content) // 2])
    result = export_trial(cut, tmp_path / "out")
    assert not result.complete
    assert any("stops without its end" in warning for warning in result.warnings)
    assert 0 < result.rows["force"] < 3000
    assert len(rows_of(tmp_path / "out" / "force.csv")) == result.rows["force"]


def test_without_positions_there_is_no_trial_table(make_records, record, tmp_path):
    path = record(item for item in make_records(1.0) if isinstance(item, ForceRecord))
    result = export_trial(path, tmp_path / "out")
    assert "trial" not in result.rows
    assert result.warnings == ("no trial.csv: no row has both force and depth",)
    assert not (tmp_path / "out" / "trial.csv").exists()
    assert rows_of(tmp_path / "out" / "depth.csv") == []


def test_another_press_axis_can_be_given(three_seconds, tmp_path):
    export_trial(three_seconds, tmp_path, ExportOptions(press_axis="+y"))
    assert {row["force_N"] for row in rows_of(tmp_path / "trial.csv")} == {"-0.5"}


def test_a_folder_that_cannot_be_made_is_refused(three_seconds, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(TrialFileError, match="the folder cannot be written"):
        export_trial(three_seconds, tmp_path / "file")


def test_an_interrupted_export_leaves_no_table_that_the_next_one_would_refuse(
    make_records, record, tmp_path, monkeypatch
):
    trial, out, calls = record(make_records(1.0)), tmp_path / "out", []

    def interrupted(columns):
        calls.append(columns)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return csv_text(columns)

    monkeypatch.setattr("bench_hw.trial_file.export.csv_text", interrupted)
    with pytest.raises(KeyboardInterrupt):
        export_trial(trial, out)
    assert not out.exists()
    export_trial(trial, out)
    assert (out / "force.csv").is_file()


@pytest.mark.parametrize("at", [1, 2, 3, 4])
@pytest.mark.parametrize("there", [False, True])
def test_a_disk_that_fills_between_two_tables_leaves_none(three_seconds, tmp_path, monkeypatch, at, there):
    out, real, done = tmp_path / "out", Path.replace, []
    if there:
        out.mkdir()
        (out / "notes.txt").write_text("mine")

    def replace(self, target):
        done.append(target)
        if len(done) == at:
            raise OSError(28, "No space left on device")
        return real(self, target)

    monkeypatch.setattr(Path, "replace", replace)
    with pytest.raises(TrialFileError, match="No space left"):
        export_trial(three_seconds, out, ExportOptions(frames=True))
    assert [path.name for path in out.rglob("*")] == ["notes.txt"] if there else not out.exists()
