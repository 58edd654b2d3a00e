"""How high the specimen under each trial is, by session, header or gap; and the one that is assumed."""

import numpy as np
import pytest

from bench_hw.tables import TrialTable
from benchmark.errors import InputError
from benchmark.files import load_session
from benchmark.files.sessions.proposal import propose, write_proposal
from benchmark.files.sessions.specimens import SAME_HEIGHT, assumed_specimen

PAD = """schema = 1
name = "pad"
citation = "made up"
[[layers]]
name = "{name}"
thickness = "{thickness}"
density = "1000 kg/m^3"
youngs_modulus = "30 kPa"
poisson_ratio = 0.45
"""


def trial(depth, gap=None):
    depth = np.array(depth, dtype=float)
    extra = {} if gap is None else {"gap": np.array(gap, dtype=float)}
    return TrialTable(np.arange(len(depth), dtype=float), depth, np.zeros(len(depth)), extra)


def test_the_thickness_is_the_median_gap_at_zero_depth():
    trials = [
        trial([-1e-3, 0.0, 1e-3], [9e-3, 8e-3, 7e-3]),
        trial([0.2e-3, 1e-3], [9.8e-3, 9e-3]),
        trial([0.0, 1e-3], [15e-3, 14e-3]),
        trial([0.0, 1e-3]),
    ]
    tissue, warning = assumed_specimen(trials)
    assert tissue.thickness == pytest.approx(10e-3, rel=1e-12)
    assert "10 mm" in warning
    assert "trials: 3, 8 to 15 mm" in warning


@pytest.mark.parametrize("gap", [None, [0.0, -1e-3], [-5e-3, -6e-3]])
def test_without_a_usable_gap_it_is_ten_millimetres(gap):
    tissue, warning = assumed_specimen([trial([0.0, 1e-3], gap)])
    assert tissue.thickness == 10e-3
    assert "no trial has a usable gap_mm" in warning


def test_everything_assumed_is_said():
    tissue, warning = assumed_specimen([trial([0.0])])
    (layer,) = tissue.layers
    assert layer.youngs_modulus == 20e3
    assert f"{layer.poisson_ratio:g}" in warning
    assert "1000 kg/m^3" in warning
    assert "20 kPa before any fit" in warning
    assert "assumed" in tissue.citation


def test_heights_that_the_trials_tell_come_before_the_gaps():
    tissue, warning = assumed_specimen([trial([0.0, 1e-3], [8e-3, 7e-3])], [12e-3, 16e-3, 20e-3], "as told")
    assert tissue.thickness == pytest.approx(16e-3)
    assert "as told, trials: 3, 12 to 20 mm" in warning


def cylinder(folder, name, height):
    rows = [f"{0.1 * k:.1f},{0.01 * k * height:.4f},{0.4 * k:.3f}" for k in range(30)]
    head = ["Specimen diameter (mm),20", f"Specimen height (mm),{height}", "Time (s),Extension (mm),Load (N)"]
    (folder / f"{name}.csv").write_text("\n".join([*head, *rows]))


@pytest.fixture
def folder(tmp_path):
    """Four cylinders: 8, 12, 12.1 and 16 mm high by their headers."""
    for name, height in (("a", 8), ("b", 12), ("c", 12.1), ("d", 16)):
        cylinder(tmp_path, name, height)
    return tmp_path


def heights(session):
    return [None if one.height is None else round(1e3 * one.height, 6) for one in session.trials]


def test_each_trial_has_the_height_of_its_header(folder):
    """Their median stood for all: one silicone in cylinders of 8, 12 and 16 mm had 42 to 95 kPa."""
    session = load_session(folder)
    assert heights(session) == [8.0, 12.05, 12.05, 16.0]
    assert [round(1e3 * setup[0].thickness, 6) for setup in session.setups] == [8.0, 12.05, 16.0]
    assert session.specimen.thickness == pytest.approx(12.05e-3)
    assert "specimens of 8, 12.05, 16 mm height: each trial counts with its own" in session.warnings
    parts = session.by_height()
    assert [part.name for part in parts] == [f"{session.name}, {each} mm" for each in ("8", "12.05", "16")]
    assert [len(part.trials) for part in parts] == [1, 2, 1]
    assert [part.specimen for part in parts] == [setup[0] for setup in session.setups]


