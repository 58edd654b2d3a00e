"""The wave that a repair begins with."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from benchmark.discovery.from_run import at_small_strain, is_run, read_run
from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.models.model_result import STRAINS


def test_a_run_is_read_in_si(make_run) -> None:
    folder = make_run()
    assert is_run(folder)
    run = read_run(folder)
    assert run.layers == ("epidermis", "dermis", "subcutaneous_fat")
    assert run.reference.shape == run.wave.shape == (100, 3)
    assert run.force.max() == 5.0
    assert run.wave[49, 0] == pytest.approx(5e-3)


def test_a_session_is_no_run(tmp_path) -> None:
    assert not is_run(tmp_path)


def test_a_wave_without_values_is_refused(make_run) -> None:
    folder = make_run()
    table = pd.read_csv(folder / "tables/max_deformation.csv")
    table["wave_mm"] = None
    table.to_csv(folder / "tables/max_deformation.csv", index=False)
    with pytest.raises(InputError, match="wave_mm is not filled"):
        read_run(folder)


def test_a_missing_table_is_said(make_run) -> None:
    folder = make_run()
    (folder / "tables/max_deformation.csv").unlink()
    with pytest.raises(InputError, match="max_deformation"):
        read_run(folder)


def test_a_run_under_depth_control_is_refused(make_run) -> None:
    folder = make_run()
    text = (folder / "scenario.toml").read_text()
    (folder / "scenario.toml").write_text(text.replace('"force"', '"depth"').replace('"5 N"', '"2 mm"'))
    with pytest.raises(InputError, match="controlled by depth"):
        read_run(folder)


def _told(folder: Path, strain: str, **more: object) -> Path:
    notes = {"model": f"layered vector wave, {STRAINS[strain]}, no calibration"}
    (folder / "results.json").write_text(json.dumps({"models": {"wave": {"notes": notes}}, **more}))
    return folder


def test_finite_strain_taken_by_itself_is_taken_back(make_run) -> None:
    run = read_run(_told(make_run(), "corrected"))
    assert run.large_press == "corrected"
    small = at_small_strain(run)
    assert (small.large_press, small.restarted) == ("linear", True)
    pressed = small.force > 0.01
    per_newton = small.wave[pressed] / small.force[pressed][:, None]
    np.testing.assert_allclose(per_newton, np.tile(per_newton[0], (pressed.sum(), 1)), rtol=1e-9)
    assert (per_newton[0] > 5e-4).all()


def test_a_wave_under_friction_which_small_strain_does_not_cover_stays(make_run) -> None:
    rough = {"tool.contact": "rigid_frictional", "physics.friction_coefficient": "0.3", "tool.edge_radius": "1 mm"}
    run = replace(read_run(_told(make_run(), "corrected")), scenario=load_scenario("skin-5N", rough))
    assert at_small_strain(run) is run


def test_a_wave_in_small_strain_or_with_effects_stays(make_run) -> None:
    linear = read_run(_told(make_run(name="a"), "linear"))
    assert at_small_strain(linear) is linear
    repaired = read_run(_told(make_run(name="b"), "corrected", effects=["strain_stiffening"]))
    assert at_small_strain(repaired) is repaired
