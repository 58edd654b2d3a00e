"""Writing a trial: the library's own reader finds every record; nothing is overwritten; errors last."""

import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from bench_hw.errors import TrialFileError
from bench_hw.trial_file import EventRecord, ForceRecord, PositionRecord, open_trial
from bench_hw.trial_file.encoding import encode, nanoseconds


def messages_of(path: Path):
    with path.open("rb") as file:
        return [(channel.topic, schema.name, message) for schema, channel, message in make_reader(file).iter_messages()]


@pytest.mark.parametrize("background", [False, True])
def test_the_librarys_reader_finds_every_record(make_records, record, background):
    records = make_records(1.0)
    found = messages_of(record(records, background=background))
    topics = {1: "/force", 2: "/depth", 3: "/camera", 4: "/events"}
    expected = [(topics[encode(r)[0]], nanoseconds(r.time), encode(r)[1]) for r in records]
    by_channel = sorted(expected, key=lambda item: item[1])
    assert sorted((topic, m.log_time, m.data) for topic, _, m in found) == sorted(by_channel)
    names = {topic: name for topic, name, _ in found}
    assert names == {
        "/force": "tissuebench.ForceTorque",
        "/depth": "tissuebench.Depth",
        "/camera": "foxglove.CompressedImage",
        "/events": "foxglove.Log",
    }
    force = [m.sequence for topic, _, m in found if topic == "/force"]
    assert force == list(range(1000))


def test_schemas_are_json_schemas_and_metadata_are_there(three_seconds):
    with three_seconds.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        for schema in reader.get_summary().schemas.values():
            assert schema.encoding == "jsonschema"
            assert json.loads(schema.data)["title"] == schema.name
        metadata = [item.metadata for item in reader.iter_metadata() if item.name == "tissuebench.trial"]
    assert metadata[0]["serial.force"] == "FT12345"
    assert metadata[0]["calibration.force"] == "sha256:00ff"
    assert metadata[0]["protocol"] == "paper"
    assert metadata[0]["started"] == "2024-05-06T07:08:09.123456+00:00"
    assert metadata[0]["clock_epoch_ns"] == "50000000000"
    assert metadata[0]["synthetic"] == "true"
    assert all(item == metadata[0] for item in metadata)


def test_no_chunk_holds_more_than_a_fifth_of_a_second(make_records, record):
    path = record(make_records(3.0, fps=0))
    with path.open("rb") as file:
        chunks = make_reader(file).get_summary().chunk_indexes
    assert len(chunks) >= 16
    for chunk in chunks:
        assert chunk.compression == "zstd"
        assert chunk.message_end_time - chunk.message_start_time < 200_000_000
        assert chunk.uncompressed_size < 80_000


def test_the_file_has_its_temporary_name_until_it_is_closed(header, tmp_path):
    writer = open_trial(tmp_path / "new" / "trial_002.mcap", header)
    part = tmp_path / "new" / "trial_002.mcap.part"
    assert writer.path == part
    assert part.exists()
    assert writer.close() == writer.path == tmp_path / "new" / "trial_002.mcap"
    assert writer.close() == writer.path
    assert [file.name for file in writer.path.parent.iterdir()] == ["trial_002.mcap"]


@pytest.mark.parametrize("existing", ["trial_001.mcap", "trial_001.mcap.part"])
def test_nothing_is_overwritten(header, tmp_path, existing):
    (tmp_path / existing).write_text("a measurement")
    with pytest.raises(TrialFileError, match=rf"{existing}: the file exists and is not overwritten"):
        open_trial(tmp_path / "trial_001.mcap", header)
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [(existing, "a measurement")]


def test_a_trial_that_appears_meanwhile_is_not_overwritten(header, tmp_path):
    writer = open_trial(tmp_path / "trial_001.mcap", header)
    (tmp_path / "trial_001.mcap").write_text("another")
    with pytest.raises(TrialFileError, match="has appeared meanwhile"):
        writer.close()
    assert (tmp_path / "trial_001.mcap").read_text() == "another"
    assert writer.path.name == "trial_001.mcap.part"


