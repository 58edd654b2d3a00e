"""Every hidden effect: nothing at amplitude zero, as strong as wanted, the same from the same seed."""

import numpy as np
import pytest

from benchmark.blind.cases import FORMS, CaseName, draw_scene, generator, layout, make_case
from benchmark.blind.hidden import CATALOGUE, OUTSIDE, Hidden
from benchmark.blind.motion import Array
from benchmark.blind.scene import Scene
from benchmark.blind.simulate import Signals, simulate

SLUGS = (*CATALOGUE, *OUTSIDE)


def drawn(slug: str) -> tuple[Scene, Hidden]:
    name = CaseName("effect", slug, 0)
    rng = generator(name, "case")
    scene = draw_scene(name, rng)
    return scene, (CATALOGUE | OUTSIDE)[slug].draw(scene.scale, rng)


def largest_change(first: Signals, second: Signals) -> float:
    """Of force in shares of its peak, and of markers in mm."""
    assert first.x is not None
    assert first.y is not None
    force = abs(first.force - second.force).max() / abs(second.force).max()
    return max(force, 1e3 * abs(first.x - second.x).max(), 1e3 * abs(first.y - second.y).max())


def test_the_catalogue_has_22_effects() -> None:
    assert len(CATALOGUE) == 22
    assert not set(CATALOGUE) & set(OUTSIDE)


@pytest.mark.parametrize("slug", SLUGS)
def test_amplitude_zero_is_the_base(slug: str) -> None:
    scene, effect = drawn(slug)
    plan = scene.plans[-1]
    base = scene.mean(plan, ())
    assert largest_change(scene.mean(plan, [effect.of_size(0.0)]), base) < 1e-9
    assert largest_change(scene.mean(plan, [effect.of_size(0.1 if slug != "force_saturation" else 1.2)]), base) > 1e-3


@pytest.mark.parametrize("slug", SLUGS)
def test_an_effect_is_as_strong_as_wanted(slug: str) -> None:
    case = make_case(CaseName("outside" if slug in OUTSIDE else "effect", slug, 0, strength=20.0))
    assert case.strength == pytest.approx(20.0, rel=0.05)
    assert case.cells.strongest in case.cells.shows
    assert set(case.cells.shows) <= set(case.cells.may_show)


def test_where_effects_show() -> None:
    def strongest(slug: str) -> tuple[str, str] | None:
        return make_case(CaseName("effect", slug, 0)).cells.strongest

    assert strongest("adhesion") == ("force_z", "after_lift_off")
    assert strongest("poroelastic_drainage") == ("force_z", "hold")
    assert strongest("camera_latency")[0].startswith("marker")
    assert strongest("off_centre_load")[0].startswith("marker")


def test_layouts() -> None:
    chosen = [layout(CaseName("effect", "dry_friction", seed)) for seed in range(5)]
    assert chosen == ["two_conditions"] * 3 + ["force_only", "one_condition"]
    assert layout(CaseName("effect", "perspective", 3)) == "two_conditions"


def test_the_same_name_gives_the_same_case() -> None:
    name = CaseName("pair", "dry_friction+force_drift", 2)
    first, second = make_case(name), make_case(name)
    assert first == second
    other = make_case(CaseName("pair", "dry_friction+force_drift", 1))
    assert other.scene.body.shape != first.scene.body.shape
    assert [effect.slug for effect in first.effects] == ["dry_friction", "force_drift"]


def test_half_of_the_nulls_have_the_told_shape() -> None:
    shapes = [make_case(CaseName("null", "", seed, 0.0)).scene.body.shape for seed in range(2)]
    assert (shapes[0].radius, shapes[0].exponent, shapes[0].width) == (1.0, 0.0, 1.0)
    assert abs(shapes[1].radius - 1.0) > 0.0
    assert all(abs(shape.radius - 1.0) <= 0.1 and abs(shape.exponent) <= 0.05 for shape in shapes)


def test_hooks_of_hysteresis() -> None:
    scene, backlash = drawn("backlash")
    depth = np.concatenate([np.linspace(-1e-3, 2e-3, 200), np.linspace(2e-3, -1e-3, 200)])
    moved = backlash.of_size(0.2).travel(np.arange(400.0), depth, depth)
    lost = np.interp(1e-3, moved[:200], depth[:200]) - np.interp(1e-3, moved[:199:-1], depth[:199:-1])
    assert lost == pytest.approx(0.2 * 0.3 * scene.scale.shallow, rel=0.02)


@pytest.mark.parametrize("family", FORMS)
def test_what_stiffens_does_so_with_the_specimen(family: str) -> None:
    name = CaseName("effect", "strain_stiffening", 0, family=family)
    rng = generator(name, "case")
    scene = draw_scene(name, rng)
    effect = FORMS[family]["strain_stiffening"].draw(scene.scale, rng)
    moved = scene.motion(scene.plans[-1])

    def force(gain: float) -> Array:
        return simulate(scene.body, None, moved, [effect], gain).force

    np.testing.assert_allclose(force(1.4), 1.4 * force(1.0), rtol=1e-12)
