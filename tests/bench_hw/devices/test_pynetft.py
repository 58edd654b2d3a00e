"""An independent client against our box, and our driver beside it: they must count the same."""

import time

import pytest

from bench_hw.clock import MonotonicClock
from bench_hw.devices.netft import NetFTSensor
from bench_hw.simulated.rdt_stream import StreamFaults

pynetft = pytest.importorskip("pynetft")


def pynetft_counts(box, duration):
    """Health and last sample of pynetft after `duration` seconds on the box's stream."""
    config = pynetft.Config(sensor_host=box.host, rdt_port=box.rdt_port, http_port=box.http_port, receive_timeout=0.5)
    with pynetft.Client(config) as client:
        assert client.wait_for_first_sample(5.0)
        time.sleep(duration)
        return client.health(), client.latest_sample()


def our_counts(box, duration):
    clock = MonotonicClock()
    with NetFTSensor(box.host, http_port=box.http_port, rdt_port=box.rdt_port, rate=1000, clock=clock) as sensor:
        sensor.start()
        end = clock.now() + duration
        while clock.now() < end:
            sensor.read()
            clock.sleep(1e-3)
        return sensor.health


@pytest.mark.parametrize("faults", [StreamFaults(), StreamFaults(drop=frozenset([30, 31, 32, 90, 151]))])
def test_pynetft_counts_exactly_what_our_box_dropped(make_box, faults):
    box = make_box(press=1.5, rate=1000, on=MonotonicClock(), faults=faults)
    health, sample = pynetft_counts(box, 0.5)
    assert health.received_count > 200
    assert (health.lost_count, health.malformed_count, health.duplicate_count) == (len(faults.drop), 0, 0)
    assert sample.force[2] == pytest.approx(-1.5, abs=1e-5)
    assert sample.raw_wrench[2] == pytest.approx(-1_500_000, abs=10)


@pytest.mark.parametrize("drop", [frozenset(), frozenset([30, 31, 32, 90, 151])])
def test_our_driver_counts_the_same(make_box, drop):
    box = make_box(rate=1000, on=MonotonicClock(), faults=StreamFaults(drop=drop))
    health = our_counts(box, 0.5)
    assert health.received > 200
    assert (health.lost, health.duplicates, health.malformed) == (len(drop), 0, 0)


def test_pynetft_biases_our_box(make_box):
    box = make_box(press=1.5, rate=1000, on=MonotonicClock())
    config = pynetft.Config(sensor_host=box.host, rdt_port=box.rdt_port, http_port=box.http_port, receive_timeout=0.5)
    with pynetft.Client(config) as client:
        assert client.wait_for_first_sample(5.0)
        client.bias()
        deadline = time.monotonic() + 5.0
        while abs(client.latest_sample().force[2]) > 1e-3 and time.monotonic() < deadline:
            time.sleep(0.01)
        assert client.latest_sample().force[2] == pytest.approx(0.0, abs=1e-3)
