"""A trial followed while it is recorded."""

import numpy as np
import pytest

from bench_hw.errors import TrialFileError
from bench_hw.trial_file import ForceRecord, FrameRecord, PositionRecord, TrialHeader, following, open_trial
from bench_hw.trial_file.following import TrialFollower
from bench_hw.trial_file.records import EventRecord


@pytest.fixture
def begin(tmp_path):
    def open_one(name="trial_001"):
        header = TrialHeader(name, "2024-05-06T07:08:09+00:00", 10.0, "-z", "press")
        return open_trial(tmp_path / f"{name}.mcap", header, background=False)

    return open_one


def record(writer, first, last, picture=b"x"):
    """Samples `first` to `last` of a millisecond, flushed as 0.2 s of clock would."""
    for n in range(first, last):
        time = 10.0 + n / 1000
        writer.write_force(ForceRecord(time, n, n, 0, (0.0, 0.0, -1e-3 * n), (0.0, 0.0, 0.0)))
        if n % 10 == 0:
            writer.write_position(PositionRecord(time, 1e-6 * n))
        if n % 50 == 0:
            writer.write_frame(FrameRecord(time, n // 50, picture))
    writer._chunks.flush()


def test_each_look_gives_what_came_since_the_last(begin, tmp_path):
    follower = TrialFollower(tmp_path)
    assert follower.look() is None
    with begin() as writer:
        record(writer, 0, 100)
        first = follower.look()
        assert (first.name, first.header.protocol, len(first.force), len(first.depth)) == (
            "trial_001.mcap",
            "press",
            100,
            10,
        )
        assert first.force[10].time == pytest.approx(0.010)
        assert first.press()[10] == pytest.approx(0.010)
        assert not follower.look().force
        writer.write_event(EventRecord(10.15, "segment", "2 of 5: approach"))
        record(writer, 100, 300)
        second = follower.look()
        assert [sample.rdt_sequence for sample in second.force] == list(range(100, 300))
        assert [frame.frame for frame in second.frames] == [2, 3, 4, 5]
        assert second.events[0].message == "2 of 5: approach"
        record(writer, 300, 320)
    last = follower.look()
    assert last.ended
    assert len(last.force) == 20


def test_one_trial_after_the_other(begin, tmp_path):
    follower = TrialFollower(tmp_path)
    for name in ("trial_001", "trial_002"):
        with begin(name) as writer:
            record(writer, 0, 50)
            assert follower.look().name == f"{name}.mcap"
        while (news := follower.look()) is not None:
            assert news.ended
    assert follower.look() is None


def test_what_is_not_whole_is_left_for_the_next_look(begin, tmp_path):
    with begin() as writer:
        record(writer, 0, 100)
        record(writer, 100, 200)
    whole = (tmp_path / "trial_001.mcap").read_bytes()
    (tmp_path / "cut").mkdir()
    growing = tmp_path / "cut" / "trial_001.mcap.part"
    follower, seen = TrialFollower(growing), []
    for end in range(1, len(whole), 997):
        growing.write_bytes(whole[:end])
        news = follower.look()
        seen += [sample.rdt_sequence for sample in news.force]
    assert seen == list(range(200))


def test_damage_is_passed_over(begin, tmp_path):
    with begin() as writer:
        record(writer, 0, 100)
        at = writer._file.tell()
        record(writer, 100, 200)
        record(writer, 200, 300)
    content = bytearray((tmp_path / "trial_001.mcap").read_bytes())
    content[at + 200] ^= 0xFF
    (tmp_path / "trial_002.mcap.part").write_bytes(content)
    news = TrialFollower(tmp_path).look()
    assert [sample.rdt_sequence for sample in news.force] == [*range(100), *range(200, 300)]


def test_a_watcher_that_comes_late_begins_near_the_end(begin, tmp_path, monkeypatch):
    monkeypatch.setattr(following, "LARGEST_LOOK", 100_000)
    noise = np.random.default_rng(0).bytes(30_000)
    with begin() as writer:
        for k in range(9):
            record(writer, 50 * k, 50 * k + 50, noise)
        news = TrialFollower(tmp_path).look()
    assert news.header.protocol == "press"
    assert news.force[0].rdt_sequence > 0
    assert news.force[-1].rdt_sequence == 449


@pytest.mark.parametrize("name", ["missing/session", "film.avi", "there.txt"])
def test_what_cannot_be_watched_is_refused(tmp_path, name):
    (tmp_path / "there.txt").touch()
    with pytest.raises(TrialFileError, match="no such folder and no trial"):
        TrialFollower(tmp_path / name)


def test_a_session_that_capture_is_still_to_make_is_waited_for(tmp_path):
    follower = TrialFollower(tmp_path / "session")
    assert follower.look() is None
    (tmp_path / "session").mkdir()
    header = TrialHeader("trial_001", "2024-05-06T07:08:09+00:00", 10.0, "-z", "press")
    with open_trial(tmp_path / "session" / "trial_001.mcap", header, background=False) as writer:
        record(writer, 0, 100)
        assert len(follower.look().force) == 100
