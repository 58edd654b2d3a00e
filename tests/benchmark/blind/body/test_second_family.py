"""The second family of worlds: its solver against the package `fem`, its forms against the first ones, its strength."""

import numpy as np
import pytest

import fem
from benchmark.blind.body.taylor_hood import Pressed, Stratum, gent, press, yeoh
from benchmark.blind.cases import FORMS, CaseName, draw_scene, generator, make_case
from benchmark.blind.hidden import CATALOGUE
from benchmark.blind.scene import Scene
from benchmark.blind.second_forms import SECOND_CATALOGUE, SECOND_OUTSIDE
from benchmark.errors import SolverError

YOUNG, POISSON = 180e3, 0.49
SHEAR, BULK = YOUNG / 2 / (1 + POISSON), YOUNG / 3 / (1 - 2 * POISSON)
TOOL, HOLE = 5e-3, 30e-3
DEPTHS = np.array([1e-3, 2e-3, 3e-3])


def triangles(clamp: str, law) -> Pressed:
    return press((Stratum(4e-3, SHEAR, BULK, law),), TOOL, HOLE, clamp, DEPTHS)


def by_fem(material: fem.Material, radius: float | None) -> fem.Solution:
    problem = fem.Problem(
        layers=(fem.Layer("sheet", 4e-3, 1000.0, material),),
        tool=fem.Tool(TOOL, "rigid_bonded"),
        support=fem.Support("hole", HOLE),
        kinematics="finite",
        discretisation=fem.Discretisation("default", radius=radius),
    )
    return fem.prepare(problem).run(fem.Load("depth", np.arange(1.0, 4.0), DEPTHS))


def test_triangles_agree_with_the_package_fem_on_a_plate_and_at_the_rim() -> None:
    # two codes, two elements; both meshes see the edge of the tool a little too stiff
    plate, rim = triangles("plate", yeoh(SHEAR, 0.0, 0.0)), triangles("rim", gent(SHEAR, 30.0))
    assert plate.force[1:] == pytest.approx(by_fem(fem.NeoHookean(YOUNG, POISSON), None).force, rel=0.02)
    assert rim.force[1:] == pytest.approx(by_fem(fem.Gent(SHEAR, 30.0, POISSON), HOLE * 1.0001).force, rel=0.02)
    assert (rim.force[1:] > 1.05 * plate.force[1:]).all()
    assert rim.radius[-1] < HOLE
    assert plate.sinking[-1, 0] > 0.9 * 3e-3
    assert abs(plate.outward[:, 0]).max() < 1e-9


def test_laws_have_their_slopes() -> None:
    x = np.array([0.3, 1.0])
    for law in (gent(SHEAR, 30.0), yeoh(SHEAR, 0.05, 0.01)):
        numeric = (law(x + 1e-4, 1) - law(x - 1e-4, 1)) / 2e-4
        assert law(x, 2) == pytest.approx(numeric, rel=1e-6)
        assert law(np.zeros(1), 1) == pytest.approx(SHEAR / 2)


def test_a_press_that_folds_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("benchmark.blind.body.taylor_hood.SHORTEST", 0.6)
    with pytest.raises(SolverError, match=r"no balance at 3\.50 mm"):
        press((Stratum(4e-3, SHEAR, BULK, gent(SHEAR, 30.0)),), TOOL, None, "plate", np.array([3.5e-3]))


@pytest.fixture(scope="module")
def scene() -> Scene:
    name = CaseName("effect", "dry_friction", 2, family="second")
    return draw_scene(name, generator(name, "case"))


def test_each_effect_has_another_form() -> None:
    assert set(SECOND_CATALOGUE) == set(CATALOGUE)
    assert not set(SECOND_CATALOGUE.values()) & set(CATALOGUE.values())
    assert not set(SECOND_OUTSIDE) & set(FORMS["first"])


@pytest.mark.parametrize("slug", FORMS["second"])
def test_amplitude_zero_is_the_base(slug: str, scene: Scene) -> None:
    effect = FORMS["second"][slug].draw(scene.scale, np.random.default_rng(1))
    plan = scene.plans[-1]
    base = scene.mean(plan, ())

    def change(amplitude: float) -> float:
        moved = scene.mean(plan, [effect.of_size(amplitude)]).minus(base)
        assert moved.x is not None
        return max(abs(moved.force).max() / abs(base.force).max(), 1e3 * abs(moved.x).max())

    assert change(0.0) < 1e-9
    assert change(1.2 if slug == "force_saturation" else 0.1) > 1e-3


@pytest.mark.parametrize("slug", ["poroelastic_drainage", "perspective", "outside_snap_through"])
def test_an_effect_is_as_strong_as_wanted(slug: str) -> None:
    case = make_case(CaseName("outside" if slug in SECOND_OUTSIDE else "effect", slug, 2, family="second"))
    assert case.strength == pytest.approx(20.0, rel=0.05)
    assert case.cells.strongest in case.cells.shows
    assert case.scene.body.family == "second"


def test_drainage_follows_the_published_relaxation(scene: Scene) -> None:
    # Hu et al. 2010 for a cylindrical punch: g = 1.304 exp(-sqrt(s)) - 0.304 exp(-0.254 s) after a step
    effect = SECOND_CATALOGUE["poroelastic_drainage"](scale=scene.scale, amplitude=2.0, time=3.0)
    time = np.arange(0.0, 6.0, 0.01)
    lost = -effect.push(time, np.ones_like(time), np.ones_like(time))
    s = time / 3.0
    assert lost == pytest.approx(1 - 1.304 * np.exp(-np.sqrt(s)) + 0.304 * np.exp(-0.254 * s), abs=1e-9)
