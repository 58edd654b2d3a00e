"""Cut anywhere, flipped anywhere: recovery keeps what is whole and never invents a row."""

import contextlib
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from bench_hw.errors import TrialFileError
from bench_hw.trial_file.inspection import inspect_trial
from bench_hw.trial_file.mcap_records import CHUNK, frame_at
from bench_hw.trial_file.recovery import recover_trial
from bench_hw.trial_file.scan import scan_trial


def messages_of(path: Path) -> list[tuple[int, int, int, int, bytes]]:
    with path.open("rb") as file:
        found = make_reader(file, validate_crcs=True).iter_messages(log_time_order=False)
        return [(m.channel_id, m.sequence, m.log_time, m.publish_time, m.data) for _, _, m in found]


def is_subsequence(part: list, whole: list) -> bool:
    rest = iter(whole)
    return all(item in rest for item in part)


class Damaged:
    """A sound trial, its bytes, and what becomes of a spoilt copy in a folder."""

    def __init__(self, path: Path) -> None:
        self.folder = path.parent
        self.bytes = path.read_bytes()
        self.messages = messages_of(path)
        self.chunks = scan_trial(path).chunks
        self._runs = 0

    def spoilt(self, content: bytes) -> Path:
        self._runs += 1
        path = self.folder / f"spoilt_{self._runs}.mcap"
        path.write_bytes(content)
        return path

    def outcome(self, content: bytes) -> tuple[list, dict, dict]:
        """Recover and inspect: messages kept, the recovery and the inspection of the spoilt file."""
        path = self.spoilt(content)
        inspection = inspect_trial(path).to_dict()
        recovery = recover_trial(path, path.with_name(f"{path.stem}_new.mcap"))
        assert path.read_bytes() == content
        kept = messages_of(recovery.out)
        assert sum(recovery.kept.values()) == len(kept)
        after = inspect_trial(recovery.out).to_dict()
        assert after["complete"] == recovery.whole
        assert after["channels"] == inspection["channels"]
        return kept, recovery.to_dict(), inspection


@pytest.fixture(scope="module")
def sound(make_records, write_records, tmp_path_factory) -> Damaged:
    """Ten chunks at least, since none holds more than a fifth of a second."""
    return Damaged(write_records(tmp_path_factory.mktemp("sound") / "trial_001.mcap", make_records(2.0)))


def test_a_sound_file_is_whole_and_complete(sound):
    kept, recovery, inspection = sound.outcome(sound.bytes)
    assert kept == sound.messages
    assert (recovery["whole"], recovery["reason"], recovery["lost_bytes"]) == (True, "", 0)
    assert inspection["complete"]
    assert inspection["faults"] == []


