"""Folders, patterns and single pictures."""

import cv2
import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.vision.frames.decoding import decode_grey, to_grey
from bench_hw.vision.frames.opening import open_frames


@pytest.fixture
def folder(tmp_path):
    for number in range(12):
        cv2.imwrite(str(tmp_path / f"frame_{number}.png"), np.full((20, 30), number, np.uint8))
    (tmp_path / "notes.txt").write_text("not a picture")
    return tmp_path


@pytest.mark.parametrize("pattern", ["", "/*.png", "/frame_%d.png", "/frame_?.png"])
def test_they_come_in_the_order_of_their_numbers(folder, pattern):
    frames = list(open_frames(f"{folder}{pattern}", 10.0).frames())
    count = 10 if "?" in pattern else 12
    assert [int(frame.grey[0, 0]) for frame in frames] == list(range(count))
    assert np.allclose([frame.time for frame in frames], np.arange(count) / 10)


def test_a_rate_nobody_gave_is_noted(folder):
    source = open_frames(str(folder / "frame_3.png"))
    assert len(list(source.frames())) == 1
    assert "30 pictures a second are assumed" in source.notes()[0]
    assert open_frames(str(folder), 5.0).notes() == ()


def test_a_picture_that_cannot_be_decoded_is_given_as_such(folder):
    whole = (folder / "frame_4.png").read_bytes()
    (folder / "frame_4.png").write_bytes(whole[:-20])
    (folder / "frame_5.png").write_bytes(b"")
    greys = [frame.grey for frame in open_frames(str(folder)).frames()]
    assert [number for number, grey in enumerate(greys) if grey is None] == [4, 5]


def test_no_pictures_is_refused(tmp_path):
    for place in (tmp_path, tmp_path / "*.png", tmp_path / "none.png"):
        with pytest.raises(InputError, match="no pictures"):
            open_frames(str(place))


def test_a_jpeg_without_its_end_is_no_picture():
    """libjpeg would give it with its lower part grey."""
    grey = np.random.default_rng(0).integers(0, 255, (40, 60), dtype=np.uint8)
    data = cv2.imencode(".jpg", grey)[1].tobytes()
    assert decode_grey(data, "jpeg").shape == (40, 60)
    assert decode_grey(data + b"\0\0", "jpeg") is not None
    assert decode_grey(data[: len(data) // 2], "jpeg") is None
    assert decode_grey(b"\xff\xd8nonsense\xff\xd9", "jpeg") is None


def test_any_number_of_channels_becomes_one():
    grey = np.arange(12, dtype=np.uint8).reshape(3, 4)
    for picture in (grey, grey[:, :, None], np.dstack([grey] * 3), np.dstack([grey] * 4)):
        assert np.array_equal(to_grey(picture), grey)
