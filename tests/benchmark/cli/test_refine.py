"""`run --refine`: numerical uncertainty and growth, from the tables to the page and back."""

from pathlib import Path

import pandas as pd
import pytest

SMALL = ("--set", "fem.mesh=coarse", "--set", "load.observations=4", "--set", "load.peak=1 N")


@pytest.mark.slow
def test_levels_uncertainties_and_their_page(benchmark_cli, tmp_path: Path) -> None:
    out = tmp_path / "r"
    assert benchmark_cli("run", "skin-5N", *SMALL, "--refine", "--out", out, "--quiet").code == 0
    levels = pd.read_csv(out / "tables/refinement.csv")
    meshes = levels[(levels.model == "fem") & (levels.refined == "mesh") & (levels.layer == "dermis")].set_index(
        "level"
    )
    assert list(meshes.index) == ["fine", "default", "coarse"]
    assert meshes.unknowns.is_monotonic_decreasing
    assert set(levels[levels.refined == "load steps"].load_steps) == {4, 8}
    assert (levels.wall_s > 0.0).all()
    values = pd.read_csv(out / "tables/validation.csv", keep_default_na=False)
    dermis = values[values.quantity == "maximum of dermis"]
    told = {(row.simulation, row.measure): row.value for row in dermis.itertuples()}
    uncertainty = float(told["fem", "mesh: u_num"])
    fine, coarse = meshes.max_mm["fine"], meshes.max_mm["coarse"]
    assert 0.5 * abs(fine - coarse) < uncertainty < 0.05 * fine
    used = pd.read_csv(out / "tables/max_deformation.csv").query("layer == 'dermis'")
    assert float(told["wave", "E"]) == pytest.approx(used.wave_mm.max() - used.fem_mm.max(), rel=1e-9)
    assert told["wave", "not assessed"] == "u_input, u_D"
    parts = (uncertainty, float(told["wave", "modes: u_num"]))
    assert float(told["wave", "u_val"]) == pytest.approx(sum(part**2 for part in parts) ** 0.5, rel=1e-3)
    page = (out / "report.html").read_text()
    for text in ("Growth of compute time", "Errors beside their uncertainties", "code to code"):
        assert text in page
    assert benchmark_cli("report", out).code == 0
    assert (out / "report.html").read_text() == page
