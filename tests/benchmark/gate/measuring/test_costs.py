"""What a slice costs: computing and waiting, not other programs' turns."""

import time
from pathlib import Path

import pytest

from benchmark.gate.measuring.costs import QUEUE, ClockReading, CostClock

MS = 1_000_000


@pytest.fixture
def queue(tmp_path: Path) -> Path:
    path = tmp_path / "schedstat"
    path.write_text("123456 7000000 8\n")
    return path


@pytest.mark.parametrize(
    ("wall", "cpu", "queued", "milliseconds"),
    [
        (10, 10, 0, 10),  # undisturbed
        (30, 10, 20, 10),  # waited for a core
        (30, 10, 0, 30),  # slept, or waited for a disk
        (30, 10, 15, 15),  # both
        (10, 19, 0, 19),  # two threads
    ],
)
def test_cost(queue: Path, wall: int, cpu: int, queued: int, milliseconds: int) -> None:
    with CostClock(queue) as clock:
        before, after = (
            ClockReading(5 * MS, 3 * MS, 7 * MS),
            ClockReading((5 + wall) * MS, (3 + cpu) * MS, (7 + queued) * MS),
        )
        assert clock.seconds(before, after) == pytest.approx(1e-3 * milliseconds)


def test_the_queue_is_read_anew_each_time(queue: Path) -> None:
    with CostClock(queue) as clock:
        assert clock.read().queued == 7 * MS
        queue.write_text("123456 9000000 8\n")
        assert clock.read().queued == 9 * MS


@pytest.mark.parametrize("text", [None, "", "1", "1 - 3"])
def test_where_the_system_does_not_tell_it_is_cpu_time(tmp_path: Path, text: str | None) -> None:
    path = tmp_path / "schedstat"
    if text is not None:
        path.write_text(text)
    with CostClock(path) as clock:
        assert not clock.sees_waiting
        assert clock.seconds(ClockReading(0, 0, 0), ClockReading(30 * MS, 10 * MS, 0)) == pytest.approx(10e-3)


@pytest.mark.skipif(not QUEUE.is_file(), reason="this system has no schedstat")
def test_sleep_counts() -> None:
    with CostClock() as clock:
        before = clock.read()
        time.sleep(0.02)
        assert clock.seconds(before, clock.read()) >= 0.019
