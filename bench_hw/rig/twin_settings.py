"""From a rig file to the settings of its simulated devices."""

from __future__ import annotations

from bench_hw.rig.schema import Rig, SimulatedCamera, SimulatedForce
from bench_hw.simulated.camera_server import CameraSettings
from bench_hw.simulated.faults import StreamFaults, parse_positions
from bench_hw.simulated.netft_box import BoxSettings
from bench_hw.simulated.picture import CameraModel
from bench_hw.simulated.sensor import SensorModel
from bench_hw.simulated.specimen import SheetSpecimen, Specimen
from bench_hw.simulated.switched_on import FOR_EVER, TimedFault, TwinSettings


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
    if not isinstance(camera, SimulatedCamera):
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
    if not isinstance(force, SimulatedForce):
        return None
    sensor = SensorModel(press_axis=force.press_axis, force_noise=force.noise, torque_noise=0.01 * force.noise)
    return BoxSettings(sensor=sensor, faults=StreamFaults(loss=force.loss, drop=parse_positions(force.drop)))


def _camera(rig: Rig) -> CameraSettings | None:
    camera = rig.camera
    if not isinstance(camera, SimulatedCamera):
        return None
    return CameraSettings(rate=camera.rate, jitter=camera.jitter, loss=camera.loss, quality=camera.quality)
