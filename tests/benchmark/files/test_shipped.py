"""What ships is sound: every file loads, says where its values come from, and holds the published numbers."""

import subprocess
import sys
import tomllib
from importlib.metadata import EntryPoint
from pathlib import Path

import numpy as np
import pytest

from bench_hw.capture.session_keys import TISSUES
from benchmark.errors import InputError
from benchmark.files import load_scenario, load_tissue, scenario_notes
from benchmark.files.shipped import find, said_of_name, shipped_scenarios, shipped_tissues


def test_what_ships():
    assert {"skin_forearm", "ecoflex_00_30", "dragon_skin_10", "rtv3498_sheet"} <= set(shipped_tissues())
    assert {"skin-5N", "paper", "phantom"} <= set(shipped_scenarios())
    assert all(entry.path.is_file() and entry.name == entry.path.stem for entry in shipped_tissues().values())


def test_a_name_means_what_ships():
    assert find("skin_forearm", "tissue") == shipped_tissues()["skin_forearm"].path


@pytest.mark.parametrize("text", ["mine.toml", "./mine", "a/b", "a\\b"])
def test_a_path_is_taken_as_one(text, tmp_path):
    assert find(text, "tissue", tmp_path) == tmp_path / text


def test_a_path_object_is_a_path_whatever_its_name():
    assert find(Path("skin_forearm"), "tissue") == Path("skin_forearm")


def test_what_the_folder_holds_under_a_shipped_name_is_taken_and_said(tmp_path, monkeypatch):
    """A session here won over the shipped one, a tissue here lost against it; neither was said."""
    monkeypatch.chdir(tmp_path)
    assert [said_of_name(*each) for each in (("skin_forearm", "tissue"), (Path("phantom"), "session"))] == ["", ""]
    Path("skin_forearm.toml").write_text("")
    assert "ships is taken; the file here is skin_forearm.toml" in said_of_name("skin_forearm", "tissue")
    assert find("skin_forearm", "tissue") == shipped_tissues()["skin_forearm"].path
    Path("skin_forearm").write_text("")
    Path("phantom").mkdir()
    assert find("skin_forearm", "tissue") == Path("skin_forearm")
    for name, what in (("skin_forearm", "tissue"), (Path("phantom"), "session")):
        assert f"{what} {name}: the one in this folder is taken" in said_of_name(name, what)


def test_a_plain_name_may_be_a_file(tmp_path):
    (tmp_path / "mine").write_text("")
    assert find("mine", "tissue", tmp_path) == tmp_path / "mine"


def test_a_name_without_its_ending_finds_the_file_that_was_meant(tmp_path):
    (tmp_path / "my skin.toml").touch()
    with pytest.raises(InputError, match=r"did you mean the file my skin\.toml\?"):
        find("my skin", "tissue", tmp_path)


def test_a_name_that_is_nothing_lists_the_nearest():
    with pytest.raises(InputError, match="did you mean skin_forearm"):
        find("skin_forarm", "tissue")
    with pytest.raises(InputError, match="known: compression, paper, phantom, skin-5N"):
        find("zzzz", "scenario")
    for odd in ("", ".", "x" * 400, "a\0b"):
        with pytest.raises(InputError):
            find(odd, "tissue")


SKINS = ("skin_forearm", "skin_mri_indentation", "skin_traction", "skin_porcine_fat")
SILICONES = {"ecoflex_00_10": 22e3, "ecoflex_00_30": 45e3, "ecoflex_00_50": 63e3, "dragon_skin_10": 139e3}


@pytest.mark.parametrize("name", shipped_tissues())
def test_a_tissue_is_named_like_its_file_and_cited(name):
    tissue = load_tissue(name)
    assert tissue.name == name
    assert "Assumed" in tissue.citation
    assert len(tissue.citation) > 40
    assert "\n" not in tissue.citation


@pytest.mark.parametrize("name", shipped_scenarios())
def test_a_scenario_is_named_like_its_file_and_has_nothing_odd(name):
    scenario = load_scenario(name)
    assert scenario.name == name
    assert scenario_notes(scenario) == ()


def test_there_are_skins_and_silicones():
    assert set(SKINS) | set(SILICONES) | {"rtv3498_sheet"} == set(shipped_tissues())


