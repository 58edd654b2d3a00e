"""Labs: what their sessions tell, and an effect's strength beside what they do not know."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmark.blind.cases import CaseName, draw_scene, generator, make_case
from benchmark.blind.labs import LABS, LabConditions
from benchmark.blind.scene import Scene
from benchmark.blind.session_files import case
from benchmark.blind.strength import base_of, strength
from benchmark.blind.suites import MIXED, suite
from benchmark.files.sessions.session_loading import load_session


def scene_of(lab: LabConditions, slug: str = "off_centre_load") -> Scene:
    name = CaseName("effect", slug, 0)
    return draw_scene(name, generator(name, "case"), lab)


def test_the_mixed_suites_are_mixed() -> None:
    full = suite("full", 40)
    assert [sum(each.kind == kind for each in full) for kind in ("effect", "pair", "null", "outside")] == [
        400,
        60,
        200,
        100,
    ]
    assert len({each.text for each in full}) == 760
    met = {(each.slug, each.family, each.lab) for each in full if each.kind == "effect"}
    assert len(met) >= 0.97 * 22 * 2 * len(LABS)
    assert {"dry_friction+strain_stiffening", "adhesion+viscoelastic_relaxation"} <= {each.slug for each in full}
    part = suite("labs", 40)[:30]
    assert sum(MIXED["labs"]) == 60
    assert {each.kind for each in part} == {"effect", "pair", "null", "outside"}
    assert {each.family for each in part} == {"first", "second"}
    assert {each.lab for each in part} == set(LABS)
    nulls = [each for each in full if each.kind == "null"]
    told = {(each.family, each.seed % 2) for each in nulls}
    assert len(told) == 4


@pytest.mark.parametrize("lab", LABS)
def test_the_same_seed_gives_the_same_lab(lab: str) -> None:
    first, again, other = (LABS[lab](np.random.default_rng(seed)) for seed in (1, 1, 2))
    assert first == again
    assert (first != other) == (lab not in ("as_told", "printed", "clamped_otherwise", "as_labs_are"))
    assert 0.0 <= first.print_scatter <= 0.3e-3
    assert 10.0 <= first.frame_rate <= 60.0
    assert first.trials == 0 or 3 <= first.trials <= 50


def test_an_effect_that_a_lab_cannot_tell_from_its_set_up_is_not_strong() -> None:
    told = scene_of(LabConditions(), "marker_scale_error")
    printed = replace(told, lab=LabConditions(name="printed", print_scatter=0.06e-3))
    effect = make_case(CaseName("effect", "marker_scale_error", 0)).effects
    alone, beside = strength(told, base_of(told), effect), strength(printed, base_of(printed), effect)
    assert alone == pytest.approx(20.0, rel=0.05)
    assert beside < 0.3 * alone  # by hand: offsets of 60 um on 18 markers against a scale error of some 10 um


def test_what_is_known_exactly_does_not_count() -> None:
    told = scene_of(LabConditions())
    sure = replace(told, lab=LabConditions(name="printed", print_scatter=1e-12))
    effect = make_case(CaseName("effect", "off_centre_load", 0)).effects
    assert strength(sure, base_of(sure), effect) == pytest.approx(strength(told, base_of(told), effect), rel=1e-3)


def test_a_session_tells_no_more_than_its_lab_knows(tmp_path: Path) -> None:
    folder, made = case(CaseName("null", "", 1, 0.0, lab="as_labs_are"), tmp_path)
    session = load_session(folder)
    told, true = session.specimen.layers[0], made.scene.body.specimen.layers[0]
    assert told.own_uncertainties == {"thickness": pytest.approx(0.04), "youngs_modulus": pytest.approx(0.25)}
    assert told.thickness != true.thickness
    assert session.camera is not None
    assert session.camera.print_scatter is None
    assert not any(lab in "".join(each.read_text() for each in folder.glob("*.toml")) for lab in LABS)


def test_a_surface_that_is_found_by_force_is_found_late(tmp_path: Path) -> None:
    name = CaseName("null", "", 1, 0.0, lab="found_by_force")
    folder, made = case(name, tmp_path)
    deepest = [trial.table.depth.max() for trial in load_session(folder).trials if trial.condition == "slow"]
    planned = made.scene.plans[0].depth
    assert planned - 0.5e-3 < np.mean(deepest) < planned - 0.03e-3
    assert np.std(deepest) > 0.01e-3


def test_a_lab_may_leave_out_what_it_does_not_need(tmp_path: Path) -> None:
    few = LabConditions(name="short_of_trials", trials=4, unloading=False)
    scene = scene_of(few, "force_saturation")
    assert len(scene.plans) == 1
    assert scene.repeats == 4
    moved = scene.motion(scene.plans[0])
    assert moved.depth[-1] == pytest.approx(moved.depth.max())
    assert "4 trials, no unloading" in few.in_words


def test_at_the_rim_the_sheet_is_stiffer() -> None:
    told, rim = scene_of(LabConditions()), scene_of(LabConditions(clamp="rim"))
    depth = np.array([1e-3, 3e-3])
    ratio = rim.body.force(depth) / told.body.force(depth)
    assert (ratio > 1.05).all()
    assert (ratio < 1.4).all()


def test_heights_change_force_and_field() -> None:
    body = scene_of(LabConditions()).body
    higher = replace(body, setup=(("all.thickness", 0.05),))
    depth, radius = np.array([2e-3]), np.array([0.0, 6e-3])
    assert higher.force(depth)[0] > 1.03 * body.force(depth)[0]
    assert higher.lower_face(depth, radius)[0] != pytest.approx(body.lower_face(depth, radius)[0])
    assert higher.force(np.zeros(1))[0] == 0.0
