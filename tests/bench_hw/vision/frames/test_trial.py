"""The pictures of a native trial."""

import cv2
import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.trial_file import DepthRecord, FrameRecord, TrialHeader, open_trial
from bench_hw.vision.frames.opening import open_frames

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
                writer.write_depth(DepthRecord(time, 0.0))
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
