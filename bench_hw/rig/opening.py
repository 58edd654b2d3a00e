"""From a rig file to its drivers, and to the twins of its simulated devices. Nothing is connected here."""

from __future__ import annotations

from dataclasses import dataclass
from functools import singledispatch
from typing import TYPE_CHECKING

from bench_hw.clock import Clock
from bench_hw.configuration import read_toml
from bench_hw.devices import protocols
from bench_hw.errors import DeviceError, InputError
from bench_hw.rig import rig_file as schema
from bench_hw.rig.bench import Bench
from bench_hw.rig.rig_file import LoadedRig, Rig, SimulatedCameraConfig, SimulatedForceConfig
from bench_hw.simulated.camera_server import CameraSettings
from bench_hw.simulated.netft_box import BoxSettings
from bench_hw.simulated.picture import CameraModel
from bench_hw.simulated.rdt_stream import StreamFaults, parse_positions
from bench_hw.simulated.sensor import SensorModel
from bench_hw.simulated.specimen import SheetSpecimen, Specimen
from bench_hw.simulated.twins import FOR_EVER, TimedFault, TwinSettings

if TYPE_CHECKING:
    from bench_hw.simulated.specimen import Specimen
    from bench_hw.simulated.twins import Twins


@dataclass(frozen=True, slots=True)
class Opening:
    """What drivers are made with: the rig and its place, the clock, and the twins if any device is simulated."""

    loaded: LoadedRig
    clock: Clock
    twins: Twins | None = None

    def switched_on(self) -> Twins:
        """Give the twins."""
        assert self.twins is not None  # the schema lets no simulated device stand without a simulated actuator
        return self.twins


def open_bench(loaded: LoadedRig, clock: Clock, *, specimen: Specimen | None = None, seed: int | None = None) -> Bench:
    """Make a bench from a rig; connect it with `with` or `connect`.

    Parameters
    ----------
    loaded : LoadedRig
        The rig.
    clock : Clock
        The bench's clock; simulated only if every device is.
    specimen : Specimen, optional
        What lies under a simulated tool; by default a simple sheet.
    seed : int, optional
        Of the simulated devices' chance and noise; by default the rig's.

    Raises
    ------
    DeviceError
        A calibration that the rig names is missing, or simulated devices cannot be switched on.
    """
    rig = loaded.rig
    _check_calibration(loaded)
    twins = _switch_on(rig, clock, specimen, seed) if rig.simulated else None
    context = Opening(loaded, clock, twins)
    camera = None if rig.camera is None else open_camera(rig.camera, context)
    return Bench(rig, open_force(rig.force, context), open_actuator(rig.actuator, context), camera, twins)


@singledispatch
def open_force(device: object, context: Opening) -> protocols.ForceSensor:  # noqa: ARG001
    """Make the driver of a force sensor."""
    raise TypeError(f"no driver for {type(device).__name__}")


@open_force.register
def _(device: schema.NetFTConfig, context: Opening) -> protocols.ForceSensor:
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
def _(device: schema.DaqConfig, context: Opening) -> protocols.ForceSensor:
    from bench_hw.devices.daq import DaqForceSensor, NidaqmxSource

    path = context.loaded.resolve(device.calibration)
    source = NidaqmxSource(device.device)
    return DaqForceSensor(source, path, rate=device.rate, serial=device.serial, clock=context.clock)


@open_force.register
def _(device: schema.SimulatedForceConfig, context: Opening) -> protocols.ForceSensor:
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


@open_actuator.register(schema.LacConfig)
@open_actuator.register(schema.SimulatedActuatorConfig)
def _(device: schema.LacConfig | schema.SimulatedActuatorConfig, context: Opening) -> protocols.Actuator:
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
def _(device: schema.WebcamConfig, context: Opening) -> protocols.CameraDriver:
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
def _(device: schema.HttpCameraConfig, context: Opening) -> protocols.CameraDriver:
    from bench_hw.devices.http_camera import HttpCamera

    return HttpCamera(device.url, rate=device.rate, clock=context.clock)


@open_camera.register
def _(device: schema.ImagesCameraConfig, context: Opening) -> protocols.CameraDriver:
    from bench_hw.devices.images_camera import ImagesCamera

    return ImagesCamera(context.loaded.resolve(device.folder), rate=device.rate, clock=context.clock)


@open_camera.register
def _(device: schema.SimulatedCameraConfig, context: Opening) -> protocols.CameraDriver:
    from bench_hw.devices.http_camera import HttpCamera

    server = context.switched_on().camera
    assert server is not None
    return HttpCamera(server.url, rate=device.rate, clock=context.clock)


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


def _switch_on(rig: schema.Rig, clock: Clock, specimen: Specimen | None, seed: int | None) -> Twins:
    from bench_hw.rig.opening import faults_of, settings_of
    from bench_hw.simulated.twins import switch_on

    try:
        twins = switch_on(settings_of(rig, specimen, seed), clock)
    except OSError as error:
        raise DeviceError(f"simulated devices: {error}") from error
    try:
        twins.schedule(faults_of(rig))
    except BaseException:
        twins.close()
        raise
    return twins


def settings_of(rig: Rig, specimen: Specimen | None = None, seed: int | None = None) -> TwinSettings:
    """Give the settings of a rig's twins."""
    return TwinSettings(
        specimen=SheetSpecimen() if specimen is None else specimen,
        stroke=rig.actuator.stroke,
        max_speed=rig.actuator.max_speed,
        contact=rig.simulation.contact,
        seed=rig.simulation.seed if seed is None else seed,
        box=_box(rig),
        camera=_camera(rig),
        picture=optics_of(rig),
    )


def optics_of(rig: Rig) -> CameraModel:
    """Give the optics of a rig's simulated camera (the usual ones if it has none)."""
    camera = rig.camera
    if not isinstance(camera, SimulatedCameraConfig):
        return CameraModel()
    usual = CameraModel()
    return CameraModel(
        size=camera.size,
        focal_length=camera.focal_px or usual.focal_length * camera.size[0] / usual.size[0],
        distance=camera.distance,
        distortion=camera.distortion or usual.distortion,
        noise=camera.noise,
        blur=camera.blur,
        lighting=camera.lighting,
    )


def faults_of(rig: Rig) -> list[TimedFault]:
    """Give the faults that a rig's simulated devices are to show."""
    return [TimedFault(fault.kind, fault.at, fault.duration or FOR_EVER) for fault in rig.simulation.faults]


def _box(rig: Rig) -> BoxSettings | None:
    force = rig.force
    if not isinstance(force, SimulatedForceConfig):
        return None
    sensor = SensorModel(press_axis=force.press_axis, force_noise=force.noise, torque_noise=0.01 * force.noise)
    return BoxSettings(sensor=sensor, faults=StreamFaults(loss=force.loss, drop=parse_positions(force.drop)))


def _camera(rig: Rig) -> CameraSettings | None:
    camera = rig.camera
    if not isinstance(camera, SimulatedCameraConfig):
        return None
    return CameraSettings(rate=camera.rate, jitter=camera.jitter, loss=camera.loss, quality=camera.quality)
