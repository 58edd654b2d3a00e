"""`benchmark run` from the command line to the files it leaves."""

import json
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

COARSE = ("--set", "fem.mesh=coarse", "--set", "load.observations=20")


@pytest.mark.usefixtures("as_told")
def test_a_run_leaves_every_file_of_the_contract(benchmark_cli, tmp_path: Path) -> None:
    out = tmp_path / "result"
    called = benchmark_cli("run", "skin-5N", *COARSE, "--out", out, "--json", "--quiet")
    assert called.code == 0
    assert called.err == ""
    document = json.loads(called.out)
    assert document.pop("out") == str(out)
    assert document == json.loads((out / "results.json").read_text())
    names = {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()}
    assert names == {
        "manifest.json", "results.json", "report.html", "scenario.toml", "environment.json", "fields/step_0010.vtu",
        "fields/step_0020.vtu", "tables/max_deformation.csv", "tables/profile.csv", "tables/statistics.csv",
        "tables/normal_fits.csv", "tables/timing.csv", "pictures/pressed.txt", "tables/force_depth.csv",
        "tables/mesh_error.csv",
    }  # fmt: skip
    check_tables(out, document)
    judged, told = document["models"]["fem"]["mesh_error"], pd.read_csv(out / "tables/mesh_error.csv")
    assert told.to_dict("records") == [judged]
    assert (judged["quantity"], 0.0 < abs(judged["error_percent"]) < 2.0) == ("depth", True)
    assert f"{abs(judged['error_percent']):.2g} % too" in document["models"]["fem"]["notes"]["discretisation error"]
    assert "in the limit of refinement" in (out / "report.html").read_text()


def check_tables(out: Path, document: dict) -> None:
    layers = ["epidermis", "dermis", "subcutaneous_fat"]
    deformation = pd.read_csv(out / "tables/max_deformation.csv")
    assert list(deformation) == ["step", "time_s", "force_N", "layer", "fem_mm", "wave_mm", "percent_error"]
    assert list(deformation.layer) == layers * 20
    np.testing.assert_allclose(deformation.force_N[::3], [*np.arange(0.5, 5.1, 0.5), *np.arange(4.5, -0.1, -0.5)])
    loaded = deformation[deformation.force_N > 0]
    np.testing.assert_allclose(loaded.percent_error, 100 * (loaded.wave_mm - loaded.fem_mm) / loaded.fem_mm)
    assert deformation[deformation.force_N == 0].percent_error.isna().all()
    for layer, rows in deformation.groupby("layer"):
        assert rows.fem_mm.max() == document["models"]["fem"]["max_deformation_mm"][layer]
        worst = np.abs(rows.percent_error).max()
        assert document["comparison"][layer]["percent_error_max"] == pytest.approx(worst)
    profile = pd.read_csv(out / "tables/profile.csv")
    for layer, rows in profile.groupby("layer"):
        assert rows.r_mm.iloc[0] == 0.0
        assert rows.r_mm.max() >= 20.0
        assert (rows.r_mm <= 10.0).sum() >= 8
        peak = deformation[deformation.layer == layer].fem_mm.max()
        assert rows.fem_mm.iloc[0] == pytest.approx(peak, rel=1e-9)
    timing = pd.read_csv(out / "tables/timing.csv")
    assert list(timing) == ["model", "repeat", "setup_s", "wall_s", "cpu_s", "peak_memory_mb"]
    for model, rows in timing.groupby("model"):
        np.testing.assert_allclose(rows.peak_memory_mb, document["models"][model]["peak_memory_MB"])
    assert timing.groupby("model").size().to_dict() == {"fem": 3, "wave": 3}
    assert document["speedup"]["ci95"][0] <= document["speedup"]["median"] <= document["speedup"]["ci95"][1]
    assert document["speedup"]["interval"] == "range"  # of three pairs, which holds the median in three of four cases
    assert document["speedup"]["coverage"] == 0.75


@pytest.mark.slow
def test_the_resolved_scenario_runs_again_to_the_same_result(benchmark_cli, tmp_path: Path) -> None:
    first, second = tmp_path / "a", tmp_path / "b"
    assert benchmark_cli("run", "skin-5N", *COARSE, "--out", first, "--quiet").code == 0
    assert benchmark_cli("run", first / "scenario.toml", "--out", second, "--quiet").code == 0
    tables = [pd.read_csv(folder / "tables/max_deformation.csv") for folder in (first, second)]
    pd.testing.assert_frame_equal(*tables, rtol=1e-9)


