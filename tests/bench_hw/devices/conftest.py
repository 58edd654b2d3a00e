"""Twins and files shared by the tests of the drivers. All numbers are made up; all endpoints are on 127.0.0.1."""

import contextlib
import socket
import threading
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from bench_hw.clock import SimulatedClock
from bench_hw.simulated.lac_board import LacBoard, LacUsbBackend
from bench_hw.simulated.netft_box import BoxSettings, NetFTBox
from bench_hw.simulated.sensor import SensorModel
from bench_hw.simulated.specimen import SheetSpecimen
from bench_hw.simulated.virtual_bench import ActuatorMotion, VirtualBench

STROKE = 0.050


@pytest.fixture
def clock() -> SimulatedClock:
    return SimulatedClock(start=100.0)


def constant_press(press: float) -> Callable[[np.ndarray], np.ndarray]:
    def load(instants):
        force = np.zeros((len(instants), 3))
        force[:, 2] = press
        return force

    return load


@pytest.fixture
def make_box(clock) -> Iterator[Callable[..., NetFTBox]]:
    """Switch on a box with a steady press; keywords are those of BoxSettings, and `press`, `on` (its clock)."""
    boxes: list[NetFTBox] = []

    def make(press: float = 1.5, noise: float = 0.0, on=clock, **settings) -> NetFTBox:
        sensor = SensorModel(force_noise=noise, torque_noise=0.01 * noise)
        settings = BoxSettings(**{"sensor": sensor, **settings})
        boxes.append(NetFTBox(constant_press(press), on, settings, np.random.default_rng(5)))
        return boxes[-1]

    yield make
    for box in boxes:
        box.close()


@pytest.fixture
def virtual_bench(clock) -> VirtualBench:
    motion = ActuatorMotion(STROKE, position=0.010, target=0.010)
    return VirtualBench(SheetSpecimen(), motion, contact=0.012, start=clock.now())


@pytest.fixture
def board(virtual_bench, clock) -> LacBoard:
    return LacBoard(virtual_bench, clock, max_speed=0.020)


@pytest.fixture
def usb(board) -> LacUsbBackend:
    return LacUsbBackend(board)


class UdpEar:
    """A UDP socket that remembers what it is sent and can answer."""

    def __init__(self) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(5.0)
        self.port = self.socket.getsockname()[1]
        self.client = None

    def hear(self) -> bytes:
        data, self.client = self.socket.recvfrom(2048)
        return data

    def say(self, data: bytes) -> None:
        self.socket.sendto(data, self.client)


@pytest.fixture
def ear() -> Iterator[UdpEar]:
    ear = UdpEar()
    yield ear
    ear.socket.close()


@pytest.fixture
def tcp_server() -> Iterator[Callable[..., int]]:
    """Serve each connection with a function of the connected socket; gives the port."""
    listeners, threads = [], []

    def serve(talk) -> int:
        listener = socket.create_server(("127.0.0.1", 0))
        listeners.append(listener)

        def run():
            while True:
                try:
                    client, _ = listener.accept()
                except OSError:
                    return
                with client, contextlib.suppress(OSError):  # the driver may hang up first
                    client.settimeout(5.0)
                    talk(client)

        threads.append(threading.Thread(target=run, daemon=True))
        threads[-1].start()
        return listener.getsockname()[1]

    yield serve
    for listener in listeners:
        listener.shutdown(socket.SHUT_RDWR)
        listener.close()
    for thread in threads:
        thread.join(timeout=5.0)


@pytest.fixture
def calibration_text() -> Callable[..., str]:
    """Write ATI calibration files of a made-up transducer (synthetic), of either version."""

    def write(version: str = "1.1", torque: str = "N-mm", distance: str = "mm", **root) -> str:
        return cal_text(version, torque, distance, **root)

    return write


USER = np.array(
    [
        [-0.0112, 0.0421, 0.1003, -3.2101, -0.0834, 3.1907],
        [-0.1520, 3.7011, 0.0503, -1.8402, 0.0911, -1.8804],
        [4.4108, -0.1302, 4.3917, -0.1109, 4.4511, -0.1704],
        [-0.6011, 24.3107, -21.5204, -11.2310, 22.0109, -13.0702],
        [24.9013, -0.3104, -12.9115, 20.5117, -12.1032, -20.9051],
        [-0.2017, -14.9031, 0.1045, -15.1107, 0.2039, -14.7020],
    ]
)
"""A made-up transducer's UserAxis: N and N-mm per volt."""
OFFSET_MM = np.array([0.35, -0.20, 6.10])
SCALES = np.array([7.5, 7.5, 2.75, 1.65, 1.65, 1.80])
RANGES = (25.0, 25.0, 35.0, 250.0, 250.0, 250.0)
NAMES = ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")


def axis_rows() -> np.ndarray:
    """The rows of a version 1.0 file: at the transducer's own origin, times the scale.

    A force acting at the user's origin, which lies at `OFFSET_MM` from the transducer's own, has there the
    torque T_own = T_user + d x F (the definition of a torque, in N-mm).
    """
    own = USER.copy()
    own[3:] += np.cross(OFFSET_MM, USER[:3].T).T
    return own * SCALES[:, None]


def cal_text(version: str, torque: str, distance: str, serial: str = "FT54321", turned: str = "0") -> str:
    per_mm = {"mm": 1.0, "m": 1e-3}[distance]
    per_nmm = {"N-mm": 1.0, "N-m": 1e-3}[torque]
    units = np.repeat([1.0, per_nmm], 3)
    axis = "".join(
        f'<Axis Name="{name}" values="{" ".join(f"{v:.12g}" for v in row * unit)}" max="{top * unit:g}" '
        f'scale="{scale}"/>\n'
        for name, row, unit, top, scale in zip(NAMES, axis_rows(), units, RANGES, SCALES, strict=True)
    )
    user = "".join(
        f'<UserAxis Name="{name}" values="{" ".join(f"{v:.5f}" for v in row * unit)}" max="{top * unit:g}"/>\n'
        for name, row, unit, top in zip(NAMES, USER, units, RANGES, strict=True)
    )
    shift = " ".join(f'D{a}="{d * per_mm:.9g}"' for a, d in zip("xyz", OFFSET_MM, strict=True))
    return (
        '<?xml version="1.0" encoding="utf-8"?>\n'
        f'<FTSensor Serial="{serial}" BodyStyle="Synthetic" Family="DAQ" NumGages="6" CalFileVersion="{version}">\n'
        f'<Calibration PartNumber="SYN" ForceUnits="N" TorqueUnits="{torque}" DistUnits="{distance}" '
        'OutputMode="Ground Referenced Differential" OutputRange="20" OutputBipolar="True">\n'
        f'{axis}<BasicTransform {shift} Rx="{turned}" Ry="0" Rz="0"/>\n{user if version == "1.1" else ""}'
        "</Calibration>\n</FTSensor>\n"
    )


@pytest.fixture
def made_up_transducer() -> np.ndarray:
    """Its matrix in N and N m per volt."""
    return USER * np.repeat([1.0, 1e-3], 3)[:, None]
