"""`track`: the table, the JSON, the refusals."""

import hashlib
import importlib.util
import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from bench_hw.tables import read_marker_csv
from bench_hw.trial_file import FrameRecord, TrialHeader, open_trial


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
def press():
    """Three pictures of a press, the scene, and the true places."""
    rendering = load("rendering")
    random = np.random.default_rng(6)
    scene = rendering.Scene(focal=640.0, distortion=rendering.PAPER_DISTORTION, origin=(2.0, -1.0))
    renderer = rendering.Renderer(scene, rendering.sheet(random), random)
    middles = [rendering.press(renderer.sheet, depth)[0] for depth in (0.0, 2.0, 4.0)]
    return scene, [renderer.frame(m) for m in middles], np.array([renderer.sheet.truth(m) for m in middles])


@pytest.fixture
def camera(press, tmp_path) -> Path:
    path = tmp_path / "camera.toml"
    path.write_text(press[0].camera_toml())
    return path


@pytest.fixture
def trial(press, camera, tmp_path) -> Path:
    """A synthetic trial of eight JPEG pictures at uneven instants; the fourth was lost by the camera."""
    own = {"camera": hashlib.sha256(camera.read_bytes()).hexdigest()}
    header = TrialHeader("trial_001", "2024-05-06T07:08:09+00:00", 5.0, calibrations=own, synthetic=True)
    with open_trial(tmp_path / "trial_001.mcap", header, background=False) as writer:
        for number in (0, 1, 2, 4, 5, 6, 7, 8):
            data = cv2.imencode(".jpg", press[1][number % 3], [cv2.IMWRITE_JPEG_QUALITY, 95])[1].tobytes()
            writer.write_frame(FrameRecord(5.0 + 0.0333 * number + 0.0007 * (number % 2), number, data))
    return writer.path


def test_a_trial_becomes_a_table_at_the_cameras_own_instants(run, press, camera, trial, tmp_path):
    out = tmp_path / "markers.csv"
    ran = run("track", trial, "--camera", camera, "--out", out, "--json")
    assert (ran.exit_code, ran.stderr) == (0, "")
    result = json.loads(ran.stdout)
    expected = {"schema": 1, "frames": 8, "markers": 18, "rows": 3, "columns": 6, "synthetic": True, "warnings": []}
    assert result | expected == result
    lines = out.read_text().splitlines()
    assert lines[0] == "time_s,marker,x_mm,y_mm,confidence"
    assert len(lines) == 1 + 8 * 18
    table = read_marker_csv(out)
    time = np.unique(table.time)
    assert time == pytest.approx([0.0333 * n + 0.0007 * (n % 2) for n in (0, 1, 2, 4, 5, 6, 7, 8)], abs=1e-9)
    places = np.stack([table.x, table.y], axis=1).reshape(8, 18, 2) * 1e3
    truth = press[2][[0, 1, 2, 1, 2, 0, 1, 2]]
    assert np.sqrt(((places - truth) ** 2).sum(axis=2).mean()) < 0.03 * press[0].mm_per_px


def test_another_camera_file_than_the_trial_s_own_is_told(run, press, camera, trial, tmp_path):
    other = tmp_path / "other.toml"
    other.write_text(replace(press[0], focal=672.0).camera_toml())
    ran = run("track", trial, "--camera", other, "--out", tmp_path / "markers.csv", "--json")
    assert ran.exit_code == 0
    assert "captured with another camera file than" in " ".join(json.loads(ran.stdout)["warnings"])


def test_the_text_names_what_was_written_and_says_synthetic(run, camera, trial, tmp_path):
    out = tmp_path / "markers.csv"
    ran = run("track", trial, "--camera", camera, "--out", out, "--method", "paper")
    assert ran.exit_code == 0
    assert f"{out}: 8 frames, 18 markers (3 x 6), 0 % missing, method paper, synthetic" in ran.stdout
    assert run("track", trial, "--camera", camera, "--out", out, "--quiet").stdout == ""


