"""The Net F/T driver against the simulated box, byte for byte and fault by fault."""

import socket

import numpy as np
import pytest

from bench_hw.devices.netft import NetFTSensor
from bench_hw.devices.rdt import RECORD
from bench_hw.errors import DeviceError
from bench_hw.simulated.rdt_stream import StreamFaults


def sensor_of(box, clock, **options):
    options = {"rate": 1000, **options}
    return NetFTSensor(box.host, http_port=box.http_port, rdt_port=box.rdt_port, clock=clock, **options)


def collect(sensor, clock, duration, turn=1e-3):
    """All blocks of `duration` seconds, as arrays time, press (-Fz), rdt_sequence."""
    blocks = []
    for _ in range(round(duration / turn)):
        clock.sleep(turn)
        blocks.append(sensor.read())
    return (
        np.concatenate([block.time for block in blocks]),
        np.concatenate([-block.wrench[:, 2] for block in blocks]),
        np.concatenate([block.rdt_sequence for block in blocks]),
    )


def record(sequence, sample=0, status=0, counts=(0,) * 6):
    data = np.zeros(1, RECORD)
    data["rdt_sequence"], data["ft_sequence"], data["status"], data["counts"] = sequence, sample, status, counts
    return data.tobytes()


@pytest.mark.parametrize(("mode", "start"), [("realtime", "00 02"), ("buffered", "00 03")])
def test_transcript_of_a_life(make_box, clock, ear, monkeypatch, mode, start):
    """connect, start, bias, reset_latch, stop, close: exactly these bytes, in this order."""
    box = make_box()
    sensor = NetFTSensor(box.host, http_port=box.http_port, rdt_port=ear.port, rate=1000, mode=mode, timeout=3.0)
    answered: list[bytes] = []
    monkeypatch.setattr("bench_hw.devices.netft.wait_until", lambda *_: answered.append(ear.hear()) or True)
    with sensor:
        sensor.start()
        sensor.bias()
        sensor.reset_latch()
        sensor.stop()
    heard = answered + [ear.hear() for _ in range(4)]
    golden = [start, "00 42", "00 41", "00 00", "00 00"]
    assert heard == [bytes.fromhex(f"12 34 {code} 00 00 00 00") for code in golden]


def test_connecting_sets_the_rate_and_reads_it_back(make_box, clock):
    box = make_box(serial="FT77777")
    with sensor_of(box, clock, rate=900, serial="FT77777") as sensor:
        assert sensor.rate == 1000.0
        assert sensor.info.serial == "FT77777"
        assert sensor.info.settings["rate"] == "1000 Hz"
        assert sensor.ranges == pytest.approx([25, 25, 35, 0.25, 0.25, 0.25])


@pytest.mark.parametrize(
    ("mode", "rate", "latency"),
    [("realtime", 1000, 1e-3), ("buffered", 1000, 10e-3), ("buffered", 7000, 40 / 7000), ("buffered", 50, 20e-3)],
)
def test_datagrams_come_often_enough_to_see_a_limit(make_box, clock, mode, rate, latency):
    with sensor_of(make_box(), clock, mode=mode, rate=rate) as sensor:
        assert sensor.latency == pytest.approx(latency)


def test_another_serial_number_is_refused(make_box, clock):
    box = make_box(serial="FT77777")
    sensor = sensor_of(box, clock, serial="FT00001")
    with pytest.raises(DeviceError, match=r"serial 'FT77777'; the rig asks for 'FT00001'"):
        sensor.connect()
    with pytest.raises(DeviceError, match="not connected"):
        sensor.read()


def test_a_rate_that_does_not_read_back_is_refused(make_box, clock, monkeypatch):
    box = make_box()
    monkeypatch.setattr("bench_hw.devices.netft.netft_network.set_rate", lambda *_: None)
    with pytest.raises(DeviceError, match="reads back as 7000 Hz after asking for 1000 Hz; expected 1000 Hz"):
        sensor_of(box, clock).connect()


