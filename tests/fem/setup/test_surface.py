"""Bodies bounded by a surface, from the mesh to the press."""

import platform
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pyvista
import skfem

import fem
from fem.errors import FemError
from fem.mesh.surface import filling as kept_filling
from fem.mesh.surface import own_process, specimen
from fem.mesh.surface.filling import Refinement, fill
from fem.mesh.surface.own_process import tetrahedralize_apart
from fem.mesh.surface.specimen import build_surface_mesh
from fem.mesh.surface.surface_file import Surface
from fem.setup.building import solid_model

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def ball():
    """A sphere of 20 mm."""
    sphere = pyvista.Icosphere(radius=0.02, nsub=3)
    return Surface(np.asarray(sphere.points, dtype=np.float64), sphere.regular_faces.astype(np.int64))


def around(fine, coarse):
    """Wanted edge lengths for a tool of 6 mm on the ball's top, no finer at its edge."""
    top = np.array([0.0, 0.0, 0.02])
    return Refinement(top, 6e-3, top[None], fine, fine, coarse, 0.7)


@pytest.fixture(scope="module")
def layered(ball):
    """The sphere with a rind of 4 mm, under a tool of 6 mm on its top."""
    return build_surface_mesh(ball, (4e-3, 1.0), (0.0, 0.0, 6e-3), 0.7)


def test_the_layers_have_their_volumes(layered, ball):
    inner = 4 / 3 * np.pi * 0.016**3
    np.testing.assert_allclose(layered.quality.layer_volume, [ball.volume - inner, inner], rtol=0.03)
    assert abs(layered.quality.volume_error) < 0.02
    assert layered.quality.least > 0.05
    assert layered.remarks == ()


def test_the_tool_touches_the_top(layered):
    np.testing.assert_allclose(layered.nodes[layered.interfaces[0][0]], [0.0, 0.0, 0.02], atol=2e-4)
    assert layered.tool_load.sum() == pytest.approx(-1.0)
    assert layered.tool_distance[layered.top].max() < 9e-3
    heights = layered.profile(layered.nodes[:, 2], np.array([0.0, 8e-3, 0.03]))
    np.testing.assert_allclose(heights[0, :2], [0.02, np.sqrt(0.02**2 - 0.008**2)], atol=4e-4)
    np.testing.assert_allclose(heights[1, :2], [0.016, np.sqrt(0.016**2 - 0.008**2)], atol=8e-4)
    assert np.isnan(heights[:, 2]).all()


def problem(surface, contact="uniform_pressure", **other):
    layers = (
        fem.Layer("rind", 4e-3, 1000.0, fem.NeoHookean(2e4, 0.48)),
        fem.Layer("pulp", 1.0, 1000.0, fem.NeoHookean(1e4, 0.48)),
    )
    words = {"kinematics": "linear", "discretisation": fem.Discretisation("coarse"), **other}
    return fem.Problem(
        layers, fem.Tool(6e-3, contact), fem.Support("bonded"), geometry="surface", surface=surface, **words
    )


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_a_press_is_in_equilibrium(ball, layered, contact):
    model = solid_model(problem(ball, contact), layered, "auto", ())
    solution = model.run(fem.Load("force", np.array([1.0]), np.array([0.1])))
    np.testing.assert_allclose(solution.reaction, solution.force, rtol=1e-6)
    np.testing.assert_allclose(solution.top_deflection[0, 0], solution.depth[0], rtol=1e-3)
    assert 0.0 < solution.top_deflection[0, 1] < solution.top_deflection[0, 0]
    fields = solution.fields(0)
    assert (fields.cell_type, fields.cells.shape[1]) == (24, 10)


@pytest.mark.parametrize(
    ("words", "change"),
    [
        ("surface is missing", {"surface": None}),
        ("has the support 'bonded' only", {"support": fem.Support("half_space")}),
        ("is not above the surface", {"tool": fem.Tool(6e-3, "uniform_pressure", position=(0.1, 0.0))}),
        ("tool.tilt", {"tool": fem.Tool(6e-3, "rigid_bonded", tilt=0.1)}),
    ],
)
def test_what_does_not_fit_is_refused(ball, words, change):
    with pytest.raises(fem.FemError, match=words):
        fem.prepare(replace(problem(ball), **change))


def test_layers_thicker_than_the_body_are_refused(ball):
    with pytest.raises(fem.FemError, match=r"no place in the body is deeper than 0.02 m: is the unit right"):
        build_surface_mesh(ball, (0.03, 1.0), (0.0, 0.0, 6e-3), 0.7)


