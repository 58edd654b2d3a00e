"""Libraries that an installation may leave out: each has its extra, and who meets it missing is told which."""

import sys
import tomllib
from pathlib import Path

import pytest

from bench_hw.cli._report import report_unexpected
from bench_hw.errors import EXTRAS, refusal, system_words, what_is_missing

PYPROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
DISTRIBUTIONS = {"cv2": "opencv-python-headless", "vtkmodules": "pyvista"}


@pytest.mark.parametrize("module", EXTRAS)
def test_the_extra_has_it_and_the_core_has_not(module: str) -> None:
    name, extra = DISTRIBUTIONS.get(module, module), EXTRAS[module][1]
    assert any(each.startswith(name) for each in PYPROJECT["optional-dependencies"][extra])
    assert not any(each.startswith(name) for each in PYPROJECT["dependencies"])
    assert extra in PYPROJECT["optional-dependencies"]["all"][0]


def test_a_missing_library_is_an_error_of_the_installation(monkeypatch, capsys) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(ModuleNotFoundError) as caught:
        import cv2  # noqa: F401
    assert report_unexpected(caught.value, debug=False) == 2
    said = capsys.readouterr().err
    assert "tissuebench[camera]" in said
    assert len(said.splitlines()) == 1


def test_any_other_missing_module_is_a_fault(capsys) -> None:
    assert what_is_missing(ModuleNotFoundError("No module named 'fem.gone'", name="fem.gone")) is None
    assert report_unexpected(ModuleNotFoundError("gone", name="gone"), debug=False) == 70
    assert what_is_missing(ValueError()) is None


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("trials/.p.csv.000024c5.part", "trials/p.csv: Permission denied"),
        ("trials/.p.csv.000024c5.tmp", "trials/p.csv: Permission denied"),
        ("/d/.p.lock", "/d/p: Permission denied"),
        (b"/d/.p.lock", "/d/p: Permission denied"),
        (".bashrc", ".bashrc: Permission denied"),
        ("data.part", "data.part: Permission denied"),
        ("..", "..: Permission denied"),
        (None, "Permission denied"),
    ],
)
def test_a_refusal_of_the_system_names_the_file_as_a_person_did(name, said: str) -> None:
    assert system_words(PermissionError(13, "Permission denied", name)) == said


def test_a_ring_of_links_is_a_refusal_by_whatever_name(tmp_path) -> None:
    ring = tmp_path / "ring"
    ring.symlink_to("ring")
    with pytest.raises((RuntimeError, OSError)) as met:
        ring.resolve(strict=True)
    refused = refusal(met.value)
    assert refused is not None
    assert system_words(refused) == f"{ring}: Too many levels of symbolic links"
    assert refusal(RuntimeError("of another kind")) is None
    other = RuntimeError("met while another was told")
    other.__context__ = PermissionError(13, "Permission denied", "x")
    assert refusal(other) is None


def test_an_error_without_the_systems_words_keeps_its_own() -> None:
    assert system_words(OSError("the cable is out")) == "the cable is out"
