"""The simulated devices of a rig: their settings from its file, switched on with their faults."""

from __future__ import annotations

from bench_hw.clock import Clock
from bench_hw.errors import DeviceError
from bench_hw.rig.rig_file import Rig, SimulatedCameraConfig, SimulatedForceConfig
from bench_hw.simulated.camera_server import CameraSettings
from bench_hw.simulated.netft_box import BoxSettings
from bench_hw.simulated.picture import CameraModel
from bench_hw.simulated.rdt_stream import StreamFaults, parse_positions
from bench_hw.simulated.sensor import SensorModel
from bench_hw.simulated.specimen import SheetSpecimen, Specimen
from bench_hw.simulated.twins import FOR_EVER, TimedFault, Twins, TwinSettings, switch_on


def switch_on_twins(rig: Rig, clock: Clock, specimen: Specimen | None, seed: int | None) -> Twins:
    """Switch the twins of a rig on, with the faults it schedules.

    Raises
    ------
    DeviceError
        They cannot be switched on.
    """
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