@pytest.mark.usefixtures("undrawn")
def test_linear_limit_wave_against_fem_without_calibration(benchmark_cli, tmp_path: Path) -> None:
    settings = ("--set", "load.peak=0.01 N", "--set", "fem.kinematics=linear")
    called = benchmark_cli("run", "skin-5N", *settings, "--out", tmp_path / "r", "--quiet")
    assert called.code == 0
    deformation = pd.read_csv(tmp_path / "r/tables/max_deformation.csv")
    assert np.abs(deformation.percent_error).max() <= 1.0
    profile = pd.read_csv(tmp_path / "r/tables/profile.csv")
    for _, rows in profile.groupby("layer"):
        assert rows.wave_mm.notna().all()
        assert np.abs(rows.wave_mm - rows.fem_mm).max() <= 0.02 * rows.fem_mm.max()


@pytest.mark.usefixtures("undrawn")
def test_table_2_of_the_article_from_the_paper_scenario(benchmark_cli, tmp_path: Path) -> None:
    assert benchmark_cli("run", "paper", "--out", tmp_path / "r", "--quiet").code == 0
    statistics = pd.read_csv(tmp_path / "r/tables/statistics.csv")
    top = statistics[(statistics.layer == statistics.layer.iloc[0]) & (statistics.test == "t_pooled")]
    rows = top.set_index("quantity")
    assert round(rows.fem["mean"], 4) == 0.0551
    assert round(rows.fem["variance"], 5) == 0.00102
    assert rows.fem["observations"] == 100
    critical = rows.loc[[name for name in rows.index if "critical" in name], "value"].iloc[0]
    assert round(critical, 6) == 1.972017
    document = json.loads((tmp_path / "r/results.json").read_text())
    top_layer = statistics.layer.iloc[0]
    assert document["models"]["fem"]["max_deformation_mm"][top_layer] == pytest.approx(0.11016, abs=5e-6)


def test_a_solver_that_stops_early_exits_4_and_keeps_what_it_has(benchmark_cli, tmp_path: Path) -> None:
    layers = ("epidermis", "dermis", "subcutaneous_fat")
    soft = [text for layer in layers for text in ("--set", f"{layer}.youngs_modulus=10 kPa")]
    out = tmp_path / "r"
    linear = ("--set", "wave.large_press=linear")
    called = benchmark_cli("run", "skin-5N", *soft, *COARSE, *linear, "--out", out)
    assert called.code == 4
    assert "step" in called.err
    assert "N could not be reached" in called.err
    document = json.loads((out / "results.json").read_text())
    last = document["models"]["fem"]["last_state"]
    assert f"that state is {last['depth_mm']:.4g} mm deep, see" in " ".join(called.err.split())
    assert (out / last["fields"]).is_file()
    assert last["depth_mm"] == pytest.approx(last["deflection_mm"]["epidermis"])
    assert "times Young's modulus of the softest layer" in called.err
    assert document["complete"] is False
    assert document["models"]["fem"]["failure"]
    assert "Incomplete" in (out / "report.html").read_text()
    deformation = pd.read_csv(out / "tables/max_deformation.csv")
    assert deformation.fem_mm.notna().any()
    assert deformation.fem_mm.isna().any()


def test_html_in_a_name_shows_as_text(benchmark_cli, tmp_path: Path) -> None:
    name = "<script>alert(1)</script><b>soft</b>"
    settings = (*COARSE, "--set", f"tissue.name={name}")
    called = benchmark_cli("run", "skin-5N", *settings, "--out", tmp_path / "r", "--quiet")
    assert called.code == 0
    page = (tmp_path / "r/report.html").read_text()
    assert name not in page
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in page


@pytest.mark.usefixtures("undrawn")
def test_a_wave_on_a_half_space_leaves_its_columns_empty(benchmark_cli, tmp_path: Path) -> None:
    settings = ("--set", "support.kind=half_space", "--set", "load.peak=0.1 N")
    called = benchmark_cli("run", "skin-5N", *COARSE, *settings, "--out", tmp_path / "r")
    assert called.code == 0
    assert "wave model does not cover" in called.err
    deformation = pd.read_csv(tmp_path / "r/tables/max_deformation.csv")
    assert deformation.wave_mm.isna().all()
    assert deformation.fem_mm.notna().all()
    document = json.loads((tmp_path / "r/results.json").read_text())
    assert document["speedup"]["median"] is None
    assert document["complete"] is True
    assert not any(isinstance(v, float) and math.isnan(v) for v in document["comparison"].values())


def test_session_and_scenario_exclude_each_other(benchmark_cli, tmp_path: Path) -> None:
    called = benchmark_cli("run", "skin-5N", "--trials", tmp_path)
    assert called.code == 2
    assert "exclude each other" in called.err
