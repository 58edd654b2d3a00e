"""What is drawn."""

import cv2
import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.vision.markers.grid import Sighting
from bench_hw.vision.tracking.overlay import Still, draw, overlay_video

GREY = np.full((120, 160), 200, np.uint8)
REST = np.array([[40.0, 60.0], [100.0, 60.0]])


def sighting(offset: float = 3.0, hidden: bool = True) -> Sighting:
    seen = Sighting(REST / 100, REST + np.array([offset, 0.0]), np.array([8.0, 8.0]), np.ones(2))
    return seen.kept(np.array([True, not hidden]))


def test_markers_are_circled_and_missing_ones_crossed():
    drawn = draw(GREY, sighting(), REST).astype(int)
    green = (drawn[:, :, 1] - drawn[:, :, 2] > 60).nonzero()
    red = (drawn[:, :, 2] - drawn[:, :, 1] > 60).nonzero()
    assert np.abs(np.hypot(green[1] - 43, green[0] - 60) - 8).min() < 1
    assert 90 < red[1].mean() < 110
    assert (drawn[5:20, :30] != 200).any() != (draw(GREY, sighting(), REST, "label")[5:20, :30] != 200).any()


def test_the_video_appears_whole_or_not_at_all(tmp_path):
    path = tmp_path / "deep" / "overlay.avi"
    with overlay_video(path, 30.0, (160, 120)) as video:
        for _ in range(5):
            video.write(draw(GREY, sighting(), REST))
        assert not path.exists()
    opened = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG)
    assert opened.get(cv2.CAP_PROP_FRAME_COUNT) == 5
    with pytest.raises(ZeroDivisionError), overlay_video(tmp_path / "other.avi", None, (160, 120)):
        raise ZeroDivisionError
    assert [entry.name for entry in tmp_path.iterdir()] == ["deep"]
    assert [entry.name for entry in (tmp_path / "deep").iterdir()] == ["overlay.avi"]


def test_only_avi_and_png_are_written(tmp_path):
    with pytest.raises(InputError, match=r"\.avi"), overlay_video(tmp_path / "overlay.mp4", 30.0, (160, 120)):
        pass
    with pytest.raises(InputError, match=r"\.png"):
        Still(REST).write(tmp_path / "still.jpg")
    with overlay_video(None, 30.0, (160, 120)) as nothing:
        assert nothing is None


def test_the_still_is_the_picture_of_the_farthest_motion(tmp_path):
    still = Still(REST)
    for level, offset in ((50, 1.0), (90, 9.0), (130, 4.0)):
        still.offer(np.full_like(GREY, level), sighting(offset, hidden=False), "")
    still.offer(np.full_like(GREY, 170), sighting(30.0, hidden=True), "")
    picture = cv2.imread(str(still.write(tmp_path / "still.png")))
    assert picture[110, 5].tolist() == [90, 90, 90]
    with pytest.raises(InputError, match="no still"):
        Still(REST).write(tmp_path / "none.png")