def test_one_height_is_the_sessions(tmp_path):
    for name, height in (("a", 12), ("b", 12 * (2.0 * SAME_HEIGHT - 1.0) ** 0.5)):
        cylinder(tmp_path, name, height)
    session = load_session(tmp_path)
    assert heights(session) == [None, None]
    assert session.by_height() == [session]
    assert not any("height" in each and "counts with its own" in each for each in session.warnings)


@pytest.mark.parametrize("told", [{"import.height": "12 mm"}, {"specimen.thickness": "12 mm"}])
def test_a_height_that_is_told_of_all_is_that_of_all(folder, told):
    session = load_session(folder, told)
    assert heights(session) == [None] * 4
    assert session.specimen.thickness == pytest.approx(12e-3)


def test_a_half_space_has_no_height(folder):
    session = load_session(folder, {"support.kind": "half_space", "tool.radius": "5 mm"})
    assert heights(session) == [None] * 4


def test_the_proposed_session_keeps_the_heights(folder):
    before = load_session(folder)
    write_proposal(folder, propose(folder))
    assert 'height = "16 mm"' in (folder / "session.toml").read_text()
    after = load_session(folder)
    assert heights(after) == heights(before)
    edited = (folder / "session.toml").read_text().replace('height = "16 mm"', 'height = "17 mm"')
    (folder / "session.toml").write_text(edited)
    assert heights(load_session(folder))[-1] == 17.0
    (folder / "session.toml").write_text(edited.replace('height = "17 mm"', 'height = "17 N"'))
    with pytest.raises(InputError, match=r"trials\[3\]\.height|height"):
        load_session(folder)


def listed(folder, specimen, own=""):
    (folder / "pad.toml").write_text(specimen)
    lines = [
        "schema = 1",
        'name = "pads"',
        'specimen = "pad.toml"',
        "[support]",
        'kind = "plates"',
        'specimen_radius = "10 mm"',
    ]
    for name in "abcd":
        lines += ["[[trials]]", f'file = "{name}.csv"', 'condition = "slow"', own if name == "d" else ""]
    (folder / "session.toml").write_text("\n".join(lines))
    return load_session(folder)


def test_headers_count_for_a_stated_specimen_of_one_layer(folder):
    session = listed(folder, PAD.format(name="gel", thickness="12 mm"))
    assert heights(session) == [8.0, 12.05, 12.05, 16.0]
    assert {setup[0].layers[0].youngs_modulus for setup in session.setups} == {30e3}


def test_of_several_layers_only_the_session_says_how_high_they_are(folder):
    one, other = PAD.format(name="top", thickness="2 mm"), PAD.format(name="base", thickness="10 mm")
    two = one + other[other.index("[[layers]]") :]
    session = listed(folder, two)
    assert heights(session) == [None] * 4
    assert any('give each trial its own, height = "..." in [[trials]]' in each for each in session.warnings)
    session = listed(folder, two, 'height = "18 mm"')
    assert heights(session) == [None, None, None, 18.0]
    assert [round(1e3 * one.thickness, 6) for one in session.setups[-1][0].layers] == [3.0, 15.0]
    said = "specimens of 18 mm height: each trial counts with its own; 3 without a height of their own count with 12 mm"
    assert said in session.warnings


def test_the_gap_is_a_height_where_nobody_says_what_was_pressed(tmp_path):
    depth = np.linspace(-0.2, 2.0, 60)
    for name, height in (("a", 10.0), ("b", 10.1), ("c", 15.0)):
        columns = np.column_stack([np.arange(60) / 10, depth, np.maximum(depth, 0.0), height - depth])
        np.savetxt(
            tmp_path / f"{name}.csv", columns, delimiter=",", header="time_s,depth_mm,force_N,gap_mm", comments=""
        )
    made = load_session(tmp_path)
    assert heights(made) == pytest.approx([10.05, 10.05, 15.0], rel=2e-3)
    for stated in ("skin_forearm", "ecoflex_00_30"):  # of three layers, and of one
        assert heights(load_session(tmp_path, specimen=stated)) == [None] * 3
