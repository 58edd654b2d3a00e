from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.model_file import AddedEffect, RepairedModel, Value, model_toml
from benchmark.models import Drive, ModelResult, scenario_drive
from benchmark.response.model_with_effects import (
    RepairedPress,
    effects_of,
    load_repair,
    prepare_with_effects,
    switched_on,
)
from tests.performance.effects import VALUES, rows

STIFFNESS = 1000.0
SCENARIO = load_scenario("skin-5N", {"load.shape": "ramp_hold", "load.hold": "10 s", "load.peak": "2 N"})


def _model(*effects: AddedEffect) -> RepairedModel:
    return RepairedModel("m.toml", "skin_forearm", "wave", effects, {})


RELAXATION = AddedEffect("viscoelastic_relaxation", {"g_1": Value(0.4, ""), "tau_1": Value(1.0, "s")})
STIFFENING = AddedEffect("strain_stiffening", {"b_1": Value(0.0, ""), "b_2": Value(20.0, "")})
DRIFT = AddedEffect("force_drift", {"rate": Value(0.01, "N/s"), "tau": Value(100.0, "s")})


class Linear:
    """Two layers, the lower one moving half as much."""

    def run(self, drive: Drive, on_step=None) -> ModelResult:
        depth = drive.value if drive.control == "depth" else drive.value / STIFFNESS
        top = np.outer(depth, [1.0, 0.5])
        radii = np.linspace(0.0, 1e-2, 5)
        peak = int(np.abs(drive.value).argmax())
        profile = np.outer(top[peak], np.exp(-radii / 5e-3))
        return ModelResult(
            "wave", ("a", "b"), drive.time, STIFFNESS * depth, depth, top, radii, profile, peak, 1, {}, ()
        )

    def follow(self, drive: Drive, on_step=None):
        result = self.run(drive)
        return lambda: result


def _pressed(model: RepairedModel, drive: Drive) -> ModelResult:
    return RepairedPress(Linear(), switched_on(model, SCENARIO, "wave")).run(drive)


def test_held_at_a_force_a_relaxing_body_creeps() -> None:
    drive = scenario_drive(SCENARIO)
    result = _pressed(_model(RELAXATION), drive)
    assert np.allclose(result.force, drive.value)
    assert result.depth[-1] > 1.3 * 2.0 / STIFFNESS
    assert np.allclose(result.top_deflection[:, 1], 0.5 * result.top_deflection[:, 0])
    assert result.profile[0, 0] == pytest.approx(result.top_deflection[result.peak_step, 0])
    assert result.notes["effects switched on"] == "viscoelastic_relaxation"


def test_held_at_a_depth_its_force_falls_to_what_is_left() -> None:
    time = np.linspace(0.01, 20.0, 400)
    result = _pressed(_model(RELAXATION), Drive("depth", time, np.minimum(time / 0.1, 1.0) * 1e-3))
    assert result.force[-1] == pytest.approx(0.6 * STIFFNESS * 1e-3, rel=1e-3)


@pytest.mark.parametrize("terms", [1, 2, 3])
def test_a_model_file_has_the_form_with_as_many_terms_as_it_states(terms: int) -> None:
    shares = {f"g_{k}": Value(0.1 * k, "") for k in range(1, terms + 1)}
    times = {f"tau_{k}": Value(0.01 * k, "s") for k in range(1, terms + 1)}
    model = _model(AddedEffect("viscoelastic_relaxation", shares | times))
    ((form, values),) = effects_of(model)
    assert set(form.names) == set(values) == set(shares | times)
    time = np.linspace(0.01, 20.0, 400)
    result = _pressed(model, Drive("depth", time, np.minimum(time / 0.1, 1.0) * 1e-3))
    left = np.prod([1.0 - 0.1 * k for k in range(1, terms + 1)])
    assert result.force[-1] == pytest.approx(left * STIFFNESS * 1e-3, rel=1e-3)


def test_without_effects_nothing_changes() -> None:
    drive = scenario_drive(SCENARIO)
    assert np.array_equal(_pressed(_model(), drive).depth, Linear().run(drive).depth)


