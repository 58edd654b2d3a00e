"""Picture files as a camera."""

import numpy as np
import pytest

from bench_hw.devices.images_camera import ImagesCamera
from bench_hw.errors import DeviceError
from bench_hw.simulated.camera_server import write_pictures


@pytest.fixture
def folder(tmp_path):
    write_pictures(tmp_path / "p", lambda t: np.full((32, 32), int(t), np.uint8), [10.0, 20.0, 30.0, 40.0])
    (tmp_path / "p" / "notes.txt").write_text("no picture")
    return tmp_path / "p"


def test_pictures_come_when_they_are_due_with_their_own_bytes(folder, clock):
    with ImagesCamera(folder, rate=10.0, clock=clock) as camera:
        assert camera.read() == []
        camera.start()
        assert [frame.number for frame in camera.read()] == [0]
        clock.sleep(0.25)
        frames = camera.read()
        clock.sleep(10.0)
        frames += camera.read()
        assert camera.read() == []
    assert [frame.number for frame in frames] == [1, 2, 3]
    assert [frame.time - 100.0 for frame in frames] == pytest.approx([0.1, 0.2, 0.3])
    assert frames[0].data == (folder / "frame_00002.png").read_bytes()
    assert frames[0].format == "png"
    assert camera.info.settings["pictures"] == "4"


def test_an_empty_or_missing_folder_is_refused(tmp_path):
    with pytest.raises(DeviceError, match="no picture in"):
        ImagesCamera(tmp_path).connect()
    with pytest.raises(DeviceError, match="is no folder"):
        ImagesCamera(tmp_path / "gone").connect()


def test_a_picture_that_vanishes_is_named(folder, clock):
    with ImagesCamera(folder, clock=clock) as camera:
        camera.start()
        (folder / "frame_00001.png").unlink()
        with pytest.raises(DeviceError, match=r"frame_00001\.png"):
            camera.read()
