"""Folders, patterns and single pictures."""

import os
import shutil
import sys

import cv2
import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.trial_file import FrameRecord, PositionRecord, TrialHeader, open_trial
from bench_hw.vision.frames.opening import VideoFrames, open_frames
from bench_hw.vision.frames.source import decode_grey, to_grey


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


def pictures(count: int = 12) -> list[np.ndarray]:
    random = np.random.default_rng(0)
    return [random.integers(0, 256, (48, 64), dtype=np.uint8) for _ in range(count)]


def test_a_lossless_video_gives_its_pictures_and_times(video):
    made = pictures()
    source = VideoFrames(video(made, rate=25.0))
    frames = list(source.frames())
    assert [frame.number for frame in frames] == list(range(12))
    assert np.allclose([frame.time for frame in frames], np.arange(12) / 25.0)
    assert all(np.array_equal(frame.grey, picture) for frame, picture in zip(frames, made, strict=True))
    assert (source.expected, source.rate, source.notes(), source.synthetic) == (12, 25.0, (), False)
    assert len(list(source.frames())) == 12


def test_colour_becomes_grey_and_the_rate_can_be_given(video):
    colour = [np.dstack([p, p, p]) for p in pictures()]
    source = VideoFrames(video(colour), rate=100.0)
    assert source.notes() == ("the video tells of 30 pictures a second; 100 as told are used",)
    assert VideoFrames(video(colour), rate=30.001).notes() == ()
    frames = list(source.frames())
    assert frames[0].grey.shape == (48, 64)
    assert np.abs(frames[0].grey.astype(int) - colour[0][:, :, 0]).max() <= 2
    assert frames[5].time == 0.05


@pytest.mark.parametrize(
    ("name", "codec", "said"),
    [("a.mp4", "mp4v", "FMP4"), ("a.webm", "VP80", "VP80"), ("a.avi", "MJPG", ""), ("a.mkv", "FFV1", "")],
)
def test_a_codec_that_keeps_differences_between_pictures_is_told(video, name, codec, said):
    notes = VideoFrames(video([np.dstack([p, p, p]) for p in pictures()], name, codec)).notes()
    assert [f"({said})" in note for note in notes if "picture to picture" in note] == [True] * bool(said)


def test_a_cut_video_gives_what_is_there_and_says_so(video):
    path = video(pictures(30))
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    source = VideoFrames(path)
    count = len(list(source.frames()))
    assert 0 < count < 30
    assert source.notes() == (f"the video ends after {count} of the 30 pictures it should have",)


@pytest.mark.skipif(sys.platform != "linux", reason="names are text there")
def test_a_video_whose_path_is_no_text_is_refused(tmp_path, video):
    folder = tmp_path / os.fsdecode(b"caf\xe9")
    folder.mkdir()
    shutil.copy(video(pictures()), folder / "film.avi")
    with pytest.raises(InputError, match="no text; rename it"):
        VideoFrames(folder / "film.avi")


def test_what_is_no_video_is_refused(tmp_path, video):
    empty, text = tmp_path / "empty.avi", tmp_path / "text.avi"
    empty.write_bytes(b"")
    text.write_text("no video at all\n" * 100)
    cut = video([np.dstack([p, p, p]) for p in pictures()], "cut.mp4", "mp4v")
    cut.write_bytes(cut.read_bytes()[:-400])
    for path in (empty, text, cut):
        with pytest.raises(InputError, match="no video that can be read"):
            VideoFrames(path)
    with pytest.raises(InputError, match="no such file"):
        VideoFrames(tmp_path / "none.avi")


def test_a_video_without_pictures_is_refused(video):
    source = VideoFrames(video([]))
    with pytest.raises(InputError, match="no picture that can be read"):
        list(source.frames())


EPOCH = 40.0


@pytest.fixture
def trial(tmp_path):
    """Write a trial of pictures that are all of one grey level each, at odd instants."""

    def write(count: int = 12, name: str = "trial_001.mcap", spoil=lambda number, data: data, times=None):
        header = TrialHeader("trial_001", "2024-05-06T07:08:09+00:00", EPOCH, synthetic=True)
        with open_trial(tmp_path / name, header, background=False) as writer:
            for number in range(count):
                time = EPOCH + (0.0333 * number + 0.001 * (number % 3) if times is None else times[number])
                data = cv2.imencode(".jpg", np.full((48, 64), 10 * number, np.uint8))[1].tobytes()
                writer.write_position(PositionRecord(time, 0.0))
                writer.write_frame(FrameRecord(time, number, spoil(number, data)))
        return tmp_path / name

    return write


def test_each_picture_has_the_cameras_own_time(trial):
    source = open_frames(str(trial()))
    frames = list(source.frames())
    assert [round(float(frame.grey.mean())) for frame in frames] == [10 * n for n in range(12)]
    assert np.allclose([frame.time for frame in frames], [0.0333 * n + 0.001 * (n % 3) for n in range(12)], atol=1e-9)
    assert (source.expected, source.rate, source.synthetic, source.notes()) == (12, None, True, ())


def test_a_broken_picture_is_given_as_such_and_a_late_one_is_left_out(trial):
    def spoil(number, data):
        return data[:200] if number == 3 else data

    times = [0.1 * n for n in range(12)]
    times[7] = times[5]
    source = open_frames(str(trial(spoil=spoil, times=times)))
    frames = list(source.frames())
    assert [frame.number for frame in frames] == [0, 1, 2, 3, 4, 5, 6, 8, 9, 10, 11]
    assert [frame.number for frame in frames if frame.grey is None] == [3]
    assert source.notes() == ("1 pictures are left out: their time does not increase",)


def test_a_cut_trial_gives_what_is_whole_and_says_so(trial):
    def noisy(number, data):
        picture = np.random.default_rng(number).integers(0, 255, (480, 640), dtype=np.uint8)
        return cv2.imencode(".jpg", picture)[1].tobytes()

    path = trial(count=10, spoil=noisy)
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])
    source = open_frames(str(path))
    assert 0 < len(list(source.frames())) < 10
    assert "the trial is not complete" in source.notes()[0]


def test_no_pictures_and_a_rate_for_a_trial_are_refused(trial, tmp_path):
    with pytest.raises(InputError, match="the trial has no pictures"):
        open_frames(str(trial(count=0)))
    with pytest.raises(InputError, match="a trial has the camera's own times"):
        open_frames(str(tmp_path / "trial_001.mcap"), 30.0)
    with pytest.raises(InputError, match="No such file"):
        open_frames(str(tmp_path / "none.mcap"))