def test_a_rate_the_box_has_not_is_refused(make_box, clock):
    with pytest.raises(DeviceError, match="1 to 7000"):
        sensor_of(make_box(), clock, rate=8000).connect()


def test_a_faulty_box_is_refused_before_it_streams(make_box, clock):
    box = make_box()
    box.set_status(0xC0000000)
    with pytest.raises(DeviceError, match="CPU or RAM error"):
        sensor_of(box, clock).connect()


@pytest.mark.parametrize("mode", ["realtime", "buffered"])
def test_force_comes_in_newtons_with_strictly_increasing_stamps(make_box, clock, mode):
    with sensor_of(make_box(press=1.5), clock, mode=mode) as sensor:
        sensor.start()
        time, press, sequence = collect(sensor, clock, 0.4)
    assert press == pytest.approx(np.full(len(press), 1.5), abs=1e-6)
    assert np.all(np.diff(time) > 0.0)
    assert np.diff(time) == pytest.approx(np.full(len(time) - 1, 1e-3), abs=2e-4)
    assert np.all(np.diff(sequence) == 1)
    assert len(time) == pytest.approx(400, abs=41)


def test_counts_and_torques(make_box, clock):
    with sensor_of(make_box(press=2.0, counts_per_force=500_000, counts_per_torque=1000), clock) as sensor:
        sensor.start()
        clock.sleep(5e-3)
        block = sensor.read()
    assert block.counts[0].tolist() == [0, 0, -1_000_000, 0, 0, 0]
    assert block.wrench[0].tolist() == [0, 0, -2.0, 0, 0, 0]


def test_the_queue_is_drained_to_the_newest(make_box, clock):
    with sensor_of(make_box(), clock) as sensor:
        sensor.start()
        clock.sleep(0.05)
        block = sensor.read()
        assert len(block) >= 50
        assert block.time[-1] == pytest.approx(clock.now(), abs=1e-3)
        assert block.time[0] == pytest.approx(clock.now() - 0.05, abs=2e-3)


@pytest.mark.parametrize("mode", ["realtime", "buffered"])
def test_reported_loss_equals_injected_loss(make_box, clock, mode):
    box = make_box(faults=StreamFaults(loss=0.05, drop=frozenset([200, 201, 202, 500])))
    with sensor_of(box, clock, mode=mode) as sensor:
        sensor.start()
        _, _, sequence = collect(sensor, clock, 2.0)
        health = sensor.health
    lost = int(sequence[-1]) - len(sequence)
    assert health.lost == lost
    assert 60 <= lost <= box.dropped
    assert not set(sequence.tolist()) & {200, 201, 202, 500}
    assert box.sent - health.received <= 40


def test_duplicates_are_dropped_and_late_records_counted(make_box, clock):
    box = make_box(faults=StreamFaults(duplicate=frozenset([50, 60, 61]), reorder=frozenset([100, 110])))
    with sensor_of(box, clock) as sensor:
        sensor.start()
        time, _, sequence = collect(sensor, clock, 0.5)
        health = sensor.health
    assert (health.duplicates, health.reordered, health.lost) == (3, 2, 0)
    assert sorted(sequence.tolist()) == list(range(1, len(sequence) + 1))
    assert np.all(np.diff(time) > 0.0)


def test_the_sequence_wraps_without_loss(make_box, clock):
    with sensor_of(make_box(first_sequence=2**32 - 100), clock) as sensor:
        sensor.start()
        time, _, sequence = collect(sensor, clock, 0.3)
        assert sensor.health.lost == sensor.health.restarts == 0
    assert {2**32 - 1, 0, 1} <= set(sequence.tolist())
    assert np.diff(time) == pytest.approx(np.full(len(time) - 1, 1e-3), abs=2e-4)


