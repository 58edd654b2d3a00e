"""Videos, whole and broken."""

import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.vision.frames.video import VideoFrames


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
    frames = list(source.frames())
    assert frames[0].grey.shape == (48, 64)
    assert np.abs(frames[0].grey.astype(int) - colour[0][:, :, 0]).max() <= 2
    assert frames[5].time == 0.05


def test_a_cut_video_gives_what_is_there_and_says_so(video):
    path = video(pictures(30))
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    source = VideoFrames(path)
    count = len(list(source.frames()))
    assert 0 < count < 30
    assert source.notes() == (f"the video ends after {count} of the 30 pictures it should have",)


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
