"""An exported press in CalculiX: its file runs and agrees with our own run, and what it prints is read as an FEA."""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import fem
from benchmark.errors import InputError
from benchmark.exchange import export_text
from benchmark.files import load_scenario
from benchmark.models import prepare, read_reference, scenario_drive

SMALL = {"load.observations": "5", "load.shape": "ramp", "fem.mesh": "coarse"}
BONDED = {"tool.contact": "rigid_bonded"}
PRESSES = {
    "force": BONDED | {"load.peak": "2 N"},
    "depth": BONDED | {"load.control": "depth", "load.peak": "1 mm"},
    "pressure": {"load.peak": "3 N"},
    "yeoh": BONDED | {"load.peak": "2 N", "dermis.hyperelastic": '{law="yeoh", c10="0.16 MPa", c20="0.1 MPa"}'},
    "mooney": BONDED
    | {"load.peak": "2 N", "dermis.hyperelastic": '{law="mooney_rivlin", c10="0.1 MPa", c01="0.06 MPa"}'},
    "hole": BONDED
    | {"tissue": "rtv3498_sheet", "support.kind": "hole", "support.hole_radius": "30 mm", "load.peak": "5 N"},
    "linear": {
        "fem.mesh": "default",
        "fem.kinematics": "linear",
        "tool.contact": "rigid_frictionless",
        "load.shape": "triangle",
    },
}
QUICK = ("force", "linear")
NEEDS = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
WITHIN = 5e-3


def solved(scenario, folder: Path) -> Path:
    """Run CalculiX on the exported scenario."""
    (folder / "press.inp").write_text(export_text(scenario, "inp"))
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    subprocess.run(["ccx", "press"], cwd=folder, capture_output=True, check=True, env=environment, timeout=300)
    return folder / "press.dat"


def agrees(name: str, folder: Path, settings: dict[str, str]) -> None:
    scenario = load_scenario("skin-5N", {**SMALL, **PRESSES[name], **settings})
    path = solved(scenario, folder)
    ours = prepare("fem", scenario).run(scenario_drive(scenario))
    theirs = read_reference(path, scenario).result
    peak = int(np.argmax(np.abs(ours.force)))
    np.testing.assert_allclose(theirs.top_deflection[peak], ours.top_deflection[peak], rtol=WITHIN)
    np.testing.assert_allclose(theirs.force[peak], ours.force[peak], rtol=WITHIN)
    if scenario.load.control == "force":
        field = read_reference(path.with_suffix(".frd"), scenario).result
        near = ours.profile_radii <= 2.0 * scenario.tool.radius
        apart = np.abs(field.profile - ours.profile)[:, near]
        assert apart.max() <= 0.02 * ours.top_deflection[peak].max()


@NEEDS
@pytest.mark.parametrize("name", QUICK)
def test_it_runs_and_agrees_with_our_run(name: str, tmp_path: Path) -> None:
    agrees(name, tmp_path, {})


@NEEDS
@pytest.mark.slow
@pytest.mark.parametrize("name", list(PRESSES))
def test_it_agrees_on_the_default_mesh(name: str, tmp_path: Path) -> None:
    agrees(name, tmp_path, {"fem.mesh": "default", "load.observations": "10"})


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"tool.contact": "rigid_frictionless", "tool.edge_radius": "1 mm"}, "tool.contact"),
        ({"dermis.relaxation": '[{g=0.3, tau="1 s"}]'}, "dermis.relaxation"),
        ({"physics.pretension": "2 kPa"}, "physics.pretension"),
        ({"support.kind": "half_space"}, "support.kind"),
        ({"fem.geometry": "block"}, "fem.geometry"),
        ({"load.control": "depth", "load.peak": "1 mm"}, "load.control"),
        ({"dermis.hyperelastic": '{law="gent", mu="0.3 MPa", jm=3.0}'}, "layer dermis: CalculiX has no law like Gent"),
    ],
)
def test_what_it_cannot_express_is_refused_by_name(settings: dict[str, str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        export_text(load_scenario("skin-5N", settings), "inp")


def test_another_format_is_refused() -> None:
    with pytest.raises(InputError, match="allowed: inp, feb"):
        export_text(load_scenario("skin-5N"), "ans")


def test_collapsed_quadrilaterals_become_triangles() -> None:
    text = export_text(load_scenario("skin-5N", BONDED | {"tissue": "ecoflex_00_30"}), "inp")
    rows = text.split("TYPE=CAX6")[1].split("*NSET")[0].splitlines()[1:]
    assert all(len(set(row.split(","))) == 7 for row in rows)


def test_bulk_modulus_and_law_stand_in_the_file() -> None:
    text = export_text(load_scenario("skin-5N", BONDED), "inp")
    for layer in load_scenario("skin-5N").tissue.layers:
        law = fem.NeoHookean(layer.youngs_modulus, layer.poisson_ratio)
        assert f"{0.5 * law.shear_modulus:.12g}, {2.0 / law.bulk_modulus:.12g}" in text
