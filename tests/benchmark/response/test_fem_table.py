"""The finite elements as a base: what they cover, and what is put in their place where they stop."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.files import load_session
from benchmark.response import fem_table as module
from benchmark.response.elastic_table import ElasticTable, SetupDerivative
from benchmark.response.fem_table import _with_force, fem_or_wave_table, fem_table
from benchmark.response.setup_change import HOLE_RADIUS, PRETENSION, RADIUS, changed_setup
from benchmark.response.wave_table import STEP

HOLE = '[support]\nkind = "hole"\nhole_radius = "30 mm"\n'


@pytest.fixture
def sheet(tmp_path, quick_session):
    """A session over a hole."""
    folder = quick_session.write_session(tmp_path / "sheet", trials=3)
    file = folder / "session.toml"
    file.write_text(file.read_text().replace('[support]\nkind = "bonded"\n', HOLE))
    (folder / "layer.toml").write_text((folder / "layer.toml").read_text().replace("12 mm", "5 mm"))
    return load_session(folder)


def test_the_force_is_the_other_one_and_goes_on_like_the_wave() -> None:
    depth = np.linspace(0.0, 4e-3, 200)
    by_radius = np.stack([100.0 * depth, 0.0 * depth])
    wave = ElasticTable(depth, 1000.0 * depth, np.array([0.0, 1.0]), by={RADIUS: SetupDerivative(by_radius)})
    ramp = np.linspace(0.0, 3e-3, 25)
    law = _with_force(wave, ramp, 1000.0 * ramp + 2e5 * ramp**2)
    inside = (depth > 1e-4) & (depth <= 3e-3)
    assert law.force[inside] == pytest.approx(1000.0 * depth[inside] + 2e5 * depth[inside] ** 2, rel=1e-3)
    assert law.force[-1] == pytest.approx(1.6 * wave.force[-1], rel=1e-2)
    assert law.by[RADIUS].force[0, -1] == pytest.approx(1.6 * by_radius[0, -1], rel=1e-2)
    assert law.force[0] == 0.0


def test_a_table_of_may_go_to_another_process(sheet) -> None:
    there = pickle.loads(pickle.dumps(fem_or_wave_table(sheet, ())))
    setup = (sheet.specimen, sheet.tool, sheet.support, 1e-3)
    assert there(*setup).force == pytest.approx(fem_or_wave_table(sheet, ())(*setup).force, rel=1e-12)


def test_a_wider_tool_is_foretold_by_the_orders(sheet) -> None:
    trial = sheet.trials[0]
    law = fem_table(sheet)(sheet.specimen, trial.tool, trial.support, 2e-3)
    setup = changed_setup(sheet.specimen, trial.tool, trial.support, RADIUS, 0.5 * STEP)
    wider = fem_table(sheet)(*setup, 2e-3)
    foretold = law.force_with({RADIUS: 0.5 * STEP})
    assert foretold[100:] == pytest.approx(wider.force[100:], rel=5e-3)
    assert wider.force[-1] > 1.01 * law.force[-1]


def test_any_parameter_of_the_set_up_is_foretold_by_its_key(sheet) -> None:
    trial = sheet.trials[0]
    layer = sheet.specimen.layer_names[0]
    keys = (f"{layer}.youngs_modulus", f"{layer}.thickness", "support.hole_radius")
    told = fem_table(sheet, keys)(sheet.specimen, trial.tool, trial.support, 2e-3)
    assert set(told.by) == set(keys)
    assert told.by[keys[0]].force[0] == pytest.approx(told.force, rel=1e-6)  # the force goes with the modulus
    assert told.by[keys[0]].outward[0].table == pytest.approx(0.0, abs=1e-9)
    thicker = fem_table(sheet, ())(*changed_setup(sheet.specimen, trial.tool, trial.support, keys[1], 0.02), 2e-3)
    deep = slice(250, None)
    assert told.force_with({keys[1]: 0.02})[deep] == pytest.approx(thicker.force[deep], rel=2e-3)
    assert thicker.force[-1] > 1.01 * told.force[-1]
    assert told.force_with({keys[2]: 0.05})[-1] < told.force[-1]


def test_the_lower_face_moves_outwards_and_sinks(sheet) -> None:
    trial = sheet.trials[0]
    law = fem_table(sheet)(sheet.specimen, trial.tool, trial.support, 2e-3)
    assert law.outward is not None
    assert law.sink is not None
    outward, sink = law.outward.table, law.sink.table
    middle = np.searchsorted(law.radius, 15e-3)
    assert outward[-1, middle] > 1e-4
    assert outward[:, 0] == pytest.approx(0.0, abs=1e-6)
    assert sink[-1, 0] == pytest.approx(law.depth[-1], rel=0.2)
    assert law.depth[-1] >= 2e-3
    assert not law.note


def test_where_the_elements_have_no_answer_the_wave_goes_on_and_it_is_said(sheet, monkeypatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise InputError("the finite elements do not cover it")

    monkeypatch.setattr(module, "differentiated_ramp", refuse)
    monkeypatch.setattr(module, "elastic_ramp", refuse)
    trial = sheet.trials[0]
    law = fem_or_wave_table(sheet)(sheet.specimen, trial.tool, trial.support, 2e-3)
    assert "do not cover it" in law.note
    assert law.outward is not None
    with pytest.raises(InputError, match=r"--model fem: .* --model wave"):
        fem_table(sheet)(sheet.specimen, trial.tool, trial.support, 2e-3)


@pytest.mark.parametrize(("share", "close"), [(0.05, 3e-4), (0.25, 3e-4), (1.2, 1e-3), (5.0, 3e-3)])
def test_a_tension_before_the_press_adds_what_a_press_under_it_shows(sheet, share: float, close: float) -> None:
    trial = sheet.trials[0]
    told = fem_table(sheet)(sheet.specimen, trial.tool, trial.support, 2e-3)
    wide = np.log(trial.support.hole_radius / trial.tool.radius)
    stress = share * told.force[-1] * wide / (2.0 * np.pi * sheet.specimen.thickness * told.depth[-1])
    tense = replace(sheet, settings={**sheet.settings, PRETENSION: f"{stress:.9g} Pa"})
    pressed = fem_table(tense)(sheet.specimen, trial.tool, trial.support, 2e-3)
    assert not pressed.added
    added, outward = told.force_added({PRETENSION: stress}), told.outward_with({}, {PRETENSION: stress})
    more = pressed.force - told.force
    assert added[50:] == pytest.approx(more[50:], rel=0.03)
    assert told.force[50:] + added[50:] == pytest.approx(pressed.force[50:], rel=close)
    moved, shown = (each.table[-1] - told.outward.table[-1] for each in (pressed.outward, outward))
    assert shown == pytest.approx(moved, abs=0.08 * np.abs(moved).max())
    membrane = 2.0 * np.pi * stress * sheet.specimen.thickness * told.depth / wide
    assert more[50] == pytest.approx(membrane[50], rel=0.25)  # Timoshenko and Woinowsky-Krieger; bending adds to it


@pytest.mark.parametrize("key", [RADIUS, HOLE_RADIUS, "layer.thickness"])
def test_what_a_tension_adds_goes_with_the_set_up(sheet, key: str) -> None:
    trial, change = sheet.trials[0], 0.1
    setup = sheet.specimen, trial.tool, trial.support
    key = key.replace("layer", sheet.specimen.layers[0].name)
    told, stress = fem_table(sheet, (key,))(*setup, 2e-3), 2e3
    tense = replace(sheet, settings={**sheet.settings, PRETENSION: f"{stress:.9g} Pa"})
    changed = changed_setup(*setup, key, change)
    more = fem_table(tense, ())(*changed, 2e-3).force - fem_table(sheet, ())(*changed, 2e-3).force
    assert told.force_added({PRETENSION: stress}, {key: change})[50:] == pytest.approx(more[50:], rel=0.01)
    assert told.force_added({PRETENSION: stress})[-1] != pytest.approx(more[-1], rel=0.03)
