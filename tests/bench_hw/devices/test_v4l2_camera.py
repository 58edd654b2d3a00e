"""The V4L2 driver over a stand-in for linuxpy, and without it."""

import sys
from types import SimpleNamespace

import pytest

from bench_hw.clock import MonotonicClock, wait_until
from bench_hw.devices.v4l2_camera import V4l2Camera
from bench_hw.errors import DeviceError


class Control:
    def __init__(self, value, top=10_000):
        self._value, self._top = value, top

    @property
    def value(self):
        return self._value

    @value.setter
    def value(self, value):
        self._value = min(value, self._top)


class Frame:
    def __init__(self, number, stamp):
        self.frame_nb, self.timestamp = number, stamp

    def __bytes__(self):
        return b"\xff\xd8frame %d" % self.frame_nb


class Capture:
    def __init__(self, frames, size=(640, 480)):
        self.frames, self.size, self.calls = frames, size, []

    def set_format(self, *arguments):
        self.calls.append(arguments)

    def set_fps(self, rate):
        self.calls.append(rate)

    def get_format(self):
        return SimpleNamespace(width=self.size[0], height=self.size[1])

    def get_fps(self):
        return 30

    def open(self):
        self.calls.append("open")

    def close(self):
        self.calls.append("close")

    def __iter__(self):
        yield from self.frames


def modern(**changes):
    controls = {
        "auto_exposure": Control(3),
        "exposure_time_absolute": Control(500),
        "focus_automatic_continuous": Control(1),
        "focus_absolute": Control(0),
        "white_balance_automatic": Control(1),
        "white_balance_temperature": Control(5000),
    }
    return {**controls, **changes}


class Opened:
    """A linuxpy device: a context manager whose controls are there once it is open."""

    def __init__(self, controls):
        self.controls = SimpleNamespace(**controls)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None


def camera_of(capture, has=None, clock=None, **options):
    opened = Opened(modern() if has is None else has)
    return V4l2Camera(0, open_camera=lambda name: (opened, capture), clock=clock, **options), opened


def test_locks_the_controls_by_either_name():
    old = {
        "exposure_auto": Control(3),
        "exposure_absolute": Control(1),
        "focus_auto": Control(1),
        "focus_absolute": Control(1),
        "white_balance_temperature_auto": Control(1),
        "white_balance_temperature": Control(1),
    }
    for controls in (old, modern()):
        camera, opened = camera_of(
            Capture([]), controls, controls={"exposure": 200, "focus": 30, "white_balance": 4000}
        )
        with camera:
            assert camera.info.settings["exposure"] == "200"
            assert camera.info.settings["white_balance"] == "4000"
        assert next(iter(vars(opened.controls).values())).value == 1


def test_frames_carry_the_kernels_numbers_and_stamps():
    clock = MonotonicClock()
    base = clock.now()
    capture = Capture([Frame(7, base - 0.02), Frame(8, base - 0.01), Frame(11, base), Frame(12, 3.0)])
    camera, _ = camera_of(capture, clock=clock)
    with camera:
        camera.start()
        frames = []
        assert wait_until(clock, lambda: frames.extend(camera.read()) or len(frames) == 4, timeout=5.0)
        assert camera.health.dropped == 2
        with pytest.raises(DeviceError):
            camera.read()
    assert [frame.number for frame in frames] == [0, 1, 4, 5]
    assert [frame.time for frame in frames[:3]] == [base - 0.02, base - 0.01, base]
    assert frames[3].time >= base
    assert frames[0].data == b"\xff\xd8frame 7"
    assert capture.calls[:2] == [(640, 480, "MJPG"), 30.0]
    assert capture.calls[-1] == "close"


def test_another_size_is_refused():
    camera, _ = camera_of(Capture([], size=(320, 240)))
    with pytest.raises(DeviceError, match="gives 320 x 240"):
        camera.connect()


def test_a_control_that_does_not_read_back_is_named():
    camera, _ = camera_of(Capture([]), modern(focus_absolute=Control(0, top=20)), controls={"focus": 30})
    with pytest.raises(DeviceError, match="focus_absolute cannot be set to 30 \\(reads back 20\\)"):
        camera.connect()


def test_a_control_that_is_not_there_is_named():
    controls = modern()
    del controls["focus_absolute"]
    camera, _ = camera_of(Capture([]), controls, controls={"focus": 30})
    with pytest.raises(DeviceError, match="has no control focus_absolute"):
        camera.connect()


def test_without_the_library_the_fix_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "linuxpy", None)
    monkeypatch.setitem(sys.modules, "linuxpy.video", None)
    monkeypatch.setitem(sys.modules, "linuxpy.video.device", None)
    with pytest.raises(DeviceError, match=r"pip install 'tissuebench\[v4l2\]'"):
        V4l2Camera(0).connect()


def test_starting_needs_a_connection():
    camera, _ = camera_of(Capture([]))
    with pytest.raises(DeviceError, match="not connected"):
        camera.start()
