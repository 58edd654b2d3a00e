"""`export`: the tables and their columns."""

import json

from bench_hw.tables import read_trial_csv


def test_the_tables_of_a_trial(run, trial_file, tmp_path):
    out = tmp_path / "tables"
    ran = run("export", trial_file, "--out", out, "--json")
    assert (ran.exit_code, ran.stderr) == (0, "")
    assert json.loads(ran.stdout)["rows"] == {"force": 1996, "depth": 200, "camera": 10, "trial": 1987}
    headers = {file.name: file.read_text().splitlines()[0] for file in out.iterdir()}
    assert headers == {
        "force.csv": "time_s,force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,"
        "rdt_sequence,ft_sequence,status",
        "depth.csv": "time_s,depth_mm,target_mm,counts",
        "camera.csv": "time_s,frame,format,bytes",
        "trial.csv": "time_s,depth_mm,force_N",
    }
    assert len(read_trial_csv(out / "trial.csv").time) == 1987


def test_parquet_and_frames_on_request(run, trial_file, tmp_path):
    ran = run("export", trial_file, "--out", tmp_path / "t", "--parquet", "--frames", "--quiet")
    assert (ran.exit_code, ran.stdout) == (0, "")
    assert {file.suffix for file in (tmp_path / "t").iterdir()} == {".csv", ".parquet", ""}
    assert (tmp_path / "t" / "frames" / "000003.jpg").read_bytes() == b"\x03" * 50


def test_a_cut_trial_is_exported_with_a_warning(run, cut_file, tmp_path):
    ran = run("export", cut_file, "--out", tmp_path / "t", "--json")
    assert ran.exit_code == 0
    assert "warning: not complete" in ran.stderr
    assert json.loads(ran.stdout)["complete"] is False


def test_existing_tables_and_a_wrong_axis_are_exit_two(run, trial_file, tmp_path):
    assert run("export", trial_file, "--out", tmp_path / "t").exit_code == 0
    ran = run("export", trial_file, "--out", tmp_path / "t")
    assert ran.exit_code == 2
    assert "the table exists" in ran.stderr
    assert run("export", trial_file, "--out", tmp_path / "t", "--overwrite").exit_code == 0
    ran = run("export", trial_file, "--out", tmp_path / "u", "--press-axis", "z")
    assert ran.exit_code == 2
    assert "--press-axis: press axis 'z'; allowed: +x, -x" in ran.stderr
    assert not (tmp_path / "u").exists()
