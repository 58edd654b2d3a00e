import pandas as pd
import pytest

from benchmark.discovery.from_run import is_run, read_run
from benchmark.errors import InputError


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
