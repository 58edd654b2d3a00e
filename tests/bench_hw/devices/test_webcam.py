"""The webcam driver over a stand-in for cv2.VideoCapture, and over cv2 itself on a simulated stream."""

import threading
from itertools import pairwise

import cv2
import numpy as np
import pytest

from bench_hw.clock import MonotonicClock, wait_until
from bench_hw.devices.webcam import WebcamCamera
from bench_hw.errors import DeviceError
from bench_hw.simulated.camera_server import CameraServer, CameraSettings, encode


class Capture:
    """A webcam as cv2.VideoCapture shows one: it keeps what is set, unless it is stubborn."""

    def __init__(self, stamps=(), stubborn=(), size=None, opened=True, raw=True, frames=5):
        self.values = {cv2.CAP_PROP_AUTOFOCUS: 1.0, cv2.CAP_PROP_AUTO_EXPOSURE: 3.0, cv2.CAP_PROP_AUTO_WB: 1.0}
        self.stamps, self.stubborn, self.size = list(stamps), stubborn, size
        self.opened, self.raw, self.left = opened, raw, frames + 1
        self.done, self.released = threading.Event(), False
        self.set_calls = []

    def isOpened(self):
        return self.opened

    def set(self, prop, value):
        self.set_calls.append(prop)
        if prop not in self.stubborn:
            self.values[prop] = float(value)
        return True

    def get(self, prop):
        if prop == cv2.CAP_PROP_POS_MSEC:
            return self.stamps.pop(0) if self.stamps else 0.0
        if self.size and prop in (cv2.CAP_PROP_FRAME_WIDTH, cv2.CAP_PROP_FRAME_HEIGHT):
            return self.size[prop == cv2.CAP_PROP_FRAME_HEIGHT]
        return self.values.get(prop, 0.0)

    def grab(self):
        self.left -= 1
        if self.left < 0:
            self.done.set()
        return self.left >= 0

    def retrieve(self):
        picture = np.full((48, 64), self.left, np.uint8)
        return True, np.frombuffer(encode(picture), np.uint8).reshape(1, -1) if self.raw else picture

    def release(self):
        self.released = True


def camera_of(capture, **options):
    return WebcamCamera(0, open_capture=lambda device: capture, size=(64, 48), **options)


def all_frames(camera, capture):
    camera.start()
    assert capture.done.wait(5.0)
    camera.stop()
    return camera.read()


def test_everything_that_moves_by_itself_is_locked_and_read_back():
    capture = Capture()
    with camera_of(capture, controls={"exposure": 200.0, "focus": 30.0, "white_balance": 4000.0}) as camera:
        settings = camera.info.settings
    assert capture.values[cv2.CAP_PROP_AUTOFOCUS] == capture.values[cv2.CAP_PROP_AUTO_WB] == 0.0
    assert capture.values[cv2.CAP_PROP_AUTO_EXPOSURE] == 1.0
    assert (settings["exposure"], settings["focus"], settings["white_balance"]) == ("200", "30", "4000")
    assert settings["size"] == "64 x 48"
    assert capture.released


@pytest.mark.parametrize(
    ("stubborn", "name"),
    [
        (cv2.CAP_PROP_AUTOFOCUS, "focus"),
        (cv2.CAP_PROP_FOCUS, "focus"),
        (cv2.CAP_PROP_EXPOSURE, "exposure"),
        (cv2.CAP_PROP_AUTO_WB, "white_balance"),
    ],
)
def test_a_control_that_does_not_read_back_is_named(stubborn, name):
    capture = Capture(stubborn=(stubborn,))
    with pytest.raises(DeviceError, match=f"{name} cannot be locked"):
        camera_of(capture).connect()
    assert capture.released


@pytest.mark.parametrize(
    ("capture", "says"),
    [
        (Capture(opened=False), "cannot be opened"),
        (Capture(size=(320, 240)), "gives 320 x 240 pixels; the rig asks for 64 x 48"),
        (Capture(frames=-1), "gives no picture"),
    ],
)
def test_what_is_no_such_camera(capture, says):
    with pytest.raises(DeviceError, match=says):
        camera_of(capture).connect()


