"""Session folders of blind cases: readable, labelled, the same from the same seed, and they give nothing away."""

from pathlib import Path

import numpy as np
import pytest

from benchmark.blind.cases import CaseName
from benchmark.blind.session_files import case
from benchmark.files.sessions.session_loading import load_session


@pytest.fixture(scope="module")
def sheet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return case(CaseName("null", "", 0, 0.0), tmp_path_factory.mktemp("blind"))[0]


def test_a_null_session_is_read_without_a_warning(sheet: Path) -> None:
    session = load_session(sheet)
    assert session.synthetic
    assert session.warnings == ()
    assert session.conditions == ("slow", "fast")
    assert len(session.trials) == 10
    assert session.camera is not None
    markers = session.trials[0].markers
    assert markers is not None
    assert set(markers.marker) == set(range(18))


def test_the_resting_grid_is_the_nominal_one(sheet: Path) -> None:
    markers = load_session(sheet).trials[0].markers
    assert markers is not None
    rest = [np.mean(markers.x[(markers.marker == number) & (markers.time < 0.8)]) for number in (0, 5, 17)]
    assert rest == pytest.approx([-15e-3, 15e-3, 15e-3], abs=0.03e-3)


def test_print_scatter_moves_the_markers_and_nothing_else(sheet: Path, tmp_path: Path) -> None:
    name = CaseName("null", "", 0, 0.0, print_scatter=0.06e-3)
    assert name.text == f"{name.truth}:print0.06mm" == "null:-:0:D0:print0.06mm"
    exact, printed = load_session(sheet), load_session(case(name, tmp_path)[0])
    assert exact.name != printed.name
    off = []
    for one, other in zip(exact.trials, printed.trials, strict=True):
        assert one.table.force == pytest.approx(other.table.force, abs=0.0)
        assert one.markers is not None
        assert other.markers is not None
        still = one.markers.time < 0.8
        moved = [other.markers.x - one.markers.x, other.markers.y - one.markers.y]
        off.append([[each[still & (one.markers.marker == k)].mean() for k in range(18)] for each in moved])
    assert np.std(off[0]) == pytest.approx(0.06e-3, rel=0.4)
    assert np.ptp(off, axis=0).max() < 2e-8


def test_a_force_only_session(tmp_path: Path) -> None:
    folder, made = case(CaseName("effect", "dry_friction", 3), tmp_path)
    session = load_session(folder)
    assert session.camera is None
    assert [layer.name for layer in session.specimen.layers] == ["epidermis", "dermis", "fat"]
    assert "friction" not in "".join(path.read_text() + path.name for path in folder.glob("*.toml"))
    assert made.name.alias == folder.name


def test_the_same_name_gives_the_same_files(sheet: Path, tmp_path: Path) -> None:
    again, _ = case(CaseName("null", "", 0, 0.0), tmp_path)
    assert load_session(again).fingerprint == load_session(sheet).fingerprint


def test_a_session_with_wrong_layers_has_the_same_trials_and_tells_other_layers(sheet: Path, tmp_path: Path) -> None:
    folder, made = case(CaseName("null", "", 0, 0.0, wrong_layers=True), tmp_path)
    assert made.name.text == "null:-:0:D0:wrong-layers"
    for trial in ("trial_001.csv", "markers_001.csv"):
        assert (folder / trial).read_bytes() == (sheet / trial).read_bytes()
    true, told = (load_session(each).specimen.layers[0] for each in (sheet, folder))
    assert 0.0 < abs(np.log(told.youngs_modulus / true.youngs_modulus)) < 1.0
    assert 0.0 < abs(told.thickness / true.thickness - 1.0) < 0.2
    assert told.poisson_ratio == true.poisson_ratio
    assert told.own_uncertainties == {"thickness": pytest.approx(0.04), "youngs_modulus": pytest.approx(0.25)}
    assert true.own_uncertainties == {}
