"""From pictures to a camera file."""

import tomllib

import cv2
import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.vision.calibration import CalibrationOrder, calibrate
from bench_hw.vision.calibration.fit import all_pixels, map_difference
from bench_hw.vision.camera import read_camera


@pytest.fixture(scope="module")
def views(boards, lens, tmp_path_factory):
    """Twenty-one sharp views and a blurred one."""
    random = np.random.default_rng(4)
    folder = tmp_path_factory.mktemp("views")
    paths = []
    for number, pose in enumerate(boards.poses(random, 22)):
        paths.append(folder / f"view_{number:02d}.png")
        cv2.imwrite(str(paths[-1]), boards.board(lens, pose, random, blur=9.0 if number == 5 else None))
    return paths


@pytest.fixture(scope="module")
def plane(boards, lens, tmp_path_factory):
    path = tmp_path_factory.mktemp("plane") / "plane.png"
    cv2.imwrite(str(path), boards.board(lens, boards.Pose((0, 0, 0.05), (2.0, 1.0, 80.0)), np.random.default_rng(0)))
    return path


def test_twenty_one_views_give_the_camera(views, plane, board, true_camera, tmp_path):
    seen = []
    order = CalibrationOrder(tuple(views), board, tmp_path / "camera.toml", plane)
    outcome = calibrate(order, lambda done, total: seen.append((done, total)))
    camera = read_camera(order.out)
    assert map_difference(camera, true_camera, all_pixels(camera.size)) <= 0.05
    assert camera.quality.map_error_rms <= 0.05
    assert camera.quality.views == 21
    assert camera.distortion[4] == 0.0
    assert camera.plane.scale == pytest.approx(80e-3 / 620, rel=1e-3)
    assert camera.plane.origin == camera.centre
    assert len(outcome.warnings) == 1
    assert outcome.warnings[0].startswith(f"left out: blurred in 1, such as {views[5]} (edges ")
    assert seen[-1] == (22, 22)
    assert "# standard deviations: fx " in order.out.read_text()
    tables = outcome.to_dict()
    assert tables["deviations"]["fx"] > 0
    assert tables["invertible"] == {"fraction": 1.0, "nearest_px": None}
    assert set(tomllib.loads(order.out.read_text())) == {
        "schema",
        "image_size",
        "matrix",
        "distortion",
        "plane",
        "quality",
    }


@pytest.mark.parametrize(("text", "place"), [("plane", None), ("100.5,200.25", (100.5, 200.25))])
def test_the_origin_can_be_chosen(boards, lens, board, true_camera, plane, text, place):
    from bench_hw.vision.calibration.camera_calibration import _origin
    from bench_hw.vision.calibration.scale import measure_plane

    scale = measure_plane(plane, board, true_camera, 1e-3)
    assert _origin(text, true_camera, scale) == (scale.middle if place is None else place)
    with pytest.raises(InputError, match="allowed are axis, plane, or X,Y"):
        _origin("there", true_camera, scale)


@pytest.mark.parametrize("origin", ["nan,nan", "inf,1", "1e999,1", "1e6,0", "1", ",", "1,2,3"])
def test_an_origin_that_cannot_be_read_again_is_refused_before_anything_else(views, board, tmp_path, origin):
    with pytest.raises(InputError, match="allowed are axis, plane, or X,Y in undistorted pixels, each from -100000 to"):
        calibrate(CalibrationOrder(tuple(views[:1]), board, tmp_path / "camera.toml", origin=origin))
    assert not (tmp_path / "camera.toml").exists()


def test_too_few_views_and_mixed_sizes_leave_no_file(views, board, tmp_path):
    order = CalibrationOrder(tuple(views[:4]), board, tmp_path / "camera.toml")
    with pytest.raises(InputError, match="4 of 4 pictures"):
        calibrate(order)
    small = tmp_path / "small.png"
    cv2.imwrite(str(small), np.zeros((400, 640), np.uint8))
    with pytest.raises(InputError, match="640 x 400 pixels; allowed: 640 x 480"):
        calibrate(CalibrationOrder((views[0], small), board, tmp_path / "camera.toml"))
    with pytest.raises(InputError, match="no pictures"):
        calibrate(CalibrationOrder((), board, tmp_path / "camera.toml"))
    assert [path.name for path in tmp_path.iterdir()] == ["small.png"]