def pillar(places):
    """Points (n, 3) of a box of 20 x 20 x 60 mm that widens by 2 % upwards, from places in the unit cube."""
    x, y, z = places.T
    return np.stack((0.02 * (x - 0.5) * (1 + 0.02 * z), 0.02 * (y - 0.5) * (1 + 0.02 * z), 0.06 * z), axis=1)


def pressed_pillar(monkeypatch, shape, radius):
    """Mesh and stiffness in N/m of a body of 20 kPa and Poisson's ratio 0 on structured tetrahedra."""
    box = pyvista.Box((0, 1, 0, 1, 0, 1)).triangulate().subdivide(2, "linear").clean()
    surface = Surface(shape(np.asarray(box.points, dtype=np.float64)), box.regular_faces.astype(np.int64))
    line = np.linspace(0.0, 1.0, 5)
    cube = skfem.MeshTet.init_tensor(line, line, np.linspace(0.0, 1.0, 21))
    points, cells = shape(cube.p.T), cube.t.T.copy()
    turned = np.linalg.det(points[cells[:, 1:]] - points[cells[:, :1]]) < 0.0
    cells[turned] = cells[turned][:, [0, 2, 1, 3]]
    filled = points, cells, np.zeros(len(cells), dtype=np.int64)
    monkeypatch.setattr(specimen, "kept_filling", lambda *_: filled)
    layer = fem.Layer("pillar", 0.06, 1000.0, fem.NeoHookean(2e4, 0.0))
    tool = fem.Tool(radius, "uniform_pressure")
    model = fem.prepare(
        fem.Problem((layer,), tool, fem.Support("bonded"), "linear", geometry="surface", surface=surface)
    )
    return model.mesh, 0.1 / model.run(fem.Load("force", np.array([1.0]), np.array([0.1]))).depth[0]


def test_a_pillar_is_bonded_at_its_base_only(monkeypatch):
    """Its walls look a little down. Judge: E A / h, in which A of a body that widens is the product of both widths."""
    mesh, stiffness = pressed_pillar(monkeypatch, pillar, 0.0148)
    np.testing.assert_array_equal(mesh.base, mesh.nodes[:, 2] == 0.0)
    assert stiffness == pytest.approx(2e4 * 0.02 * 0.0204 / 0.06, rel=2e-3)


def test_a_body_that_rests_on_no_face_is_refused(monkeypatch):
    def leaning(places):
        x, y, z = pillar(places).T
        return np.stack((x, y, z + 2.0 * np.abs(x)), axis=1)

    with pytest.raises(FemError, match=r"no face .* rests on the base; .* lowest 15 % .* within 53 degrees"):
        pressed_pillar(monkeypatch, leaning, 0.0148)


SLAB_BY_OTHERS = {"uniform_pressure": 0.2616e-3, "rigid_bonded": 0.1838e-3}
"""Depth in m of the slab below at 0.1 N, by another mesher and plain quadratic tetrahedra (docs/fem.md)."""


@pytest.mark.parametrize(
    ("density", "most"),
    [
        ("coarse", {"uniform_pressure": 0.01, "rigid_bonded": 0.04}),
        pytest.param("default", {"uniform_pressure": 0.005, "rigid_bonded": 0.01}, marks=pytest.mark.slow),
        pytest.param("fine", {"uniform_pressure": 0.005, "rigid_bonded": 0.005}, marks=pytest.mark.slow),
    ],
)
def test_a_slab_is_pressed_as_deep_as_by_other_codes(density, most):
    """One layer of 12 mm, 72 mm wide, its sides free; a constant pressure alone was 33 % too deep when coarse."""
    box = pyvista.Box((-0.036, 0.036, -0.036, 0.036, 0.0, 0.012)).triangulate().subdivide(3, "linear").clean()
    surface = Surface(np.asarray(box.points, dtype=np.float64), box.regular_faces.astype(np.int64))
    layer = fem.Layer("slab", 0.012, 1000.0, fem.NeoHookean(2e4, 0.45))
    for contact, depth in SLAB_BY_OTHERS.items():
        tool, meshed = fem.Tool(6e-3, contact), fem.Discretisation(density)
        model = fem.prepare(
            fem.Problem((layer,), tool, fem.Support("bonded"), "linear", meshed, geometry="surface", surface=surface)
        )
        found = model.run(fem.Load("force", np.array([1.0]), np.array([0.1]))).depth[0]
        assert found == pytest.approx(depth, rel=most[contact]), contact


