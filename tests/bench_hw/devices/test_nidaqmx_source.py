"""The NI source: over a stand-in for nidaqmx, and without it."""

import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from bench_hw.devices.nidaqmx_source import NidaqmxSource
from bench_hw.errors import DeviceError


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