def test_rig_and_sensors_are_no_part_of_a_press_and_that_is_said() -> None:
    drive = scenario_drive(SCENARIO)
    result = _pressed(_model(DRIFT), drive)
    assert np.array_equal(result.depth, Linear().run(drive).depth)
    assert "force_drift is not switched on" in result.warnings[0]


def test_stiffening_found_on_a_linear_wave_is_left_to_finite_strain() -> None:
    model = _model(STIFFENING)
    assert switched_on(model, SCENARIO, "wave").on == ("strain_stiffening",)
    assert switched_on(model, SCENARIO, "fem").on == ()
    assert switched_on(replace(model, large_press="corrected"), SCENARIO, "fem").on == ("strain_stiffening",)
    linear = load_scenario("skin-5N", {"fem.kinematics": "linear"})
    assert switched_on(model, linear, "fem").on == ("strain_stiffening",)


def test_own_effects_are_known_by_their_file(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    warming = AddedEffect("warming", {"s": Value(0.1, ""), "tau": Value(5.0, "s")})
    path.write_text(model_toml(_model(warming)))
    with pytest.raises(InputError, match="warming"):
        load_repair(path)
    own = Path(__file__).parents[3] / "examples/own_effect.py"
    assert load_repair(path, own).slugs == ("warming",)


SHORT = {"load.observations": "8", "load.peak": "2 N", "fem.mesh": "coarse"}
INSIDE = "effects in the model itself"
SOFTENING = AddedEffect("stress_softening", {"softening": Value(0.2, ""), "softening_width": Value(0.5, "")})
TENSION = AddedEffect("pretension", {"pretension": Value(3e3, "Pa"), "field": Value(0.0, "")})
QUADRATIC = AddedEffect("strain_stiffening", {"b_1": Value(0.0, ""), "b_2": Value(8.0, "")})


def _both(name: str, *effects: AddedEffect) -> tuple[ModelResult, ModelResult]:
    scenario, model = load_scenario(name, SHORT), replace(_model(*effects), large_press="corrected")
    fem, wave = (prepare_with_effects(m, scenario, own=model).run(scenario_drive(scenario)) for m in ("fem", "wave"))
    return fem, wave


@pytest.mark.parametrize(
    ("specimen", "effect", "allowed"),
    [
        ("skin-5N", RELAXATION, 0.015),
        ("skin-5N", QUADRATIC, 0.006),
        ("skin-5N", TENSION, 0.006),
        ("phantom", RELAXATION, 0.015),
        ("phantom", TENSION, 0.01),
    ],
    ids=lambda value: getattr(value, "slug", None),
)
def test_the_fem_itself_has_the_effect_as_the_wave_has_it(specimen: str, effect: AddedEffect, allowed: float) -> None:
    """Where their elastic depths are 0.4 % (skin) and 0.7 % (sheet) apart; both differ from the elastic press."""
    fem, wave = _both(specimen, effect)
    elastic, _ = _both(specimen)
    peak = fem.peak_step
    assert fem.notes[INSIDE] == effect.slug
    assert wave.depth[peak] == pytest.approx(fem.depth[peak], rel=allowed)
    assert abs(fem.depth[peak] / elastic.depth[peak] - 1.0) > 0.03


def test_what_the_fem_lacks_acts_on_top_of_it_and_that_is_said() -> None:
    fem, _ = _both("skin-5N", SOFTENING)
    assert INSIDE not in fem.notes
    assert any("stress_softening acts on top of the FEM's elastic answer" in text for text in fem.warnings)


def test_beside_an_effect_on_top_only_effects_without_memory_are_in_the_fem() -> None:
    fem, _ = _both("skin-5N", RELAXATION, SOFTENING, TENSION)
    assert fem.notes[INSIDE] == "pretension"
    said = [text for text in fem.warnings if "viscoelastic_relaxation acts on top" in text]
    assert said
    assert "stress_softening acts on top" in said[0]


@pytest.mark.slow
def test_wave_and_fem_agree_with_each_effect_as_without() -> None:
    """At the peak no more than 1.3 % further apart than the elastic answers."""
    table = list(rows(observations=12, mesh="coarse"))
    elastic = {row.specimen: abs(row.at_peak) for row in table if row.effect == "none"}
    assert len(table) == len(elastic) * (1 + len(VALUES))
    for row in table:
        assert abs(row.at_peak) <= elastic[row.specimen] + 1.3, row