def test_another_ending_and_a_folder_that_is_a_file_are_refused(header, tmp_path):
    with pytest.raises(TrialFileError, match=r"is named NAME\.mcap"):
        open_trial(tmp_path / "trial.csv", header)
    (tmp_path / "file").write_text("")
    with pytest.raises(TrialFileError, match="cannot be created"):
        open_trial(tmp_path / "file" / "trial.mcap", header)
    assert [file.name for file in tmp_path.iterdir()] == ["file"]


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission_is_refused(header, tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(TrialFileError, match="Permission denied"):
        open_trial(tmp_path / "trial.mcap", header)


def test_the_file_is_closed_well_when_the_capture_fails(header, tmp_path):
    with pytest.raises(KeyboardInterrupt), open_trial(tmp_path / "trial.mcap", header) as writer:
        interrupted(writer)
    assert [m.data for _, _, m in messages_of(tmp_path / "trial.mcap")] == [
        encode(EventRecord(1.0, "interrupted", "Ctrl-C", "fault"))[1]
    ]


def interrupted(writer):
    writer.write_event(EventRecord(1.0, "interrupted", "Ctrl-C", "fault"))
    raise KeyboardInterrupt


def test_nothing_can_be_written_after_the_end(header, tmp_path):
    writer = open_trial(tmp_path / "trial.mcap", header)
    writer.close()
    with pytest.raises(TrialFileError, match="is closed"):
        writer.write_position(PositionRecord(1.0, 0.0))


@pytest.mark.parametrize("time", [-1e-9, float("nan"), float("inf"), 1e11])
def test_a_time_that_is_none_is_refused(header, tmp_path, time):
    with open_trial(tmp_path / "trial.mcap", header) as writer:
        with pytest.raises(TrialFileError, match="a record has the time"):
            writer.write_position(PositionRecord(time, 0.0))
        writer.write_position(PositionRecord(1.0, 0.0))
    assert len(messages_of(tmp_path / "trial.mcap")) == 1


@pytest.mark.parametrize("background", [False, True])
def test_records_may_come_from_several_threads(header, tmp_path, background):
    with open_trial(tmp_path / "trial.mcap", header, background) as writer:

        def write(thread: int) -> None:
            for number in range(500):
                writer.write_position(PositionRecord(1.0 + number * 1e-3, thread + number / 1000))

        threads = [threading.Thread(target=write, args=(thread,)) for thread in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    depths = sorted(json.loads(m.data)["depth"] for _, _, m in messages_of(tmp_path / "trial.mcap"))
    np.testing.assert_allclose(depths, sorted(t + n / 1000 for t in range(4) for n in range(500)))


FULL_DISK = """
import resource, signal, sys
from bench_hw.errors import TrialFileError
from bench_hw.trial_file import FrameRecord, TrialHeader, open_trial

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))
noise = open("/dev/urandom", "rb")
writer = open_trial(sys.argv[1], TrialHeader("t", "", 0.0), background=sys.argv[2] == "background")
written = 0
try:
    with writer:
        for number in range(100_000):
            writer.write_frame(FrameRecord(number * 0.01, number, noise.read(5000)))
            written += 1
            if written > 100:
                signal.sigtimedwait([], 0.01)
except TrialFileError as error:
    print(written, error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="needs resource limits of POSIX")
@pytest.mark.parametrize("mode", ["background", "foreground"])
def test_a_full_disk_ends_the_recording_and_destroys_nothing(tmp_path, mode):
    target = tmp_path / "trial.mcap"
    command = [sys.executable, "-c", FULL_DISK, str(target), mode]
    run = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    assert "cannot be written" in run.stdout
    assert "kept in this file" in run.stdout
    assert not target.exists()
    part = tmp_path / "trial.mcap.part"
    assert 100_000 < part.stat().st_size <= 200_000
    recovered = subprocess.run(
        [sys.executable, "-m", "bench_hw", "recover", str(part), "--out", str(tmp_path / "new.mcap"), "--json"],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    kept = json.loads(recovered.stdout)["kept"]["camera"]
    assert 20 < kept <= 40
    assert len(messages_of(tmp_path / "new.mcap")) == kept


def test_a_disk_that_is_full_from_the_start_leaves_no_file(header, tmp_path, monkeypatch):
    def refuse(handle, data):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "write", refuse)
    with pytest.raises(TrialFileError, match=r"cannot be created \(No space left on device\)"):
        open_trial(tmp_path / "trial.mcap", header)
    assert list(tmp_path.iterdir()) == []


def test_the_refusal_stays_once_the_disk_has_refused(header, tmp_path, monkeypatch):
    writer = open_trial(tmp_path / "trial.mcap", header, background=False)
    sample = ForceRecord(1.0, 1, 1, 0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    writer.write_force(sample)

    def refuse(handle, data):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "write", refuse)
        with pytest.raises(TrialFileError, match="No space left on device"):
            writer.write_position(PositionRecord(2.0, 0.0))
    with pytest.raises(TrialFileError, match="No space left on device"):
        writer.write_force(sample)
    with pytest.raises(TrialFileError, match="No space left on device"):
        writer.close()
    assert writer.path.name == "trial.mcap.part"