def test_overlay_and_still_are_written(run, camera, trial, tmp_path):
    overlay, still = tmp_path / "overlay.avi", tmp_path / "still.png"
    paths = ("--out", tmp_path / "markers.csv", "--overlay", overlay, "--still", still)
    ran = run("track", trial, "--camera", camera, *paths)
    assert ran.exit_code == 0
    assert cv2.VideoCapture(str(overlay), cv2.CAP_FFMPEG).get(cv2.CAP_PROP_FRAME_COUNT) == 8
    assert cv2.imread(str(still)).shape == (480, 640, 3)


def test_pictures_with_a_hidden_marker_have_empty_cells_and_a_warning(run, press, camera, tmp_path):
    folder = tmp_path / "frames"
    folder.mkdir()
    for number in range(3):
        grey = press[1][number].copy()
        if number == 1:
            grey[:, 230:] = 120
        cv2.imwrite(str(folder / f"{number}.png"), grey)
    out = tmp_path / "markers.csv"
    ran = run("track", folder, "--camera", camera, "--out", out, "--fps", 20)
    assert ran.exit_code == 0
    assert "sightings are missing" in ran.stderr
    rows = [line.split(",") for line in out.read_text().splitlines()[1:]]
    missing = [(float(time), int(marker)) for time, marker, x, y, _ in rows if x == y == ""]
    assert {time for time, _ in missing} == {0.05}
    assert {5, 11, 17} <= {marker for _, marker in missing}


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (("image_size = [640, 480]", "image_size = [320, 240]"), "allowed: 320 x 240, the camera file's image_size"),
        (("mm_per_px =", "# mm_per_px ="), "the camera has no mm_per_px"),
        (("fx =", "fz ="), "key matrix.fx: is missing; key matrix.fz: is unknown here"),
        (("schema = 1", "schema = 7"), "key schema"),
    ],
)
def test_a_wrong_camera_file_is_exit_two_and_one_paragraph(run, camera, trial, tmp_path, change, reason):
    camera.write_text(camera.read_text().replace(*change, 1))
    ran = run("track", trial, "--camera", camera, "--out", tmp_path / "markers.csv", "--json")
    assert (ran.exit_code, ran.stdout) == (2, "")
    assert reason in ran.stderr
    assert ran.stderr.count("\n") == 1
    assert not (tmp_path / "markers.csv").exists()


def test_other_wrong_use_is_exit_two(run, camera, trial, tmp_path):
    out = ("--out", tmp_path / "markers.csv")
    text = tmp_path / "text.avi"
    text.write_text("no video")
    for arguments, reason in (
        ((tmp_path / "none.avi", "--camera", camera, *out), "no such file"),
        ((text, "--camera", camera, *out), "no video that can be read"),
        ((trial, "--camera", tmp_path / "none.toml", *out), "cannot be read"),
        ((trial, "--camera", camera, *out, "--grid", "3"), "allowed is ROWSxCOLUMNS"),
        ((trial, "--camera", camera, *out, "--grid", "3x5"), "allowed: 15 markers, 3 x 5"),
        ((trial, "--camera", camera, *out, "--method", "best"), "allowed: subpixel, paper"),
        ((trial, "--camera", camera, *out, "--fps", "30"), "a trial has the camera's own times"),
    ):
        ran = run("track", *arguments)
        assert ran.exit_code == 2
        assert reason in ran.stderr
        assert ran.stderr.count("\n") == 1
    assert not (tmp_path / "markers.csv").exists()


def test_a_broken_video_prints_one_paragraph_and_nothing_of_ffmpegs(camera, press, tmp_path):
    path = tmp_path / "cut.mp4"
    writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter.fourcc(*"mp4v"), 30.0, (640, 480))
    for _ in range(5):
        writer.write(cv2.cvtColor(press[1][0], cv2.COLOR_GRAY2BGR))
    writer.release()
    path.write_bytes(path.read_bytes()[:-500])
    command = [sys.executable, "-m", "bench_hw", "track", path, "--camera", camera, "--out", tmp_path / "markers.csv"]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert ran.returncode == 2
    assert ran.stdout == ""
    assert ran.stderr.startswith("error: ")
    assert ran.stderr.count("\n") == 1
