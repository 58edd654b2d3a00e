"""`benchmark sweep` from the command line to the files it leaves, also after a kill."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

SMALL = ("--set", "fem.mesh=coarse", "--set", "load.observations=4", "--set", "load.peak=0.5 N")
VARY = ("--vary", "dermis.youngs_modulus=100 kPa:400 kPa:2:log", "--vary", "tool.radius=3 mm,5 mm")


def frame_of(out: Path) -> pd.DataFrame:
    return pd.read_parquet(out / "points.parquet")


@pytest.mark.usefixtures("as_told")
def test_a_grid_leaves_a_row_a_point_and_a_report(benchmark_cli, tmp_path: Path) -> None:
    out = tmp_path / "sweep"
    called = benchmark_cli("sweep", "skin-5N", *SMALL, *VARY, "--workers", "2", "--out", out, "--json", "--quiet")
    assert called.code == 0, called.err
    assert called.err == ""
    document = json.loads(called.out)
    assert (document["points"], document["ok"], document["failed"]) == (4, 4, [])
    assert document["out"] == str(out)
    frame = frame_of(out)
    assert set(document["results"]) <= set(frame)
    assert list(frame["tool.radius_mm"]) == [3.0, 5.0, 3.0, 5.0]
    assert list(frame["dermis.youngs_modulus"]) == ["100 kPa", "100 kPa", "400 kPa", "400 kPa"]
    assert (frame.status == "ok").all()
    assert frame.reason.isna().all()
    deep = frame.set_index(["dermis.youngs_modulus_kPa", "tool.radius_mm"]).fem_depth_mm
    assert deep[100.0, 3.0] > deep[400.0, 3.0] > deep[400.0, 5.0]
    page = (out / "report.html").read_text()
    for word in ("dermis.youngs_modulus", "All 4 points have results", "<svg", "points.parquet"):
        assert word in page
    assert "https://" not in page


def test_another_tissue_is_the_one_that_is_swept(benchmark_cli, tmp_path: Path) -> None:
    vary = ("--vary", "dermis.youngs_modulus=100 kPa,200 kPa")
    called = benchmark_cli("sweep", "skin-5N", "--tissue", tmp_path / "none.toml", *vary, "--out", tmp_path / "s")
    assert called.code == 2
    assert "none.toml" in called.err


@pytest.mark.slow
def test_a_point_is_the_run_of_its_values(benchmark_cli, tmp_path: Path) -> None:
    vary = ("--vary", "dermis.youngs_modulus=100 kPa,200 kPa")
    assert benchmark_cli("sweep", "skin-5N", *SMALL, *vary, "--out", tmp_path / "s", "--quiet").code == 0
    row = frame_of(tmp_path / "s").iloc[1]
    same = ("--set", f"dermis.youngs_modulus={row['dermis.youngs_modulus']}")
    assert benchmark_cli("run", "skin-5N", *SMALL, *same, "--out", tmp_path / "r", "--quiet").code == 0
    run = pd.read_csv(tmp_path / "r/tables/max_deformation.csv").groupby("layer").max()
    for layer in ("epidermis", "dermis", "subcutaneous_fat"):
        for model in ("fem", "wave"):
            assert row[f"{layer}.{model}_max_mm"] == pytest.approx(run.loc[layer, f"{model}_mm"], rel=1e-9)


def test_the_same_command_again_computes_nothing(benchmark_cli, tmp_path: Path) -> None:
    arguments = ("sweep", "skin-5N", *SMALL, "--vary", "tool.radius=3 mm,5 mm", "--out", tmp_path / "s")
    assert benchmark_cli(*arguments).code == 0
    first = frame_of(tmp_path / "s")
    again = benchmark_cli(*arguments)
    assert again.code == 0
    assert "2 of 2 points are there already" in again.err
    pd.testing.assert_frame_equal(first, frame_of(tmp_path / "s"))


def test_failed_points_are_kept_with_their_reason(benchmark_cli, tmp_path: Path) -> None:
    vary = ("--vary", "wave.window=8 mm,120 mm", "--vary", "tool.radius=3 mm,5 mm")
    called = benchmark_cli("sweep", "skin-5N", *SMALL, *vary, "--out", tmp_path / "s", "--json")
    assert called.code == 0
    frame = frame_of(tmp_path / "s").set_index(["wave.window", "tool.radius"])
    refused = frame.loc["8 mm", "5 mm"]
    assert refused.status == "failed"
    assert "--vary wave.window" in refused.reason
    assert (frame.loc["120 mm"].status == "ok").all()
    assert "cannot be computed; the first is point" in called.err.replace("\n", " ").partition("1/4")[0]
    failed = json.loads(called.out)["failed"]
    assert [each["point"] for each in failed] == list(frame.reset_index().query("status == 'failed'").point)
    assert "Points that failed" in (tmp_path / "s/report.html").read_text()
    again = benchmark_cli("sweep", "skin-5N", *SMALL, *vary, "--out", tmp_path / "s")
    assert "4 of 4 points are there already" in again.err


def test_without_a_single_result_it_exits_4(benchmark_cli, tmp_path: Path) -> None:
    soft = [word for name in ("epidermis", "dermis") for word in ("--set", f"{name}.youngs_modulus=5 kPa")]
    vary = (
        *soft,
        "--set",
        "load.peak=50 N",
        "--set",
        "support.kind=half_space",
        "--vary",
        "subcutaneous_fat.youngs_modulus=4 kPa,5 kPa",
    )
    called = benchmark_cli("sweep", "skin-5N", *SMALL[:4], *vary, "--out", tmp_path / "s")
    assert called.code == 4
    assert "no point of the sweep has results" in called.err
    assert (frame_of(tmp_path / "s").status == "failed").all()


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("sample", ["lhs", "sobol"])
def test_samples_take_their_number_of_points(benchmark_cli, tmp_path: Path, sample: str) -> None:
    drawn = ("--sample", sample, "--points", "3", "--seed", "4")
    called = benchmark_cli("sweep", "skin-5N", *SMALL, *VARY, *drawn, "--out", tmp_path / "s", "--quiet")
    assert called.code == 0, called.err
    frame = frame_of(tmp_path / "s")
    assert len(frame) == 3
    assert frame["dermis.youngs_modulus_kPa"].between(100, 400).all()
    assert set(frame["tool.radius"]) <= {"3 mm", "5 mm"}


def test_sensitivity_is_in_table_report_and_json(benchmark_cli, tmp_path: Path) -> None:
    vary = (
        "--vary",
        "subcutaneous_fat.youngs_modulus=40 kPa:60 kPa",
        "--vary",
        "epidermis.density=1000 kg/m^3:1200 kg/m^3",
    )
    linear = ("--set", "fem.kinematics=linear")
    options = ("--sensitivity", "--points", "32", "--json", "--quiet")
    called = benchmark_cli("sweep", "skin-5N", *SMALL, *linear, *vary, *options, "--out", tmp_path / "s")
    assert called.code == 0, called.err
    table = pd.read_csv(tmp_path / "s/sensitivity.csv").set_index(["result", "parameter"])
    total = table.total_order["fem_depth_mm"]
    assert total["epidermis.density"] == pytest.approx(0.0, abs=1e-6), "no inertia in a quasi-static press"
    assert total["subcutaneous_fat.youngs_modulus"] > 0.5
    assert (table[["first_order_ci95", "total_order_ci95"]] >= 0).all().all()
    document = json.loads(called.out)
    assert document["points"] == 32
    assert document["sensitivity"]["base_samples"] == 8
    assert any("fem_force_N" in warning for warning in document["sensitivity"]["warnings"])
    assert "Sobol indices" in (tmp_path / "s/report.html").read_text()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), ["--vary"]),
        (("--vary", "tool.radius"), ["--vary", "KEY=VALUES"]),
        (("--vary", "tool.radius=2 kPa,3 kPa"), ["--vary tool.radius", "2 kPa", "mm"]),
        (("--vary", "tool.radios=2 mm,3 mm"), ["tool.radios", "radius"]),
        (("--vary", "tool.radius=2 mm:3 mm"), ["--sample"]),
        (("--vary", "tool.radius=2 mm,3 mm", "--points", "5"), ["--sample"]),
        (("--vary", "tool.radius=2 mm,3 mm", "--sample", "random"), ["lhs", "sobol"]),
        (("--vary", "tool.radius=2 mm,3 mm", "--workers", "0"), ["--workers"]),
        (("--vary", "tool.radius=2 mm,3 mm", "--workers", "2", "--scheduler", "tcp://a:1"), ["--workers", "cluster"]),
        (("--vary", "load.peak=1 N,2 N"), ["load.peak", "twice"]),
        (("--vary", "tool.radius=2 mm,3 mm", "--scheduler", "nonsense://x"), ["--scheduler", "tcp://"]),
    ],
)
def test_what_it_refuses(benchmark_cli, tmp_path: Path, arguments, words) -> None:
    called = benchmark_cli("sweep", "skin-5N", *SMALL, *arguments, "--out", tmp_path / "s", "--quiet")
    assert called.code == 2, called.err
    assert called.out == ""
    assert "Traceback" not in called.err
    assert all(word in " ".join(called.err.split()) for word in words), called.err
    assert not (tmp_path / "s" / "points.parquet").exists()


@pytest.mark.usefixtures("undrawn")
def test_another_command_on_the_same_folder_is_refused(benchmark_cli, tmp_path: Path) -> None:
    arguments = ("sweep", "skin-5N", *SMALL, "--out", tmp_path / "s", "--quiet", "--vary")
    assert benchmark_cli(*arguments, "tool.radius=3 mm,5 mm").code == 0
    called = benchmark_cli(*arguments, "tool.radius=3 mm,6 mm")
    assert called.code == 2
    assert "vary.tool.radius ('3 mm,5 mm' there, '3 mm,6 mm' here)" in " ".join(called.err.split())
    assert len(frame_of(tmp_path / "s")) == 2


@pytest.mark.slow
def test_after_kill_9_the_same_command_finishes_what_is_missing(benchmark_cli, tmp_path: Path) -> None:
    out = tmp_path / "s"
    vary = ("--vary", "dermis.youngs_modulus=100 kPa:400 kPa:15:log", "--vary", "tool.radius=3 mm,5 mm")
    arguments = ("sweep", "skin-5N", *SMALL, *vary, "--workers", "2", "--out", str(out))
    environment = {**os.environ, "NO_COLOR": "1"}
    for enough in (4, 12):
        process = subprocess.Popen([sys.executable, "-m", "benchmark", *arguments, "--quiet"], env=environment)
        wait_for(lambda enough=enough: rows_in(out) >= enough, process)
        process.send_signal(signal.SIGKILL)
        assert process.wait(10) == -signal.SIGKILL
        kept = frame_of(out)
        assert kept.point.is_unique
        assert (kept.status == "ok").all()
        before = rows_in(out)
    called = benchmark_cli(*arguments)
    assert called.code == 0, called.err
    assert f"{before} of 30 points are there already" in called.err
    frame = frame_of(out)
    assert list(frame.point) == list(range(1, 31))
    again = frame[frame.point.isin(kept.point)].reset_index(drop=True)
    pd.testing.assert_frame_equal(again, kept)
    assert not [path for path in out.iterdir() if path.name.endswith(".part")]


def rows_in(out: Path) -> int:
    journal = out / "journal.jsonl"
    return sum(line.startswith(b"{") and line.endswith(b"}\n") for line in open_lines(journal))


def open_lines(path: Path) -> list[bytes]:
    return path.read_bytes().splitlines(keepends=True) if path.exists() else []


def wait_for(condition, process: subprocess.Popen, seconds: float = 90.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert process.poll() is None, "it ended before it was to be killed"
        assert time.monotonic() < end, "it took too long"
        time.sleep(0.02)


def test_help_loads_nothing_heavy() -> None:
    heavy = ("numpy", "scipy", "pandas", "pyarrow", "distributed", "dask", "SALib")
    code = (
        "import sys; from benchmark.cli.app import main; main(['sweep', '--help']); "
        f"print([name for name in {heavy!r} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
    assert "--scheduler" in done.stdout
