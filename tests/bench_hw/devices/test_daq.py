"""The DAQ driver over simulated gauge voltages."""

import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from bench_hw.devices.daq import DaqForceSensor, NidaqmxSource
from bench_hw.errors import DeviceError
from bench_hw.simulated.sensor import SensorModel, SimulatedVoltages


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


class Task:
    """A stand-in for nidaqmx.Task with six inputs that hold 0, 1, 2... volts."""

    def __init__(self):
        self.calls = []
        self.inputs = 6
        self.ai_channels = SimpleNamespace(
            add_ai_voltage_chan=lambda name, **options: self.calls.append((name, options)), __len__=lambda: 6
        )
        self.timing = SimpleNamespace(cfg_samp_clk_timing=self.clock, samp_clk_rate=999.5)
        self.in_stream = SimpleNamespace(avail_samp_per_chan=12)
        self.closed = False

    def clock(self, rate, **options):
        self.calls.append((rate, options))

    def start(self):
        self.calls.append("start")

    def read(self, number_of_samples_per_channel, timeout):
        return [[float(channel)] * number_of_samples_per_channel for channel in range(6)]

    def close(self):
        self.closed = True


class Channels:
    def __init__(self, task, count):
        self.task, self.count = task, count

    def add_ai_voltage_chan(self, name, **options):
        self.task.calls.append((name, options))

    def __len__(self):
        return self.count


@pytest.fixture
def tasks(monkeypatch):
    made = []

    def make():
        task = Task()
        task.ai_channels = Channels(task, make.count)
        made.append(task)
        return task

    make.count = 6
    module, constants = ModuleType("nidaqmx"), ModuleType("nidaqmx.constants")
    module.Task = make
    constants.AcquisitionType = SimpleNamespace(CONTINUOUS="continuous")
    constants.TerminalConfiguration = SimpleNamespace(DIFF="differential")
    monkeypatch.setitem(sys.modules, "nidaqmx", module)
    monkeypatch.setitem(sys.modules, "nidaqmx.constants", constants)
    return SimpleNamespace(made=made, make=make)


def test_sets_six_differential_inputs_on_the_boards_clock(tasks):
    source = NidaqmxSource("Dev1/ai0:5")
    assert source.start(1000.0) == 999.5
    (task,) = tasks.made
    assert task.calls == [
        ("Dev1/ai0:5", {"terminal_config": "differential", "min_val": -10.0, "max_val": 10.0}),
        (1000.0, {"sample_mode": "continuous", "samps_per_chan": 10000}),
        "start",
    ]
    assert source.available() == 12
    assert np.array_equal(source.read(3), np.tile(np.arange(6.0), (3, 1)))
    source.close()
    source.close()
    assert task.closed


def test_another_number_of_inputs_is_refused(tasks):
    tasks.make.count = 4
    with pytest.raises(DeviceError, match="4 inputs; a transducer needs six"):
        NidaqmxSource("Dev1/ai0:3").start(1000.0)
    assert tasks.made[0].closed


def test_what_the_library_raises_names_the_device(tasks, monkeypatch):
    source = NidaqmxSource("Dev1/ai0:5")
    source.start(1000.0)

    def lost(**_):
        raise RuntimeError("samples were overwritten")

    monkeypatch.setattr(tasks.made[0], "read", lost)
    with pytest.raises(DeviceError, match="DAQ Dev1/ai0:5: samples were overwritten"):
        source.read(1)


def test_without_the_library_the_fix_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "nidaqmx", None)
    with pytest.raises(DeviceError, match=r"pip install 'tissuebench\[daq\]'"):
        NidaqmxSource("Dev1/ai0:5").start(1000.0)


def test_reading_needs_a_start():
    with pytest.raises(DeviceError, match="not started"):
        NidaqmxSource("Dev1/ai0:5").available()
