"""Compression and tension as an instrument exports them become a cylinder between plates or grips. All synthetic."""

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.files import load_session
from benchmark.files.sessions.proposal import propose, write_proposal
from benchmark.gate.measuring.jobs import SilentListener
from benchmark.runs.fitted_session import fit_trials
from tests.instruments.samples import cylinder_workbook


@pytest.mark.parametrize(("word", "kind"), [("Druckversuch", "plates"), ("Zugversuch", "grips")])
def test_a_test_of_a_cylinder_is_recognised_and_said(word, kind, tmp_path):
    session = load_session(cylinder_workbook(tmp_path, word))
    assert {trial.support.kind for trial in session.trials} == {kind}
    for trial in session.trials:
        assert trial.support.specimen_radius == trial.tool.radius == pytest.approx(10e-3)
    assert session.specimen.thickness == pytest.approx(12e-3)
    text = " ".join(session.warnings)
    assert "10 mm radius by its cross-section" in text
    assert "tool.contact=rigid_frictionless" in text
    assert "tool's radius is not given" not in text


@pytest.mark.parametrize("key", ["tool.radius", "support.kind"])
def test_what_a_person_says_comes_first(key, tmp_path):
    value = {"tool.radius": "3 mm", "support.kind": "bonded"}[key]
    session = load_session(cylinder_workbook(tmp_path, "Druckversuch"), {key: value})
    assert {trial.support.kind for trial in session.trials} == {"bonded"}


def test_the_key_of_a_layer_that_is_named_like_a_section_is_told(tmp_path):
    with pytest.raises(InputError, match=r"tool is a section here.* --set tissue\.tool\.youngs_modulus"):
        load_session(cylinder_workbook(tmp_path, "Druckversuch"), {"tool.youngs_modulus": "3 kPa"})


def test_a_narrow_plate_and_friction_are_refused(tmp_path):
    file = cylinder_workbook(tmp_path, "Druckversuch")
    told = {"support.kind": "plates", "support.specimen_radius": "10 mm"}
    with pytest.raises(InputError, match="does not cover the specimen"):
        load_session(file, {**told, "tool.radius": "3 mm"})
    with pytest.raises(InputError, match="rigid_bonded or rigid_frictionless"):
        load_session(file, {**told, "tool.contact": "uniform_pressure"})


def test_a_proposal_names_plates(tmp_path):
    text = propose(cylinder_workbook(tmp_path, "Druckversuch").parent).texts["session.toml"]
    assert 'kind = "plates"' in text
    assert 'specimen_radius = "10 mm"' in text
    assert 'radius = "5 mm"' not in text


def test_a_proposal_names_the_plates_of_each_condition(tmp_path):
    """It wrote a tool of 5 mm on a bonded base, by which 30 kPa became 58."""
    for name, diameter in (("narrow", 20), ("wide", 24)):
        (tmp_path / name).mkdir()
        squeezed(tmp_path / name, "a", diameter)
        squeezed(tmp_path / name, "b", diameter)
    before = load_session(tmp_path)
    write_proposal(tmp_path, propose(tmp_path))
    assert "bonded base" not in (tmp_path / "session.toml").read_text()
    after = load_session(tmp_path)
    assert [trial.support for trial in after.trials] == [trial.support for trial in before.trials]
    assert [1e3 * trial.support.specimen_radius for trial in after.trials] == pytest.approx([10.0, 10.0, 12.0, 12.0])


def test_cylinders_of_unlike_width_in_one_condition_are_told_apart_by_folders(tmp_path):
    squeezed(tmp_path, "a", 20)
    squeezed(tmp_path, "b", 24)
    assert any("the files of each width into a sub-folder" in text for text in load_session(tmp_path).warnings)


@pytest.mark.parametrize("word", ["Druckversuch", "Zugversuch"])
def test_the_modulus_that_was_put_in_is_fitted(word, tmp_path):
    told = {"tool.contact": "rigid_frictionless", "specimen.poisson_ratio": "0.4999"}
    found = fit_trials(cylinder_workbook(tmp_path, word), None, told, SilentListener(), films=False)
    assert 20e3 * found.stiffness_factor == pytest.approx(50e3, rel=2e-3)
    assert np.median([trial.residual_percent for trial in found.fit.trials]) < 0.2


@pytest.mark.parametrize("columns", [("Compressive strain (Extension)", "(%)"), ("Compressive extension", "(mm)")])
def test_the_height_that_is_told_is_the_specimens(columns, tmp_path):
    """Strain is the displacement over this height, so that the layer that is fitted must have it."""
    strain = np.interp(np.arange(100), [0, 10, 60, 99], [0.0, 0.0, 0.2, 0.0])
    travel = 100.0 * strain if "%" in columns[1] else 12.0 * strain
    rows = (
        f"{0.1 * k:.1f},{each:.5f},{50.0 * share:.5f}"
        for k, (each, share) in enumerate(zip(travel, strain, strict=True))
    )
    head = [f"Time,{columns[0]},Compressive stress", f"(s),{columns[1]},(kPa)"]
    (tmp_path / "block.csv").write_text("\n".join([*head, *rows]))
    session = load_session(tmp_path / "block.csv", {"import.height": "12 mm", "import.area": "314 mm^2"})
    assert session.specimen.thickness == pytest.approx(12e-3)
    assert session.trials[0].table.depth.max() == pytest.approx(2.4e-3, rel=0.01)
    assert any("12 mm (import.height)" in warning for warning in session.warnings)


def squeezed(folder, name, diameter):
    """A compression test of a cylinder 10 mm high."""
    cylinder(folder, name, 10)
    file = folder / f"{name}.csv"
    text = file.read_text().replace("(mm),20", f"(mm),{diameter}")
    file.write_text(text.replace("Extension (mm),Load (N)", "Compressive extension (mm),Compressive load (N)"))


def cylinder(folder, name, height):
    rows = [f"{0.1 * k:.1f},{0.01 * k * height:.4f},{0.4 * k:.3f}" for k in range(30)]
    head = ["Specimen diameter (mm),20", f"Specimen height (mm),{height}", "Time (s),Extension (mm),Load (N)"]
    (folder / f"{name}.csv").write_text("\n".join([*head, *rows]))


def test_a_specimen_of_another_height_than_its_header_tells_is_told_of(tmp_path):
    for name, height in (("a", 8), ("b", 12)):
        cylinder(tmp_path, name, height)
    alone = {"specimen.thickness": "8.5 mm"}
    one = load_session(tmp_path / "a.csv")
    assert not any("headers tell heights" in each for each in one.warnings)
    assert not any("headers tell heights" in each for each in load_session(tmp_path / "a.csv", alone).warnings)
    other = load_session(tmp_path / "a.csv", {"specimen.thickness": "10 mm"}).warnings
    assert any("assumed one layer of 10 mm (--set specimen.thickness)" in each for each in other)
    assert any("8 mm (a.csv), the specimen is 10 mm thick: state" in each for each in other)
    both = load_session(tmp_path, {"specimen.thickness": "10 mm"}).warnings
    assert any("heights of 8 mm (a.csv), 12 mm (b.csv), the specimen is 10 mm thick" in each for each in both)
