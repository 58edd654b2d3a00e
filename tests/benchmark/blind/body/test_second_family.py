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
    # two codes, two elements; the triangles see the edge of the tool a little too stiff
    plate, rim = triangles("plate", yeoh(SHEAR, 0.0, 0.0)), triangles("rim", gent(SHEAR, 30.0))
    assert plate.force[1:] == pytest.approx(by_fem(fem.NeoHookean(YOUNG, POISSON), None).force, rel=0.006)
    assert rim.force[1:] == pytest.approx(by_fem(fem.Gent(SHEAR, 30.0, POISSON), HOLE * 1.0001).force, rel=0.006)
    assert (rim.force[1:] > 1.05 * plate.force[1:]).all()
    assert rim.radius[-1] < HOLE
    assert plate.sinking[-1, 0] > 0.9 * 3e-3
    assert abs(plate.outward[:, 0]).max() < 1e-9


def test_the_lower_face_of_a_plate_moves_as_by_the_package_fem() -> None:
    plate, other = triangles("plate", gent(SHEAR, 30.0)), by_fem(fem.Gent(SHEAR, 30.0, POISSON), None)
    face = np.flatnonzero(np.isclose(other.mesh.nodes[:, 1], -4e-3))
    face = face[np.argsort(other.mesh.nodes[face, 0])]
    for own, (component, sign) in ((plate.outward, (0, 1)), (plate.sinking, (1, -1))):
        theirs = sign * np.interp(plate.radius, other.mesh.nodes[face, 0], other.displacement[-1, face, component])
        assert np.sqrt(np.mean((own[-1] - theirs) ** 2)) < 0.002 * abs(theirs).max()


def test_a_skin_of_unlike_layers_bends_as_by_the_package_fem() -> None:
    # ten times the modulus above: a pressure that goes on across the face of the layers bends by 2.5 %
    dermis, fat = 135e3, 13.5e3
    depths = np.linspace(0.0, 4e-3, 9)[1:]
    strata = tuple(Stratum(h, g, 24.7 * g, yeoh(g, 0.02, 0.0005)) for h, g in ((2e-3, dermis), (9e-3, fat)))
    own = press(strata, 4.5e-3, None, "plate", depths).force[1:]
    poisson = (3 * 24.7 - 2) / (2 * (3 * 24.7 + 1))
    layers = tuple(
        fem.Layer(name, h, 1000.0, fem.Yeoh(g / 2, 0.01 * g, 0.00025 * g, poisson))
        for name, h, g in (("dermis", 2e-3, dermis), ("fat", 9e-3, fat))
    )
    problem = fem.Problem(layers, fem.Tool(4.5e-3, "rigid_bonded"), fem.Support("bonded"), kinematics="finite")
    theirs = fem.prepare(problem).run(fem.Load("depth", np.arange(1.0, 9.0), depths)).force
    ratio = own / theirs
    assert ratio == pytest.approx(np.full(8, 1.0), abs=0.01)
    assert ratio / ratio.mean() == pytest.approx(np.full(8, 1.0), abs=0.006)


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
