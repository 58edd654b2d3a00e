"""Seven kilohertz for a minute on loopback: the box in a process of its own, the driver in this one."""

import json
import re
import signal
import subprocess
import sys
import time

import pytest

from bench_hw.clock import MonotonicClock
from bench_hw.devices.netft import NetFTSensor

pytestmark = pytest.mark.slow

DURATION = 60.0
ANNOUNCED = re.compile(r"http://127\.0\.0\.1:(\d+)/.*RDT on UDP (\d+)")


@pytest.fixture
def box():
    """Start the box as a process; gives its ports and, on call, ends it and gives what it says it sent."""
    started = []

    def start(*options):
        command = [sys.executable, "-m", "bench_hw", "simulate", "netft", "--duration-s", "120", "--json", *options]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        started.append(process)
        ports = ANNOUNCED.search(process.stderr.readline())

        def end():
            process.send_signal(signal.SIGTERM)
            out, _ = process.communicate(timeout=10)
            assert process.returncode == 0
            return json.loads(out)

        return int(ports[1]), int(ports[2]), end

    yield start
    for process in started:
        if process.poll() is None:
            process.kill()
            process.communicate()


def read_for(sensor, duration, turn):
    """Read for a time; received, last sequence number, share of one core."""
    clock = MonotonicClock()
    sensor.start()
    began, cpu, end = clock.now(), time.process_time(), clock.now() + duration
    received, highest = 0, 0
    while clock.now() < end:
        block = sensor.read()
        received += len(block)
        highest = int(block.rdt_sequence.max()) if len(block) else highest
        clock.sleep(turn)
    return received, highest, (time.process_time() - cpu) / (clock.now() - began)


def test_buffered_loses_nothing_and_costs_little(box):
    http, rdt, end = box()
    with NetFTSensor("127.0.0.1", http_port=http, rdt_port=rdt, rate=7000, mode="buffered") as sensor:
        received, highest, share = read_for(sensor, DURATION, 5e-3)
        health = sensor.health
    sent = end()["sent"]
    print(f"buffered: {received} records, lost {health.lost}, {100 * share:.1f} % of one core")
    assert received == highest == pytest.approx(7000 * DURATION, rel=0.01)
    assert (health.lost, health.duplicates, health.reordered, health.malformed) == (0, 0, 0, 0)
    assert sent >= received
    assert share < 0.25


def test_realtime_reports_every_loss(box):
    http, rdt, end = box("--loss", "0.002", "--seed", "4")
    with NetFTSensor("127.0.0.1", http_port=http, rdt_port=rdt, rate=7000, mode="realtime") as sensor:
        received, highest, share = read_for(sensor, DURATION, 1e-3)
        health = sensor.health
    counted = end()
    print(
        f"realtime: {received} records, lost {health.lost}, box dropped {counted['dropped']}, "
        f"{100 * share:.1f} % of one core"
    )
    assert health.received == received
    assert health.received + health.lost == highest
    assert highest == pytest.approx(7000 * DURATION, rel=0.01)
    assert health.lost >= 0.9 * counted["dropped"]
