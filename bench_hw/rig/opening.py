"""From a rig file to its drivers, and to the twins of its simulated devices. Nothing is connected here."""

from __future__ import annotations

from dataclasses import dataclass
from functools import singledispatch
from typing import TYPE_CHECKING

from bench_hw.clock import Clock
from bench_hw.configuration import read_toml
from bench_hw.devices import protocols
from bench_hw.errors import DeviceError, InputError
from bench_hw.rig import rig_file
from bench_hw.rig.bench import Bench
from bench_hw.rig.rig_file import LoadedRig

if TYPE_CHECKING:
    from bench_hw.simulated.replayed_trial import Replay
    from bench_hw.simulated.specimen import Specimen
    from bench_hw.simulated.tabulated import TabulatedSpecimen
    from bench_hw.simulated.twins import Twins
    from bench_hw.simulated.virtual_specimen import VirtualSpecimen


@dataclass(frozen=True, slots=True)
class Opening:
    """What drivers are made with: the rig and its place, the clock, and the twins or the record behind the devices."""

    loaded: LoadedRig
    clock: Clock
    twins: Twins | None = None
    replay: Replay | None = None

    def switched_on(self) -> Twins:
        """Give the twins."""
        assert self.twins is not None  # the schema lets no simulated device stand without a simulated actuator
        return self.twins

    def replayed(self) -> Replay:
        """Give the recorded trial."""
        assert self.replay is not None  # the schema lets no replayed device stand without a trial
        return self.replay


def open_bench(loaded: LoadedRig, clock: Clock, *, specimen: Specimen | None = None, seed: int | None = None) -> Bench:
    """Make a bench from a rig; connect it with `with` or `connect`.

    Parameters
    ----------
    loaded : LoadedRig
        The rig.
    clock : Clock
        The bench's clock; simulated only if every device is.
    specimen : Specimen, optional
        What lies under a simulated tool; by default the one that the rig names, or a simple sheet.
    seed : int, optional
        Of the simulated devices' chance and noise; by default the rig's.

    Raises
    ------
    DeviceError
        A calibration that the rig names is missing, or simulated devices cannot be switched on.
    """
    rig = loaded.rig
    _check_calibration(loaded)
    twins = _twins(rig, clock, specimen or specimen_of(loaded) or sheet_of(loaded), seed) if rig.simulated else None
    context = Opening(loaded, clock, twins, _replay(loaded, clock))
    camera = None if rig.camera is None else open_camera(rig.camera, context)
    return Bench(
        rig, open_force(rig.force, context), open_actuator(rig.actuator, context), camera, twins, context.replay
    )


@singledispatch
def open_force(device: object, context: Opening) -> protocols.ForceSensor:  # noqa: ARG001
    """Make the driver of a force sensor."""
    raise TypeError(f"no driver for {type(device).__name__}")


@open_force.register
def _(device: rig_file.NetFTConfig, context: Opening) -> protocols.ForceSensor:
    from bench_hw.devices.netft import NetFTSensor

    return NetFTSensor(
        device.host,
        rate=device.rate,
        mode=device.mode,
        serial=device.serial,
        http_port=device.http_port,
        rdt_port=device.rdt_port,
        clock=context.clock,
    )


@open_force.register
def _(device: rig_file.DaqConfig, context: Opening) -> protocols.ForceSensor:
    from bench_hw.devices.daq import DaqForceSensor, NidaqmxSource

    path = context.loaded.resolve(device.calibration)
    source = NidaqmxSource(device.device)
    return DaqForceSensor(source, path, rate=device.rate, serial=device.serial, clock=context.clock)


@open_force.register
def _(device: rig_file.SimulatedForceConfig, context: Opening) -> protocols.ForceSensor:
    from bench_hw.devices.netft import NetFTSensor

    box = context.switched_on().box
    assert box is not None
    return NetFTSensor(
        box.host,
        rate=device.rate,
        mode=device.mode,
        serial=device.serial,
        http_port=box.http_port,
        rdt_port=box.rdt_port,
        clock=context.clock,
    )


@singledispatch
def open_actuator(device: object, context: Opening) -> protocols.Actuator:  # noqa: ARG001
    """Make the driver of an actuator."""
    raise TypeError(f"no driver for {type(device).__name__}")


@open_actuator.register(rig_file.LacConfig)
@open_actuator.register(rig_file.SimulatedActuatorConfig)
def _(device: rig_file.LacConfig | rig_file.SimulatedActuatorConfig, context: Opening) -> protocols.Actuator:
    from bench_hw.devices.lac import LacActuator

    return LacActuator(
        device.stroke,
        max_speed=device.max_speed,
        accuracy=device.accuracy,
        serial=device.serial,
        backend=context.switched_on().usb if device.kind == "simulated" else None,
    )


