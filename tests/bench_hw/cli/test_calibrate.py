"""`calibrate`: the file, the JSON, the refusals."""

import importlib.util
import json
import sys
import tomllib
from pathlib import Path

import cv2
import numpy as np
import pytest


def load(name: str):
    """A renderer of the vision tests."""
    path = Path(__file__).parents[1] / "vision" / f"{name}.py"
    unique = f"vision_tests_{name}"
    if unique not in sys.modules:
        spec = importlib.util.spec_from_file_location(unique, path)
        sys.modules[unique] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[unique])
    return sys.modules[unique]


@pytest.fixture(scope="module")
def views(tmp_path_factory) -> list[Path]:
    boards = load("boards")
    random = np.random.default_rng(7)
    camera, folder = boards.BoardCamera(), tmp_path_factory.mktemp("views")
    paths = []
    for number, pose in enumerate(boards.poses(random, 20)):
        paths.append(folder / f"view_{number:02d}.png")
        cv2.imwrite(str(paths[-1]), boards.board(camera, pose, random))
    cv2.imwrite(str(folder / "ruler.png"), boards.ruler(camera, boards.Pose((0, 0, 0.1), (2, 1, 75.0)), random))
    return paths


def test_the_file_and_the_json_say_the_same(run, views, tmp_path):
    out = tmp_path / "camera.toml"
    plane = views[0].with_name("ruler.png")
    ran = run("calibrate", *views, "--corners", "9x6", "--square-mm", "8", "--plane", plane, "--out", out, "--json")
    assert (ran.exit_code, ran.stderr) == (0, "")
    result, tables = json.loads(ran.stdout), tomllib.loads(out.read_text())
    assert {key: result[key] for key in tables} == tables
    assert tables["matrix"]["fx"] == pytest.approx(620, abs=1.5)
    assert tables["distortion"]["k3"] == 0.0
    assert tables["plane"]["mm_per_px"] == pytest.approx(75 / 620, rel=1e-3)
    assert 0 < tables["plane"]["mm_per_px_std"] < 1e-3 * tables["plane"]["mm_per_px"]
    assert tables["quality"]["views"] == 20
    assert tables["quality"]["map_error_rms_px"] <= 0.05


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (("--corners", "9x6", "--square-mm", "8"), "too few views: 3 of 3"),
        (("--corners", "7x5", "--square-mm", "8"), "a board with 9x6 inner corners in 3"),
        (("--corners", "9", "--square-mm", "8"), "allowed is COLUMNSxROWS"),
        (("--corners", "9x6", "--square-mm", "0"), "squares of 0 mm"),
    ],
)
def test_a_refusal_is_exit_two_one_paragraph_and_no_file(run, views, tmp_path, options, reason):
    ran = run("calibrate", *views[:3], *options, "--out", tmp_path / "camera.toml")
    assert (ran.exit_code, ran.stdout) == (2, "")
    assert reason in ran.stderr
    assert ran.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_folder_stands_for_the_pictures_in_it(run, views, tmp_path):
    folder = tmp_path / "views"
    folder.mkdir()
    for path in views[:3]:
        (folder / path.name).write_bytes(path.read_bytes())
    (folder / "notes.txt").write_text("three views")
    arguments = ("--corners", "9x6", "--square-mm", "8", "--out", tmp_path / "camera.toml")
    assert "too few views: 3 of 3" in run("calibrate", folder, *arguments).stderr
    assert "too few views: 5 of 5" in run("calibrate", folder, *views[3:5], *arguments).stderr


def test_a_folder_without_pictures_is_said_to_have_none(run, tmp_path):
    ran = run("calibrate", tmp_path, "--corners", "9x6", "--square-mm", "8", "--out", tmp_path / "camera.toml")
    assert ran.exit_code == 2
    assert f"{tmp_path}: no pictures; allowed endings: .png" in ran.stderr


def test_a_missing_picture_is_named(run, tmp_path):
    ran = run("calibrate", tmp_path / "none.png", "--corners", "9x6", "--square-mm", "8", "--out", tmp_path / "c.toml")
    assert ran.exit_code == 2
    assert f"{tmp_path / 'none.png'}: cannot be read" in ran.stderr