def test_an_unknown_control_is_refused():
    with pytest.raises(DeviceError, match="control 'zoom'; allowed are exposure, focus, white_balance"):
        camera_of(Capture(), controls={"zoom": 1.0}).connect()


def test_the_cameras_own_jpeg_bytes_are_kept():
    capture = Capture(frames=3)
    with camera_of(capture) as camera:
        frames = all_frames(camera, capture)
    assert [frame.data for frame in frames] == [encode(np.full((48, 64), left, np.uint8)) for left in (2, 1, 0)]


def test_plain_pictures_are_encoded():
    capture = Capture(frames=2, raw=False)
    with camera_of(capture) as camera:
        frames = all_frames(camera, capture)
    assert [cv2.imdecode(np.frombuffer(frame.data, np.uint8), 0)[0, 0] for frame in frames] == [1, 0]


class Ticking:
    """A clock that moves a tenth of a second at each look."""

    def __init__(self):
        self.time = 50.0

    def now(self):
        self.time += 0.1
        return self.time

    def settle(self):
        pass


@pytest.mark.parametrize(
    ("stamps", "expected"),
    [
        ([50_050.0, 50_150.0, 50_250.0], [50.05, 50.15, 50.25]),  # good: positive, increasing, close
        ([0.0, 0.0, 0.0], [50.1, 50.2, 50.3]),  # none
        ([1000.0, 1033.0, 1066.0], [50.1, 50.2, 50.3]),  # of another clock
        ([50_050.0, 50_050.0, 50_250.0], [50.05, 50.2, 50.25]),  # not increasing
        ([51_000.0, 50_190.0, 50_290.0], [50.1, 50.19, 50.29]),  # from the future
    ],
)
def test_opencvs_stamps_are_used_only_while_they_are_plausible(stamps, expected):
    capture = Capture(frames=3, stamps=stamps)
    with camera_of(capture, clock=Ticking(), rate=10.0) as camera:
        frames = all_frames(camera, capture)
    assert [frame.time for frame in frames] == pytest.approx(expected, abs=1e-9)


def test_frames_that_did_not_come_are_skipped_numbers():
    capture = Capture(frames=4, stamps=[50_050.0, 50_083.0, 50_183.0, 50_216.0])
    with camera_of(capture, clock=Ticking(), rate=30.0) as camera:
        frames = all_frames(camera, capture)
        assert camera.health.dropped == 2
    assert [frame.number for frame in frames] == [0, 1, 4, 5]


def test_a_camera_that_ends_is_lost_once_its_frames_are_read():
    capture = Capture(frames=1)
    with camera_of(capture) as camera:
        camera.start()
        assert capture.done.wait(5.0)
        camera._grabber.stop()
        assert len(camera.read()) == 1
        with pytest.raises(DeviceError, match="unplugged"):
            camera.read()


def test_starting_needs_a_connection():
    with pytest.raises(DeviceError, match="not connected"):
        camera_of(Capture()).start()


def test_a_real_opencv_reads_the_simulated_stream():
    clock = MonotonicClock()
    rng = np.random.default_rng(1)
    with CameraServer(
        lambda now: rng.integers(0, 255, (48, 64)).astype(np.uint8), clock, CameraSettings(rate=50.0), rng
    ) as server:
        camera = WebcamCamera(server.url, rate=50.0, size=(64, 48), controls={}, clock=clock)
        with camera:
            camera.start()
            frames = []
            assert wait_until(clock, lambda: frames.extend(camera.read()) or len(frames) > 5, timeout=10.0)
    assert all(cv2.imdecode(np.frombuffer(frame.data, np.uint8), 0).shape == (48, 64) for frame in frames)
    assert all(after.time > before.time for before, after in pairwise(frames))
