"""Tables of the wave and of the finite elements, against the models they were made from."""

import base64
from dataclasses import replace

import numpy as np
import pytest

import fem
from benchmark.files import load_scenario
from benchmark.models.fem_model import FemModel
from benchmark.press.pressed_specimen import LEVELS, relaxation_of
from benchmark.press.radial_table import table_of_body, table_of_levels
from wavemodel import DiscTool, LayeredWave, Prony, WaveDiscretisation
from wavemodel.control import Grid, layered_body
from wavemodel.control.pressed_body import radii_of

GRID = Grid(49e-3, 49e-3, 1e-3)


def test_the_table_of_a_wave_is_its_body(wave):
    one = wave("corrected")
    body = layered_body(one, GRID)
    table = table_of_body(body, 3e-3)
    assert table.surface is None
    for depth in (0.0, 0.7e-3, 2.1e-3, 3e-3):
        force = body.elastic(depth)
        assert np.interp(depth, table.depth, table.force) == pytest.approx(force, rel=2e-6, abs=1e-9)
        out = np.zeros((3, 40, 1))
        body.add(force, np.linspace(0.0, 19e-3, 40), np.zeros(1), out)
        radii = radii_of(table.reach)
        found = [np.interp(np.linspace(0.0, 19e-3, 40), radii, row) for row in table.profile(depth)]
        np.testing.assert_allclose(found, out[..., 0], atol=1e-6 * 3e-3)


def test_a_linear_wave_s_table_keeps_how_tools_feel_each_other(wave):
    body = layered_body(wave(), GRID)
    table = table_of_body(body, 3e-3)
    np.testing.assert_array_equal(table.surface, body.surface)
    assert table.field.shape[0] == 1


def test_the_finite_elements_are_read_rightly_between_their_levels(specimen):
    ramp = specimen.fem
    assert ramp.levels == LEVELS
    depth = ramp.table.deepest * np.array([1.5, 7.5, 20.5]) / LEVELS
    direct = FemModel(specimen.scenario).prepared.run(fem.Load("depth", np.arange(1.0, 4.0), depth))
    radii = radii_of(specimen.wave.reach)
    for step, one in enumerate(depth):
        assert np.interp(one, ramp.table.depth, ramp.table.force) == pytest.approx(direct.force[step], rel=1e-3)
        error = np.abs(ramp.table.profile(one) - np.nan_to_num(direct.profile(step, radii)))
        assert error.max() < 2e-3 * one


def test_wave_and_finite_elements_of_a_specimen_agree_as_they_should(specimen):
    depth = 0.8 * specimen.fem.table.deepest
    error = np.abs(specimen.wave.profile(depth) - specimen.fem.table.profile(depth))
    assert error.max() < 0.02 * depth
    assert specimen.fem.wall_seconds > 0.0


def test_numbers_survive_the_page(specimen):
    table = specimen.wave.to_dict()
    shape = table["fields"], table["layers"], table["radii"]
    field = np.frombuffer(base64.b64decode(table["field"]), "<f4").reshape(shape)
    np.testing.assert_allclose(field, specimen.wave.field, atol=1e-7)
    np.testing.assert_array_equal(np.frombuffer(base64.b64decode(table["force_N"]), "<f8"), specimen.wave.force)


def test_layers_that_relax_each_in_its_own_way_have_the_stack_s_series():
    from tests.benchmark.press.conftest import SKIN

    wave = LayeredWave(
        SKIN,
        DiscTool(3e-3),
        discretisation=WaveDiscretisation(window=40e-3, modes=24),
        relaxation=(None, Prony((0.4,), (0.3,)), Prony((0.5,), (2.0,))),
        large_press="linear",
    )
    series = relaxation_of(wave.body)
    time = np.concatenate([[1e-6], np.geomspace(1e-3, 20.0, 40)])
    held = wave.run("depth", time, np.full(time.size, 1e-3)).force
    np.testing.assert_allclose(series.modulus(time[1:]), held[1:] / held[0], rtol=1e-4)
    assert series.modulus(np.array([1e-9]))[0] == pytest.approx(1.0)


def test_levels_must_not_be_even():
    depth = np.array([1e-3, 1.5e-3, 3e-3])
    profile = np.array([[[one, 0.5 * one**2 * 1e3]] for one in depth])
    table = table_of_levels(depth, profile, 2.0 * depth, 1e-2, 3e-3)
    np.testing.assert_allclose(table.profile(2e-3), [[2e-3, 2e-3]], rtol=1e-5)
    assert replace(table, surface=None).with_force(table.force * 2).force[-1] == pytest.approx(12e-3)


def test_a_press_keeps_what_it_cannot_follow_in_words():
    from benchmark.press.pressed_specimen import pressed_specimen

    changes = {"load.peak": "0.5 N", "physics.interface_shear_limit": "1 kPa", "wave.large_press": "linear"}
    found = pressed_specimen(load_scenario("skin-5N", {"fem.mesh": "coarse", **changes}))
    assert any("interface_shear_limit" in remark for remark in found.remarks)


def test_layers_over_a_hole_that_relax_each_in_their_own_way_are_said_to_be_elastic():
    from benchmark.press.pressed_specimen import ELASTIC, pressed_specimen

    relaxes = {"dermis.relaxation": '[{ g = 0.3, tau = "0.5 s" }]'}
    hole = {"support.kind": "hole", "support.hole_radius": "30 mm", "load.peak": "0.5 N", "fem.mesh": "coarse"}
    found = pressed_specimen(load_scenario("skin-5N", hole | relaxes))
    assert found.memory.series is ELASTIC
    assert any(remark.startswith("Relaxation of dermis is left out") for remark in found.remarks)
