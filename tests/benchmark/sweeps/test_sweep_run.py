import pytest

from benchmark.sweeps.point import PointResult, failed
from benchmark.sweeps.sweep_run import SweepProgress


def test_the_estimate_rests_on_what_this_command_did() -> None:
    now, said = [100.0], []
    progress = SweepProgress(10, 4, lambda *words: said.append(words), clock=lambda: now[0])
    for point in (5, 6):
        now[0] += 30.0
        progress.add(PointResult(point, "ok"))
    assert progress.remaining() == pytest.approx(120.0)
    assert said == [("points", 5, 10, "2 min left"), ("points", 6, 10, "2 min left")]


def test_failures_are_counted_and_the_end_has_no_estimate() -> None:
    now, said = [0.0], []
    progress = SweepProgress(3, 0, lambda *words: said.append(words[3]), clock=lambda: now[0])
    for point, seconds in ((1, 5.0), (2, 10000.0), (3, 1.0)):
        now[0] += seconds
        progress.add(failed(point, "no luck"))
    assert said == ["10 s left, 1 failed", "83 min left, 2 failed", "3 failed"]
