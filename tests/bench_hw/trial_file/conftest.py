"""Trials to write, to spoil and to read: made of records whose values follow from their numbers."""

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import pytest

from bench_hw.trial_file import (
    EventRecord,
    ForceRecord,
    FrameRecord,
    PositionRecord,
    TrialHeader,
    open_trial,
)

EPOCH = 50.0
Record = ForceRecord | PositionRecord | FrameRecord | EventRecord


def force_record(number: int, time: float, press: float, status: int = 0) -> ForceRecord:
    sequence = (number + 1) % 2**32
    counts = (number, -number, round(-press * 1e6), 3, 4, 5)
    force, torque = (0.001 * number, -0.5, -press), (1e-6, 2e-6, 3e-6 * number)
    return ForceRecord(time, sequence, 7 * sequence % 2**32, status, force, torque, counts)


@pytest.fixture(scope="session")
def header() -> TrialHeader:
    return TrialHeader(
        name="trial_001",
        started="2024-05-06T07:08:09.123456+00:00",
        clock_epoch=EPOCH,
        press_axis="-z",
        protocol="paper",
        protocol_text='name = "paper"\n',
        serials={"force": "FT12345", "actuator": "A1"},
        calibrations={"force": "sha256:00ff"},
        settings={"force.rate": "1000 Hz", "µ": "0.3"},
        synthetic=True,
    )


@pytest.fixture(scope="session")
def make_records() -> Callable[..., list[Record]]:
    def make(seconds: float, force_rate: float = 1000, depth_rate: float = 100, fps: float = 30) -> list[Record]:
        """A press to 2 mm and 4 N at half time and back; pictures of random bytes."""
        random = np.random.default_rng(7)

        def press(time: float) -> float:
            return 1 - abs(2 * time / seconds - 1)

        records: list[Record] = [EventRecord(EPOCH, "segment", "begins")]
        for number in range(round(seconds * force_rate)):
            time = number / force_rate
            records.append(force_record(number, EPOCH + time, 4 * press(time)))
        for number in range(round(seconds * depth_rate) + 1):
            time = number / depth_rate
            records.append(PositionRecord(EPOCH + time, 2e-3 * press(time), number % 1024, 2e-3))
        for number in range(round(seconds * fps)):
            records.append(FrameRecord(EPOCH + number / fps, number, random.bytes(3000 + number)))
        return sorted(records, key=lambda record: record.time)

    return make


@pytest.fixture(scope="session")
def write_records(header: TrialHeader) -> Callable[..., Path]:
    """Write a trial of these records to a path."""
    methods = {
        ForceRecord: "write_force",
        PositionRecord: "write_position",
        FrameRecord: "write_frame",
        EventRecord: "write_event",
    }

    def write(path: Path, records: Iterable[Record], background: bool = False) -> Path:
        with open_trial(path, header, background) as writer:
            for item in records:
                getattr(writer, methods[type(item)])(item)
        return writer.path

    return write


@pytest.fixture
def record(write_records, tmp_path: Path) -> Callable[..., Path]:
    def write(records: Iterable[Record], name: str = "trial_001.mcap", background: bool = False) -> Path:
        return write_records(tmp_path / name, records, background)

    return write


@pytest.fixture(scope="session")
def three_seconds_once(make_records, write_records, tmp_path_factory) -> bytes:
    return write_records(tmp_path_factory.mktemp("trial") / "trial_001.mcap", make_records(3.0)).read_bytes()


@pytest.fixture
def three_seconds(three_seconds_once: bytes, tmp_path: Path) -> Path:
    path = tmp_path / "trial_001.mcap"
    path.write_bytes(three_seconds_once)
    return path