def test_a_file_cut_between_any_two_chunks_keeps_all_before(sound):
    for number, chunk in enumerate(sound.chunks[:: len(sound.chunks) // 8 + 1]):
        if number == 0:
            continue
        kept, recovery, inspection = sound.outcome(sound.bytes[: chunk.start])
        assert kept == sound.messages[: len(kept)]
        assert not recovery["whole"]
        assert "stops without its end" in recovery["reason"]
        assert not inspection["complete"]


@pytest.mark.parametrize("seed", range(24))
def test_a_file_cut_anywhere_keeps_a_beginning(sound, seed):
    size = int(np.random.default_rng(seed).integers(sound.chunks[1].start, len(sound.bytes)))
    kept, recovery, inspection = sound.outcome(sound.bytes[:size])
    whole_chunks = sum(chunk.end <= size for chunk in sound.chunks)
    assert kept == sound.messages[: len(kept)]
    assert scan_trial(sound.spoilt(sound.bytes[:size])).chunks == sound.chunks[:whole_chunks]
    assert not inspection["complete"]
    assert recovery["whole"] == (len(kept) == len(sound.messages) and recovery["lost_bytes"] == 0)


def test_a_file_cut_in_its_summary_has_lost_nothing(sound):
    kept, recovery, inspection = sound.outcome(sound.bytes[:-20])
    assert kept == sound.messages
    assert (recovery["whole"], recovery["lost_bytes"]) == (True, 0)
    assert "summary" in recovery["reason"]
    assert not inspection["complete"]


@pytest.mark.parametrize("size", [0, 1, 7, 8, 9, 60])
def test_a_file_cut_before_its_first_chunk_is_refused_or_empty(sound, size):
    path = sound.spoilt(sound.bytes[:size])
    with pytest.raises(TrialFileError, match=r"empty|nothing"):
        recover_trial(path, path.with_name("new.mcap"))
    assert not path.with_name("new.mcap").exists()


@pytest.mark.parametrize("inside", [True, False], ids=["in a chunk", "beside the chunks"])
@pytest.mark.parametrize("seed", range(24))
def test_a_flipped_byte_never_goes_unseen_and_never_makes_a_row(sound, seed, inside):
    random = np.random.default_rng(seed)
    in_chunk = np.zeros(len(sound.bytes), dtype=bool)
    for chunk in sound.chunks:
        in_chunk[chunk.start : chunk.end] = True
    place = int(random.choice(np.flatnonzero(in_chunk == inside)))
    content = bytearray(sound.bytes)
    content[place] ^= int(random.integers(1, 256))
    kept, recovery, inspection = sound.outcome(bytes(content))
    assert is_subsequence(kept, sound.messages)
    assert not inspection["complete"]
    assert inspection["faults"]
    assert recovery["whole"] == (kept == sound.messages)
    hit = [chunk for chunk in sound.chunks if chunk.start <= place < chunk.end]
    assert len(scan_trial(sound.spoilt(bytes(content))).chunks) >= len(sound.chunks) - len(hit)


def test_every_byte_of_the_head_of_a_chunk_may_be_flipped(sound):
    chunk = sound.chunks[5]
    for place in range(chunk.start, chunk.start + 60):
        content = bytearray(sound.bytes)
        content[place] ^= 0xFF
        path = sound.spoilt(bytes(content))
        scan = scan_trial(path)
        assert len(scan.chunks) >= len(sound.chunks) - 1, place
        assert not scan.complete, place
        path.unlink()


def test_chunks_after_a_damaged_one_are_kept(sound):
    for number in (0, 1, len(sound.chunks) // 2, len(sound.chunks) - 1):
        chunk = sound.chunks[number]
        content = bytearray(sound.bytes)
        content[chunk.end - 30] ^= 0x55
        kept, recovery, _ = sound.outcome(bytes(content))
        assert is_subsequence(kept, sound.messages)
        assert 0 < len(sound.messages) - len(kept) < 400
        assert not recovery["whole"]
        assert recovery["lost_bytes"] == chunk.end - chunk.start
        assert f"bytes {chunk.start} to {chunk.end}: damaged chunk" in recovery["reason"]


def test_a_chunk_whose_lengths_reach_over_the_next_ones_does_not_take_them_along(sound):
    """Both lengths changed alike: zstd alone would not notice what follows its data."""
    chunk, last = sound.chunks[4], sound.chunks[7]
    content = bytearray(sound.bytes)
    reach = last.end - chunk.end
    for place in (chunk.start + 1, chunk.start + 45):
        length = int.from_bytes(content[place : place + 8], "little") + reach
        content[place : place + 8] = length.to_bytes(8, "little")
    assert frame_at(bytes(content), chunk.start).end == last.end
    kept, _, _ = sound.outcome(bytes(content))
    scan = scan_trial(sound.spoilt(bytes(content)))
    assert [found.start for found in scan.chunks] == [c.start for c in sound.chunks if c is not chunk]
    assert is_subsequence(kept, sound.messages)


def test_a_flipped_letter_in_the_metadata_is_never_believed(sound):
    first = sound.bytes.index(b"FT12345")
    assert first < sound.chunks[0].start
    content = sound.bytes.replace(b"FT12345", b"FT12346", 1)
    _, recovery, inspection = sound.outcome(content)
    assert recovery["whole"]
    assert inspection["trial"]["serials"]["force"] == "FT12345"
    assert "metadata that do not fit their checksum" in inspection["faults"][0]
    _, _, inspection = sound.outcome(content[: sound.chunks[6].end])
    assert inspection["trial"] == {}
    assert "no copy of the trial's metadata is whole" in inspection["faults"]
    assert inspection["channels"]["force"]["drift_N"] is None


def test_a_hole_of_zeros_is_never_read_as_rows(sound):
    chunks = sound.chunks
    content = bytearray(sound.bytes)
    content[chunks[2].start + 20 : chunks[5].start + 20] = bytes(chunks[5].start - chunks[2].start)
    kept, recovery, inspection = sound.outcome(bytes(content))
    assert is_subsequence(kept, sound.messages)
    assert kept[-1] == sound.messages[-1]
    assert inspection["channels"]["force"]["lost"] > 0
    assert inspection["channels"]["force"]["gaps"] == 1
    assert not recovery["whole"]


def test_the_first_chunk_with_its_definitions_may_be_lost_also_without_a_summary(sound):
    first = sound.chunks[0]
    content = bytearray(sound.bytes[: sound.chunks[-2].end])
    content[first.end - 30] ^= 0x55
    kept, recovery, inspection = sound.outcome(bytes(content))
    assert is_subsequence(kept, sound.messages)
    assert set(recovery["kept"]) == {"force", "depth", "camera"}
    assert inspection["trial"]["serials"] == {"force": "FT12345", "actuator": "A1"}


def test_a_broken_beginning_is_passed_over(sound):
    content = b"\0" * 600 + sound.bytes[600:]
    kept, recovery, inspection = sound.outcome(content)
    assert kept[-1] == sound.messages[-1]
    assert len(kept) >= len(sound.messages) - 400
    assert "does not begin as a trial file" in recovery["reason"]
    assert inspection["trial"]["name"] == "trial_001"


def test_a_piece_from_the_middle_of_a_file_is_read(sound):
    start, end = sound.chunks[3].start - 100, sound.chunks[8].end + 50
    path = sound.spoilt(sound.bytes[start:end])
    with pytest.raises(TrialFileError, match="definition is lost"):
        recover_trial(path, path.with_name("new.mcap"))
    scan = scan_trial(path)
    assert len(scan.chunks) == 6
    assert not scan.whole


def test_garbage_is_no_trial(tmp_path):
    random = np.random.default_rng(1)
    for size in (1, 50, 5000):
        path = tmp_path / f"{size}.mcap"
        path.write_bytes(random.bytes(size))
        with pytest.raises(TrialFileError, match="nothing in this file is a trial"):
            inspect_trial(path)


def test_many_flipped_bytes_end_in_a_result_or_a_refusal(sound):
    random = np.random.default_rng(5)
    for _ in range(30):
        content = np.frombuffer(sound.bytes, dtype=np.uint8).copy()
        places = random.integers(0, len(content), size=int(random.integers(2, 400)))
        content[places] ^= random.integers(1, 256, size=len(places)).astype(np.uint8)
        path = sound.spoilt(content.tobytes())
        with contextlib.suppress(TrialFileError):
            recovery = recover_trial(path, path.with_name(f"{path.stem}_new.mcap"))
            assert is_subsequence(messages_of(recovery.out), sound.messages)
            assert not inspect_trial(path).complete
        path.unlink()


def test_a_frame_is_a_chunk_if_it_is_one_inside(sound):
    chunk = sound.chunks[3]
    for place in range(chunk.start, chunk.start + 9):
        content = bytearray(sound.bytes)
        content[place] ^= 0x11
        frame = frame_at(bytes(content), chunk.start)
        assert (frame.opcode, frame.end, frame.sound) == (CHUNK, chunk.end, False)
