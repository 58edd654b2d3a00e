"""Derivatives of a press by its set-up."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from benchmark.errors import InputError
from benchmark.files import load_session
from benchmark.response.differentiated_ramp import differentiated_ramp

HOLE = '[support]\nkind = "hole"\nhole_radius = "30 mm"\n'


@pytest.fixture
def sheet(tmp_path, quick_session):
    """A session over a hole."""
    folder = quick_session.write_session(tmp_path / "sheet", trials=3)
    file = folder / "session.toml"
    file.write_text(file.read_text().replace('[support]\nkind = "bonded"\n', HOLE))
    (folder / "layer.toml").write_text((folder / "layer.toml").read_text().replace("12 mm", "5 mm"))
    return load_session(folder)


def test_the_force_goes_with_the_stiffness_and_the_face_does_not(sheet) -> None:
    trial, layer = sheet.trials[0], sheet.specimen.layer_names[0]
    key = f"{layer}.stiffness"
    ramp = differentiated_ramp(sheet, sheet.specimen, trial.tool, trial.support, 2e-3, [key], steps=6)
    assert ramp.face is not None
    assert ramp.by[key].force == pytest.approx(ramp.force, rel=1e-6)
    assert ramp.by[key].outward == pytest.approx(0.0, abs=1e-9)
    assert ramp.by[key].sunk.shape == ramp.face.sunk.shape == (7, ramp.face.radius.size)


def test_what_the_elements_leave_at_the_tools_edge_grows_with_the_depth(sheet) -> None:
    trial = sheet.trials[0]
    key = f"{sheet.specimen.layer_names[0]}.stiffness"
    setup = (sheet.specimen, trial.tool, trial.support, 1e-3)
    ramp = differentiated_ramp(sheet, *setup, [key], steps=4, judge_mesh=True)
    assert ramp.at_edge[0] == 0.0
    assert ramp.at_edge[1:] == pytest.approx(ramp.at_edge[-1] * (ramp.depth[1:] / 1e-3) ** 2, rel=0.2)
    assert 1e-4 < ramp.at_edge[-1] < ramp.mesh_error < 0.01


def test_a_stated_pretension_stiffens_and_what_is_not_there_is_refused(sheet) -> None:
    trial = sheet.trials[0]
    tight = replace(sheet, settings={**sheet.settings, "physics.pretension": "5 kPa"})
    setup = (tight.specimen, trial.tool, trial.support, 1e-3)
    ramp = differentiated_ramp(tight, *setup, ["physics.pretension"], steps=3)
    assert (ramp.by["physics.pretension"].force[1:] > 0.0).all()
    for key in ("nowhere.thickness", "physics.friction_coefficient"):
        with pytest.raises(InputError, match=re.escape(key)):
            differentiated_ramp(tight, *setup, [key], steps=3)
