"""`benchmark run --trials` and `benchmark fit` on the shipped phantom session and on measured tissue."""

import json
import os
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from benchmark.files import load_scenario
from benchmark.runs.trials.measured import peak_weights
from benchmark.sessions import SHIPPED
from benchmark.sessions.phantom_sheet import TRUE_FACTOR

PHANTOM = SHIPPED / "phantom"
COARSE = ("--set", "fem.mesh=coarse")


@pytest.mark.slow
def test_the_phantom_fit_finds_the_hidden_stiffness(benchmark_cli, tmp_path: Path) -> None:
    called = benchmark_cli("fit", PHANTOM, "--out", tmp_path / "fit", "--json", "--quiet")
    assert called.code == 0
    parameters = pd.read_csv(tmp_path / "fit/fitted_parameters.csv").set_index("name")
    assert list(parameters.columns) == ["value", "unit", "ci95_low", "ci95_high", "identifiable", "source"]
    factor = parameters.loc["stiffness_factor"]
    assert factor.ci95_low <= TRUE_FACTOR <= factor.ci95_high
    assert factor.value == pytest.approx(TRUE_FACTOR, rel=0.05)
    assert bool(parameters.loc["silicone.youngs_modulus"].identifiable)
    assert not bool(parameters.loc["silicone.thickness"].identifiable)
    document = json.loads(called.out)
    assert document["session"]["synthetic"] is True
    assert document["sheet"]["stiffness_factor"]["trials"] == 13
    assert {"published.a", "sound.a", "relaxation.g_1", "thickness_factor"} <= set(parameters.index)
    assert "Synthetic data" in (tmp_path / "fit/report.html").read_text()


def test_a_session_run_compares_measured_with_both_models(benchmark_cli, tmp_path: Path) -> None:
    called = benchmark_cli("run", "--trials", PHANTOM, *COARSE, "--out", tmp_path / "r", "--quiet")
    assert called.code == 0
    measured = pd.read_csv(tmp_path / "r/tables/measured.csv")
    assert list(measured) == [
        "trial", "condition", "time_s", "depth_mm", "force_N", "fem_force_N", "wave_force_N",
    ]  # fmt: skip
    assert measured.trial.nunique() == 13
    residual = measured.force_N - measured.fem_force_N
    assert np.sqrt((residual**2).mean()) < 0.03 * measured.force_N.max()
    of_wave = (measured.force_N - measured.wave_force_N)[measured.condition == "rich"]
    assert np.sqrt((of_wave**2).mean()) < 0.025 * measured.force_N[measured.condition == "rich"].max()
    page = (tmp_path / "r/report.html").read_text()
    assert "cannot follow" not in page
    assert {path.name for path in (tmp_path / "r/markers").iterdir()} == {
        "markers.json", "still_0.png", "still_1.png", "motion_0.csv", "motion_1.csv",
    }  # fmt: skip
    assert "Synthetic data" in page
    assert "Circular comparison" in page
    assert "Tracked markers" in page
    assert "data:image/png" in page
    held_out = pd.read_csv(tmp_path / "r/tables/held_out.csv")
    assert held_out.force_rms_percent.max() < 5.0
    assert held_out.marker_rms_mm.max() < 0.05
    fits = pd.read_csv(tmp_path / "r/tables/marker_fits.csv")
    assert list(fits) == ["trial", "marker", "axis", "a", "b", "c", "r2"]
    assert len(fits) == 13 * 18 * 2
    circle = pd.read_csv(tmp_path / "r/tables/circle.csv")
    assert list(circle) == ["trial", "time_s", "radius_nine_mm", "radius_ring_mm", "x_mm", "y_mm"]
    assert circle.trial.nunique() == 13
    document = json.loads((tmp_path / "r/results.json").read_text())
    peaks = measured.groupby("trial").force_N.max()
    deformation = pd.read_csv(tmp_path / "r/tables/max_deformation.csv")
    assert deformation.force_N.max() == pytest.approx(peaks.median(), rel=0.02)
    assert document["trials"]["count"] == 13
    assert document["verdict"]["status"] == "good"
    assert document["verdict"]["headline"].partition("'")[0] in page
    assert (document["protocol"], document["trials"]["protocol"]) == ("prediction", "circular")
    check_validation(tmp_path / "r/tables/validation.csv", measured)
    fitted = pd.read_csv(tmp_path / "r/tables/fitted_parameters.csv").set_index("name").value
    (term,) = load_scenario(tmp_path / "r/scenario.toml").tissue.layers[0].relaxation
    assert (term.g, term.tau) == pytest.approx((fitted["relaxation.g_1"], fitted["relaxation.tau_1"]))
    assert benchmark_cli("report", tmp_path / "r", "--out", tmp_path / "again").code == 0
    again = (tmp_path / "again/report.html").read_text()
    for text in ("Synthetic data", "Circular comparison", document["trials"]["headline"][1:], "Fitted parameters"):
        assert text in again
    assert again.count("<figure") == page.count("<figure")