@pytest.mark.parametrize("name", SKINS)
def test_thickness_and_density_lie_in_the_published_ranges(name):
    for layer in load_tissue(name).layers:
        low, high, light, heavy = {
            "epidermis": (0.075e-3, 0.15e-3, 1110, 1190),
            "dermis": (1e-3, 4e-3, 1116, 1116),
            "cutis": (1.075e-3, 4.15e-3, 1116, 1190),
        }.get(layer.name, (0.0, 1.0, 971, 971))
        assert low <= layer.thickness <= high
        assert light <= layer.density <= heavy


def test_the_default_skin_has_the_published_moduli():
    skin = load_tissue("skin_forearm")
    assert skin.layer_names == ("epidermis", "dermis", "subcutaneous_fat")
    assert 1e6 <= skin.layer("epidermis").youngs_modulus <= 2e6
    assert skin.layer("dermis").youngs_modulus == pytest.approx(6 * 0.16e6, rel=1e-12)
    assert skin.layer("subcutaneous_fat").youngs_modulus == 47.8e3


@pytest.mark.parametrize(
    ("layer", "c10", "bulk"),
    [("epidermis", 0.12e6, 5.45e6), ("dermis", 1.11e6, 29.6e6), ("subcutaneous_fat", 420.0, 36e3)],
)
def test_the_indentation_set_has_the_papers_two_constants(layer, c10, bulk):
    found = load_tissue("skin_mri_indentation").layer(layer)
    assert found.shear_modulus == pytest.approx(2 * c10, rel=5e-4)
    assert found.youngs_modulus / (3 * (1 - 2 * found.poisson_ratio)) == pytest.approx(bulk, rel=5e-3)


def test_the_traction_set_has_the_papers_moduli():
    skin = load_tissue("skin_traction")
    assert [(layer.youngs_modulus, layer.poisson_ratio) for layer in skin.layers] == [(684e3, 0.48), (47.8e3, 0.30)]


def test_the_porcine_fat_has_the_papers_shear_modulus_and_relaxation():
    fat = load_tissue("skin_porcine_fat").layer("subcutaneous_fat")
    assert fat.shear_modulus == pytest.approx(530.0, rel=0.01)
    assert [(term.g, term.tau) for term in fat.relaxation] == [(0.39, 700.0)]


@pytest.mark.parametrize(("name", "modulus"), SILICONES.items())
def test_the_silicones(name, modulus):
    (silicone,) = load_tissue(name).layers
    assert silicone.youngs_modulus == modulus


def test_skin_5n_is_the_published_press():
    scenario = load_scenario("skin-5N")
    assert scenario.tissue == load_tissue("skin_forearm")
    assert (scenario.tool.radius, scenario.tool.contact) == (5e-3, "uniform_pressure")
    assert scenario.fem.kinematics == "finite"
    assert scenario.load_history().value.max() == 5.0
    assert len(scenario.load_history().time) == 100


def test_phantom_is_a_sheet_over_the_hole():
    scenario = load_scenario("phantom")
    assert (scenario.support.kind, scenario.support.hole_radius) == ("hole", 30e-3)
    assert (scenario.tool.radius, scenario.tool.contact) == (5e-3, "rigid_bonded")
    assert scenario.tissue.thickness == 4e-3


def test_paper_is_the_default_skin_stiffened_by_one_factor():
    paper, skin = load_scenario("paper"), load_tissue("skin_forearm")
    assert paper.fem.kinematics == "linear"
    factors = [a.youngs_modulus / b.youngs_modulus for a, b in zip(paper.tissue.layers, skin.layers, strict=True)]
    np.testing.assert_allclose(factors, factors[0], rtol=1e-6)
    for stiff, soft in zip(paper.tissue.layers, skin.layers, strict=True):
        assert stiff.model_copy(update={"youngs_modulus": soft.youngs_modulus}) == soft


def test_importing_the_package_builds_no_unit_registry():
    code = "import sys, benchmark.files; sys.exit('pint' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_the_bench_is_told_the_shipped_tissues():
    project = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text())["project"]
    (named,) = project["entry-points"][TISSUES].values()
    assert EntryPoint("benchmark", named, TISSUES).load()() == shipped_tissues()
