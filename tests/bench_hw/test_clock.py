"""The bench's clocks."""

import threading
import time

import pytest

from bench_hw.clock import MonotonicClock, SimulatedClock, wait_until


def test_simulated_time_passes_only_when_slept_on():
    clock = SimulatedClock(start=10.0)
    assert clock.now() == 10.0
    clock.sleep(0.25)
    assert clock.now() == pytest.approx(10.25, abs=1e-12)
    clock.sleep(0.0)
    clock.sleep(-1.0)
    assert clock.now() == pytest.approx(10.25, abs=1e-12)


def test_subscribers_are_called_at_every_step_on_the_way():
    clock = SimulatedClock(step=0.1)
    seen: list[float] = []
    cancel = clock.every(0.1, seen.append)
    clock.sleep(0.35)
    assert seen == pytest.approx([0.1, 0.2, 0.3, 0.35])
    cancel()
    clock.sleep(1.0)
    assert len(seen) == 4


def test_a_subscriber_may_cancel_itself():
    clock = SimulatedClock(step=0.1)
    seen = []
    cancel = clock.every(0.1, lambda now: (seen.append(now), cancel()))
    clock.sleep(0.5)
    assert len(seen) == 1


def test_simulated_clock_refuses_a_step_of_nothing():
    with pytest.raises(ValueError, match="step"):
        SimulatedClock(step=0.0)


def test_waiting_ends_when_ready_or_when_the_time_is_over():
    clock = SimulatedClock()
    assert wait_until(clock, lambda: clock.now() > 0.1, timeout=1.0)
    assert clock.now() < 0.2
    assert not wait_until(clock, lambda: False, timeout=0.5)
    assert clock.now() == pytest.approx(0.6, abs=0.1)


def test_what_comes_at_the_last_moment_is_still_in_time():
    clock = SimulatedClock()
    arrived = []
    thread = threading.Timer(0.01, arrived.append, [1])
    thread.start()
    assert wait_until(clock, lambda: bool(arrived), timeout=0.01)
    thread.join()


def test_monotonic_clock_repeats_in_a_thread_until_cancelled():
    clock = MonotonicClock()
    seen: list[float] = []
    cancel = clock.every(1e-3, seen.append)
    assert wait_until(clock, lambda: len(seen) >= 3, timeout=5.0)
    cancel()
    count = len(seen)
    time.sleep(0.02)
    assert len(seen) == count
    assert seen == sorted(seen)