def check_validation(path: Path, measured: pd.DataFrame) -> None:
    """E, u_D and the area metric of the peak forces, against the table of every row."""
    trials = [rows for _, rows in measured.groupby("trial")]
    rules = [peak_weights(rows.time_s.to_numpy(), rows.force_N.to_numpy()) for rows in trials]
    forces = [rule @ rows[["force_N", "fem_force_N"]] for rule, rows in zip(rules, trials, strict=True)]
    peaks = pd.DataFrame(forces).assign(condition=[rows.condition.iloc[0] for rows in trials])
    largest = measured.groupby("trial").force_N.max().to_numpy()
    assert peaks.force_N.to_numpy() == pytest.approx(largest, rel=0.02)
    told = pd.read_csv(path, keep_default_na=False)
    circular = told[(told.simulation == "fem") & told.protocol.str.contains("circular")].set_index("measure").value
    residual = peaks.fem_force_N - peaks.force_N
    assert float(circular["E"]) == pytest.approx(residual.mean(), rel=1e-9)
    conditions = peaks.condition
    left = residual - residual.groupby(conditions).transform("mean")  # what conditions differ by is no scatter
    scatter = np.sqrt((left**2).sum() / (13 - conditions.nunique()) / 13)
    assert float(circular["u_D"]) == pytest.approx(scatter, rel=1e-9)
    area = np.abs(np.sort(peaks.fem_force_N) - np.sort(peaks.force_N)).mean()
    assert float(circular["area"]) == pytest.approx(area, rel=1e-9)
    assert circular["not assessed"] == "u_num"
    held_out = told[told.protocol.str.contains("prediction")].set_index("measure").value
    assert abs(float(held_out["E"])) < 0.05 * peaks.force_N.mean()


def test_several_layers_are_not_told_apart(benchmark_cli, tmp_path: Path) -> None:
    session = tmp_path / "mine"
    session.mkdir()
    for source in sorted(PHANTOM.glob("press_0[2-4].csv")):
        shutil.copy(source, session)
    called = benchmark_cli("fit", session, "--specimen", "skin_forearm", *COARSE, "--out", tmp_path / "fit", "--quiet")
    assert called.code == 0
    parameters = pd.read_csv(tmp_path / "fit/fitted_parameters.csv").set_index("name")
    assert bool(parameters.loc["stiffness_factor"].identifiable)
    moduli = parameters[parameters.index.str.endswith("youngs_modulus")]
    assert len(moduli) == 3
    assert not moduli.identifiable.any()
    assert moduli[["ci95_low", "ci95_high"]].isna().all(axis=None)
    assert moduli.source.str.contains("one stiffness, not several").all()


def test_what_a_bare_folder_leaves_open_is_assumed_and_said(benchmark_cli, tmp_path: Path) -> None:
    session = tmp_path / "mine"
    session.mkdir()
    for source in sorted(PHANTOM.glob("press_0[2-4].csv")):
        shutil.copy(source, session)
    called = benchmark_cli("fit", session, *COARSE, "--out", tmp_path / "fit", "--json", "--quiet")
    assert called.code == 0
    said = " ".join(json.loads(called.out)["warnings"])
    for word in ("radius", "5 mm", "rigid_bonded", "bonded", "10 mm"):
        assert word in said


@pytest.mark.slow
@pytest.mark.parametrize("day", ["2023-03-27", "2023-03-31", "2023-04-03"])
def test_measured_tissue_by_others(benchmark_cli, tmp_path: Path, day: str) -> None:
    data = os.environ.get("TISSUEBENCH_DATA")
    if not data:
        pytest.skip("TISSUEBENCH_DATA is not set: measured data by others is not there")
    folder = Path(data) / "pig_indentation" / day
    called = benchmark_cli("run", "--trials", folder, "--out", tmp_path / "r", "--quiet")
    assert called.code == 0, called.err
    measured = pd.read_csv(tmp_path / "r/tables/measured.csv")
    assert measured.trial.nunique() == len(list(folder.glob("*.csv")))
    assert measured.wave_force_N.notna().all()
    document = json.loads((tmp_path / "r/results.json").read_text())
    assert measured.fem_force_N.notna().all()
    assert any("time dependence is in the data" in warning for warning in document["warnings"])
