"""The DAQ driver over simulated gauge voltages."""

import numpy as np
import pytest

from bench_hw.devices.daq import DaqForceSensor
from bench_hw.errors import DeviceError
from bench_hw.simulated.sensor import SensorModel
from bench_hw.simulated.voltages import SimulatedVoltages


@pytest.fixture
def make(clock, tmp_path, calibration_text, made_up_transducer):
    path = tmp_path / "FT54321.cal"
    path.write_text(calibration_text())

    def make(press=2.0, noise=0.0, **options):
        def load(instants):
            force = np.zeros((len(instants), 3))
            force[:, 2] = press(instants) if callable(press) else press
            return force

        sensor = SensorModel(force_noise=noise, torque_noise=0.0)
        offset = np.array([0.1, -0.2, 0.3, 0.0, 0.05, -0.1])
        rng = np.random.default_rng(3)
        source = SimulatedVoltages(load, made_up_transducer, clock, sensor, rng, offset=offset)
        return DaqForceSensor(source, path, clock=clock, **options)

    return make


def test_force_after_taking_the_bias(make, clock):
    start = clock.now()
    with make(press=lambda t: 2.0 * (t > start + 0.3)) as sensor:
        sensor.start()
        sensor.bias()
        clock.sleep(0.5)
        block = sensor.read()
    assert block.wrench[-1, 2] == pytest.approx(-2.0, abs=1e-4)
    assert block.wrench[0, 2] == pytest.approx(0.0, abs=1e-4)
    assert np.all(np.diff(block.time) > 0)
    assert np.diff(block.time) == pytest.approx(np.full(len(block) - 1, 1e-3), abs=1e-6)
    assert not block.status.any()
    assert block.counts is None


def test_samples_are_counted_in_both_counters(make, clock):
    with make() as sensor:
        sensor.start()
        clock.sleep(0.02)
        first = sensor.read()
        clock.sleep(0.01)
        second = sensor.read()
    numbers = np.concatenate([first.rdt_sequence, second.rdt_sequence])
    assert numbers.tolist() == list(range(len(numbers)))
    assert np.array_equal(first.rdt_sequence, first.ft_sequence)
    assert sensor.health.received == len(numbers)


def test_voltages_near_the_full_scale_are_saturated(make, clock):
    with make(press=200.0) as sensor:
        sensor.start()
        clock.sleep(0.01)
        assert set(sensor.read().status.tolist()) == {0x80020000}


def test_info_names_serial_and_calibration(make):
    with make() as sensor:
        assert sensor.info.serial == "FT54321"
        assert len(sensor.info.calibration) == 64
        assert sensor.ranges[2] == 35.0


def test_another_serial_is_refused(make):
    with pytest.raises(DeviceError, match=r"serial 'FT54321'; the rig asks for 'FT1'"):
        make(serial="FT1").connect()


def test_hardware_that_gives_nothing_is_said_to(make, clock, monkeypatch):
    sensor = make(timeout=0.2)
    sensor.connect()
    monkeypatch.setattr(sensor._source, "available", lambda: 0)
    with pytest.raises(DeviceError, match=r"no sample within 0\.2 s"):
        sensor.start()
    with pytest.raises(DeviceError, match="to take the bias from"):
        sensor.bias()


def test_starting_needs_a_calibration(make):
    with pytest.raises(DeviceError, match="not connected"):
        make().start()
