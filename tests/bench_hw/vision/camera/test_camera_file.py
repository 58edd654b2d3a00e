"""`camera.toml` out and in again, and what is refused."""

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.errors import InputError
from bench_hw.vision.camera import Camera, Plane, Quality, read_camera, write_camera
from bench_hw.vision.camera.camera_file import camera_tables

FULL = Camera(
    (640, 480),
    (581.25, 582.5),
    (321.0, 238.0),
    (0.07, -0.48, -0.01, -0.01, 0.0),
    Plane(0.12e-3, 1e-8, (321.5, 237.25)),
    Quality(24, 0.09, 0.012),
)


def test_the_keys_are_those_of_the_contract(tmp_path):
    tables = tomllib.loads(write_camera(tmp_path / "camera.toml", FULL, {"note": "x"}).read_text())
    assert tables["schema"] == 1
    assert tables["image_size"] == [640, 480]
    assert tables["matrix"] == {"fx": 581.25, "fy": 582.5, "cx": 321.0, "cy": 238.0}
    assert tables["distortion"] == {"k1": 0.07, "k2": -0.48, "p1": -0.01, "p2": -0.01, "k3": 0.0}
    assert tables["plane"] == {"mm_per_px": 0.12, "mm_per_px_std": 1e-5, "origin_px": [321.5, 237.25]}
    assert tables["quality"] == {"views": 24, "reprojection_rms_px": 0.09, "map_error_rms_px": 0.012}


def test_it_reads_back_the_same(tmp_path):
    bare = Camera(FULL.size, FULL.focal, FULL.centre, FULL.distortion)
    for camera in (FULL, bare):
        read = read_camera(write_camera(tmp_path / "camera.toml", camera))
        assert camera_tables(read) == camera_tables(camera)
        assert (read.plane is None) == (camera.plane is None)


finite = st.floats(allow_nan=False, allow_infinity=False, width=64)


@given(st.tuples(finite, finite, finite, finite, finite))
def test_every_number_is_kept_to_the_last_bit(tmp_path_factory, distortion):
    camera = Camera(FULL.size, FULL.focal, FULL.centre, distortion)
    path = tmp_path_factory.mktemp("camera") / "camera.toml"
    assert read_camera(write_camera(path, camera)).distortion == distortion


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("schema = 1", "schema = 2", "schema"),
        ("fx = 581.25", "fx = -1.0", "matrix.fx"),
        ("fx = 581.25", "fx = nan", "matrix.fx"),
        ("cy = 238.0", "", "matrix.cy: is missing"),
        ("k1 = 0.07", "k1 = 0.07\nk4 = 0.1", "distortion.k4: is unknown here"),
        ("640", "640.5", "image_size"),
        ("mm_per_px = 0.12", "mm_per_px = 0.0", "plane.mm_per_px"),
        ("[plane]", "[plane", "not a TOML file"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, old, new, reason):
    path = write_camera(tmp_path / "camera.toml", FULL)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError) as refused:
        read_camera(path)
    assert reason in str(refused.value)
    assert str(path) in str(refused.value)


def test_a_plane_without_a_scale_is_no_plane(tmp_path):
    path = write_camera(tmp_path / "camera.toml", FULL)
    path.write_text(path.read_text().replace("mm_per_px = 0.12\n", ""))
    assert read_camera(path).plane is None
    with pytest.raises(InputError, match="No such file"):
        read_camera(tmp_path / "none.toml")