@singledispatch
def open_camera(device: object, context: Opening) -> protocols.CameraDriver:  # noqa: ARG001
    """Make the driver of a camera."""
    raise TypeError(f"no driver for {type(device).__name__}")


@open_camera.register
def _(device: rig_file.WebcamConfig, context: Opening) -> protocols.CameraDriver:
    if device.driver == "v4l2":
        from bench_hw.devices.v4l2_camera import V4l2Camera

        return V4l2Camera(
            device.device, rate=device.rate, size=device.size, controls=device.controls, clock=context.clock
        )
    from bench_hw.devices.webcam import WebcamCamera

    return WebcamCamera(
        device.device, rate=device.rate, size=device.size, controls=device.controls, clock=context.clock
    )


@open_camera.register
def _(device: rig_file.HttpCameraConfig, context: Opening) -> protocols.CameraDriver:
    from bench_hw.devices.http_camera import HttpCamera

    return HttpCamera(device.url, rate=device.rate, clock=context.clock, size=device.size)


@open_camera.register
def _(device: rig_file.ImagesCameraConfig, context: Opening) -> protocols.CameraDriver:
    from bench_hw.devices.images_camera import ImagesCamera

    return ImagesCamera(context.loaded.resolve(device.folder), rate=device.rate, clock=context.clock)


@open_camera.register
def _(device: rig_file.SimulatedCameraConfig, context: Opening) -> protocols.CameraDriver:
    from bench_hw.devices.http_camera import HttpCamera

    server = context.switched_on().camera
    assert server is not None
    return HttpCamera(server.url, rate=device.rate, clock=context.clock, same_clock=True)


@open_force.register
def _(device: rig_file.ReplayForceConfig, context: Opening) -> protocols.ForceSensor:  # noqa: ARG001
    from bench_hw.simulated.replayed_trial import ReplayedForce

    return ReplayedForce(context.replayed())


@open_actuator.register
def _(device: rig_file.ReplayActuatorConfig, context: Opening) -> protocols.Actuator:
    from bench_hw.devices.lac_usb import COUNTS
    from bench_hw.simulated.replayed_trial import ReplayedActuator

    uncertainty = (device.accuracy + 0.5) * device.stroke / COUNTS
    return ReplayedActuator(context.replayed(), uncertainty, device.max_speed)


@open_camera.register
def _(device: rig_file.ReplayCameraConfig, context: Opening) -> protocols.CameraDriver:
    from bench_hw.simulated.replayed_trial import ReplayedCamera

    return ReplayedCamera(context.replayed(), device.rate)


def _replay(loaded: LoadedRig, clock: Clock) -> Replay | None:
    from bench_hw.simulated.replayed_trial import Replay

    wanted = loaded.rig.replay
    return None if wanted is None else Replay(loaded.resolve(wanted.trial), clock)


def _check_calibration(loaded: LoadedRig) -> None:
    """Refuse a camera calibration that cannot be read or was made with pictures of another size."""
    camera = loaded.rig.camera
    if camera is None or camera.calibration is None:
        return
    where = f"{loaded.path}: camera.calibration {camera.calibration!r}"
    try:
        size = read_toml(loaded.resolve(camera.calibration))[0].get("image_size")
    except InputError as error:
        raise DeviceError(f"{where}: {error}") from error
    if size is not None and list(size) != list(camera.size):
        raise DeviceError(f"{where}: made for pictures of {size} pixels; the rig asks for {list(camera.size)}")


def sheet_of(loaded: LoadedRig) -> TabulatedSpecimen | None:
    """The shipped sheet that a simulated rig names, as `phantom`; None where it names a file of its own, or nothing.

    Raises
    ------
    InputError
        None of that name ships.
    """
    from bench_hw.simulated.tabulated import Scatter, TabulatedSpecimen, read_sheet

    name = loaded.rig.simulation.specimen
    if name is None or _is_file(loaded, name):
        return None
    try:
        return TabulatedSpecimen(read_sheet(name), scatter=Scatter())
    except InputError as error:
        raise InputError(f"{loaded.path}: key simulation.specimen: {error}") from None


def specimen_of(loaded: LoadedRig) -> VirtualSpecimen | None:
    """The virtual specimen whose file a simulated rig names; None without.

    Raises
    ------
    InputError
        Its file cannot be used.
    """
    from bench_hw.simulated.virtual_specimen import read_specimen

    name = loaded.rig.simulation.specimen
    return None if name is None or not _is_file(loaded, name) else read_specimen(loaded.resolve(name))


def _is_file(loaded: LoadedRig, name: str) -> bool:
    return bool(loaded.resolve(name).suffix) or loaded.resolve(name).is_file()


def _twins(rig: rig_file.Rig, clock: Clock, specimen: Specimen | None, seed: int | None) -> Twins:
    from bench_hw.rig.simulation import switch_on_twins

    return switch_on_twins(rig, clock, specimen, seed)