def test_a_restart_is_counted_and_the_stream_goes_on(make_box, clock):
    box = make_box()
    with sensor_of(box, clock) as sensor:
        sensor.start()
        collect(sensor, clock, 0.5)
        box.restart()
        _, _, sequence = collect(sensor, clock, 0.2)
        assert (sensor.health.restarts, sensor.health.lost) == (1, 0)
    assert sequence[-1] == pytest.approx(200, abs=3)


def test_a_stall_gives_nothing_and_then_goes_on_unbroken(make_box, clock):
    box = make_box()
    with sensor_of(box, clock) as sensor:
        sensor.start()
        collect(sensor, clock, 0.1)
        box.stall(0.2)
        silent, _, _ = collect(sensor, clock, 0.15)
        again, _, _ = collect(sensor, clock, 0.2)
        assert sensor.health.lost == 0
    assert len(silent) <= 2
    assert len(again) == pytest.approx(150, abs=5)


def test_samples_that_stand_still_are_counted(make_box, clock):
    box = make_box()
    with sensor_of(box, clock) as sensor:
        sensor.start()
        collect(sensor, clock, 0.1)
        box.freeze()
        collect(sensor, clock, 0.1)
        assert sensor.health.stalls == pytest.approx(100, abs=3)


def test_bias_takes_the_present_load_as_zero(make_box, clock):
    with sensor_of(make_box(press=1.5), clock) as sensor:
        sensor.start()
        sensor.bias()
        _, press, _ = collect(sensor, clock, 0.05)
    assert np.abs(press).max() < 1e-5


def test_datagrams_from_other_hosts_are_ignored(make_box, clock):
    box = make_box()
    with sensor_of(box, clock) as sensor, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        sensor.start()
        mine = sensor._opened()._socket.getsockname()
        stranger.sendto(record(999_999, counts=(0, 0, -9_000_000, 0, 0, 0)), mine)
        clock.sleep(5e-3)
        block = sensor.read()
    assert 999_999 not in block.rdt_sequence
    assert block.wrench[:, 2].min() == pytest.approx(-1.5, abs=1e-5)


def test_datagrams_that_are_no_records_are_counted_and_skipped(make_box, ear, monkeypatch):
    box = make_box()
    sensor = NetFTSensor(box.host, http_port=box.http_port, rdt_port=ear.port, timeout=3.0)
    with sensor:
        sensor._opened().send(0)
        ear.hear()
        for data in (b"hello", record(1, 7), b"", record(2, 14)[:-1], record(2, 14)):
            ear.say(data)
        block = sensor.read()
        assert block.rdt_sequence.tolist() == [1, 2]
        assert sensor.health.malformed == 3


def test_a_box_that_does_not_stream_is_said_to_be_silent(make_box, clock, ear):
    box = make_box()
    sensor = NetFTSensor(box.host, http_port=box.http_port, rdt_port=ear.port, clock=clock, timeout=0.3)
    with sensor, pytest.raises(DeviceError, match=r"no record within 0\.3 s .* firewall"):
        sensor.start()
    assert clock.now() - 100.0 == pytest.approx(0.3, abs=0.05)


def test_a_refused_port_is_one_clear_error(make_box, clock):
    box = make_box()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        free = taken.getsockname()[1]
    sensor = NetFTSensor(box.host, http_port=box.http_port, rdt_port=free, clock=clock, timeout=0.3)
    with sensor, pytest.raises(DeviceError, match=r"refuses datagrams|no record"):
        sensor.start()


def test_closing_twice_and_stopping_unconnected_do_nothing(make_box, clock):
    sensor = sensor_of(make_box(), clock)
    sensor.stop()
    sensor.connect()
    sensor.close()
    sensor.close()


@pytest.mark.parametrize(
    "use", [lambda s: s.read(), lambda s: s.start(), lambda s: s.info, lambda s: s.rate, lambda s: s.bias()]
)
def test_everything_needs_a_connection(make_box, clock, use):
    with pytest.raises(DeviceError, match="not connected"):
        use(sensor_of(make_box(), clock))
