"""`Twins`: the simulated devices of one bench, switched on together, with faults at set times."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from bench_hw.clock import Cancel, Clock
from bench_hw.devices.rdt import Status
from bench_hw.errors import InputError
from bench_hw.simulated.camera_server import CameraServer, CameraSettings
from bench_hw.simulated.lac_board import LacBoard, LacUsbBackend
from bench_hw.simulated.netft_box import BoxSettings, NetFTBox
from bench_hw.simulated.picture import CameraModel, Painter
from bench_hw.simulated.specimen import LaidAnew, Specimen
from bench_hw.simulated.virtual_bench import ActuatorMotion, VirtualBench

_FAULT_TICK = 1e-3
_DEAD_TIME = 0.02
"""Longest time a drive takes to leave rest, s, where presses differ: two readings at 100 Hz. Without it the tool
crosses its counts at the same moments between readings in every trial, and their error does not average out."""
FOR_EVER = 1e9


@dataclass(frozen=True, slots=True)
class TimedFault:
    """A fault at a time after the bench was switched on; without `duration` it stays."""

    kind: str
    at: float
    duration: float = FOR_EVER


@dataclass(slots=True)
class Twins:
    """The twins of one bench; those that a rig does not simulate are None.

    Parameters
    ----------
    clock : Clock
        Their clock.
    settings : TwinSettings
        What they are.
    bench : VirtualBench
        The physics under the tool.
    board, usb : LacBoard and LacUsbBackend
        The actuator's board and its USB plug.
    rng : numpy.random.Generator
        Of what differs from press to press.
    box : NetFTBox or None
        The force box.
    camera : CameraServer or None
        The camera.
    """

    clock: Clock
    settings: TwinSettings
    bench: VirtualBench
    board: LacBoard
    usb: LacUsbBackend
    rng: np.random.Generator
    box: NetFTBox | None = None
    camera: CameraServer | None = None
    _cancels: list[Cancel] = field(default_factory=list)

    def schedule(self, faults: Iterable[TimedFault]) -> None:
        """Show faults at their times, counted from now.

        Raises
        ------
        InputError
            A fault of a device that is not simulated here.
        """
        for fault in faults:
            known = self._faults(fault.duration)
            if fault.kind not in known:
                raise InputError(f"fault {fault.kind!r}: these simulated devices can show {', '.join(known)}")
            self._cancels.append(self._at(fault.at, partial(self.show, fault.kind, fault.duration)))

    def show(self, kind: str, duration: float = FOR_EVER) -> None:
        """Show a fault now, and end it after `duration` seconds.

        Raises
        ------
        KeyError
            There is no such fault.
        """
        begin, end = self._faults(duration)[kind]
        begin()
        if duration < FOR_EVER:
            self._cancels.append(self._at(duration, end))

    def lay_anew(self) -> None:
        """Lay the specimen for the next press, the tool in the air: one that scatters is drawn, others stay."""
        if isinstance(self.settings.specimen, LaidAnew):
            specimen, off = self.settings.specimen.laid_anew(self.rng)
            self.bench.lay(specimen, self.settings.contact + off, _DEAD_TIME * self.rng.random())

    def catch_up(self) -> None:
        """Let the box do now what is due: a busy machine may have left its thread waiting, a real box never waits."""
        if self.box is not None:
            self.box.tick(self.clock.now())

    def close(self) -> None:
        """Switch everything off; may be repeated."""
        for cancel in self._cancels:
            cancel()
        self._cancels.clear()
        for twin in (self.box, self.camera):
            if twin is not None:
                twin.close()

    def _at(self, delay: float, act: Callable[[], None]) -> Cancel:
        due = [self.clock.now() + delay]

        def tick(now: float) -> None:
            if due and now >= due[0]:
                due.clear()
                act()

        return self.clock.every(_FAULT_TICK, tick)

    def _faults(self, duration: float) -> dict[str, tuple[Callable[[], None], Callable[[], None]]]:
        def nothing() -> None:
            """End a fault that ends by itself."""

        faults: dict[str, tuple[Callable[[], None], Callable[[], None]]] = {
            "usb_unplug": (lambda: self._plug(True), lambda: self._plug(False)),
            "usb_timeout": (lambda: self._lose_answers(10**9), lambda: self._lose_answers(0)),
        }
        if (box := self.box) is not None:
            faults |= {
                "force_stall": (lambda: box.stall(duration), nothing),
                "force_freeze": (lambda: box.freeze(True), lambda: box.freeze(False)),
                "force_constant": (lambda: box.hold_reading(True), lambda: box.hold_reading(False)),
                "force_restart": (box.restart, nothing),
                "force_saturated": (
                    lambda: box.set_status(Status.ERROR | Status.SATURATED),
                    lambda: box.set_status(Status.HEALTHY),
                ),
            }
        if (camera := self.camera) is not None:
            faults |= {
                "camera_unplug": (camera.unplug, nothing),
                "camera_freeze": (lambda: camera.freeze(True), lambda: camera.freeze(False)),
            }
        return faults

    def _plug(self, out: bool) -> None:
        self.usb.unplugged = out

    def _lose_answers(self, number: int) -> None:
        self.usb.lost_answers = number


@dataclass(frozen=True, slots=True)
class TwinSettings:
    """What the twins of one bench are.

    Parameters
    ----------
    specimen : Specimen
        What lies under the tool.
    stroke, max_speed : float
        Of the actuator, m and m/s.
    contact : float
        Position of the actuator at which the tool meets the specimen, m.
    seed : int
        Of all chance and noise.
    box : BoxSettings, optional
        The force box; None for none.
    camera : CameraSettings, optional
        The camera's timing; None for no camera.
    picture : CameraModel
        The camera's optics.
    """

    specimen: Specimen
    stroke: float
    max_speed: float
    contact: float
    seed: int = 0
    box: BoxSettings | None = None
    camera: CameraSettings | None = None
    picture: CameraModel = field(default_factory=CameraModel)


def switch_on(settings: TwinSettings, clock: Clock) -> Twins:
    """Switch the twins of a bench on.

    Raises
    ------
    InputError
        The camera's distortion folds over inside the picture.
    """
    of_box, of_camera, of_noise, of_specimen = np.random.default_rng(settings.seed).spawn(4)
    painter = None if settings.camera is None else _painter(settings.picture, of_noise)
    bench = VirtualBench(
        settings.specimen, ActuatorMotion(settings.stroke), contact=settings.contact, start=clock.now()
    )
    board = LacBoard(bench, clock, settings.max_speed)
    twins = Twins(clock, settings, bench, board, LacUsbBackend(board), of_specimen)
    if settings.box is not None:
        twins.box = NetFTBox(bench.force_at, clock, settings.box, of_box)
    if settings.camera is not None and painter is not None:
        paint = painter.paint
        twins.camera = CameraServer(lambda now: paint(bench.markers_at(now)), clock, settings.camera, of_camera)
    return twins


def _painter(picture: CameraModel, rng: np.random.Generator) -> Painter:
    try:
        return Painter(picture, rng)
    except ValueError as error:
        raise InputError(f"simulated camera: {error}, or a longer focal length") from None