@pytest.mark.slow
def test_a_liver_goes_from_stl_to_a_pressed_vtu(tmp_path):
    command = [sys.executable, "-m", "tests.performance.liver", tmp_path]
    subprocess.run(command, capture_output=True, check=True, cwd=ROOT)
    grid = pyvista.read(tmp_path / "liver_synthetic.vtu")
    assert set(np.unique(grid.cell_data["layer"])) == {0, 1, 2}
    assert grid.point_data["displacement_m"][:, 2].min() < -5e-3


def test_the_mesh_of_a_body_is_kept(ball, tmp_path, monkeypatch):
    """The mesher is called once for a body, and again for another or where the file is damaged."""
    kept, calls = tmp_path / "mesh.npz", []

    def counted(*arguments):
        calls.append(arguments)
        points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, float(len(calls))]])
        return points, np.array([[0, 1, 2, 3]]), np.array([0])

    monkeypatch.setattr(kept_filling, "fill", counted)
    wanted = around(4e-3, 6e-3)
    first = kept_filling.kept_filling(ball, np.array([4e-3]), wanted, kept)
    for found, array in zip(kept_filling.kept_filling(ball, np.array([4e-3]), wanted, kept), first, strict=True):
        np.testing.assert_array_equal(found, array)
    assert len(calls) == 1
    kept_filling.kept_filling(ball, np.array([3e-3]), wanted, kept)
    assert len(calls) == 2
    kept.write_bytes(b"half")
    kept_filling.kept_filling(ball, np.array([3e-3]), wanted, kept)
    kept_filling.kept_filling(ball, np.array([3e-3]), wanted, None)
    assert len(calls) == 4


@pytest.mark.skipif((sys.platform, platform.machine()) != ("linux", "x86_64"), reason="the seed is set there only")
def test_a_body_is_meshed_the_same_again(ball, monkeypatch):
    """The mesher shuffles the surface's triangles; its seed is set, and the number of threads does not matter."""
    wanted, found = around(6e-3, 9e-3), []
    for threads in ("1", "2"):
        monkeypatch.setenv("OMP_NUM_THREADS", threads)
        found.append(fill(ball, np.array([4e-3]), wanted))
    for first, second in zip(*found, strict=True):
        np.testing.assert_array_equal(first, second)


def test_a_mesher_without_a_seed_is_told_of(ball, monkeypatch):
    monkeypatch.setattr(own_process.platform, "machine", lambda: "riscv64")
    mesh = build_surface_mesh(ball, (1.0,), (0.0, 0.0, 6e-3), 0.4)
    assert mesh.remarks[-1].startswith("the mesher takes no seed on this system: each run has another mesh")


def test_a_mesher_that_fails_says_why(ball):
    """Its process ends with the reason, which is an error of this one."""
    with pytest.raises(FemError, match=r"the mesher failed \(ValueError: Edge length"):
        tetrahedralize_apart(vertices=ball.points, faces=ball.triangles.astype(np.int32), edge_length_fac=2.0)


@pytest.mark.slow
def test_a_run_on_a_kept_mesh_goes_on_with_a_new_model(ball, tmp_path):
    layers = (
        fem.Layer("rind", 4e-3, 1e3, fem.NeoHookean(2e4, 0.45)),
        fem.Layer("rest", 1.0, 1e3, fem.NeoHookean(1e4, 0.45)),
    )
    problem = fem.Problem(
        layers,
        fem.Tool(6e-3, "uniform_pressure"),
        fem.Support("bonded"),
        discretisation=fem.Discretisation("coarse"),
        geometry="surface",
        surface=ball,
    )
    mesh, steps = tmp_path / "mesh.npz", tmp_path / "steps.npz"
    load = fem.Load("force", [1.0, 2.0, 3.0], [0.02, 0.04, 0.05])
    stopped = fem.prepare(problem, mesh_file=mesh)

    def stop(report):
        if report.step == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped.run(load, stop, steps)
    resumed = fem.prepare(problem, mesh_file=mesh).run(load, checkpoint=steps)
    assert resumed.resumed.steps == 2
    np.testing.assert_allclose(resumed.displacement, stopped.run(load).displacement, rtol=1e-10, atol=1e-14)
