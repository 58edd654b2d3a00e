"""Rig files: what one may say of devices, safety and simulation (SI inside), and how it is found and read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from bench_hw.configuration import (
    Duration,
    Force,
    Frequency,
    Length,
    Speed,
    StrictModel,
    find_file,
    read_toml,
    shipped_files,
    validated,
)
from bench_hw.safety import CAMERA_SILENT, FROZEN, MISSED

Axis = Literal["+x", "-x", "+y", "-y", "+z", "-z"]
Port = Annotated[int, Field(ge=1, le=65_535, strict=True)]
Text = Annotated[str, Field(min_length=1, max_length=200)]


def host_address(text: str) -> str:
    """A name or an address of a host as it is; ValueError where it can be none."""
    if not text.isprintable() or any(sign.isspace() or sign in "/?#@\\" for sign in text):
        raise ValueError("allowed is the name or address of a host, without blanks and slashes")
    return text


Host = Annotated[str, Field(min_length=1, max_length=253), AfterValidator(host_address)]
Share = Annotated[float, Field(ge=0.0, le=1.0)]
Size = Annotated[int, Field(ge=16, le=10_000, strict=True)]
Frames = Annotated[Frequency, Field(ge=0.1, le=1000.0)]


class _Force(StrictModel):
    """What every force sensor has."""

    rate: Annotated[Frequency, Field(ge=1.0, le=7000.0)] = 1000.0
    bias: bool = False
    serial: Text | None = None
    press_axis: Axis = "-z"


class NetFTConfig(_Force):
    """A Net F/T box."""

    kind: Literal["netft"]
    host: Host
    http_port: Port = 80
    rdt_port: Port = 49_152
    mode: Literal["realtime", "buffered"] = "realtime"


class DaqConfig(_Force):
    """A transducer on a DAQ."""

    kind: Literal["daq"]
    device: Text
    calibration: Text


class SimulatedForceConfig(_Force):
    """A simulated Net F/T box on loopback."""

    kind: Literal["simulated"]
    mode: Literal["realtime", "buffered"] = "realtime"
    noise: Annotated[Force, Field(ge=0.0, le=1.0)] = 2e-3
    loss: Share = 0.0
    drop: str = ""


class ReplayForceConfig(_Force):
    """The sensor of a recorded trial."""

    kind: Literal["replay"]


class _Actuator(StrictModel):
    """What every actuator has; `contact` is the position at which the tool meets the specimen."""

    stroke: Annotated[Length, Field(gt=0.0, le=1.0)]
    max_speed: Annotated[Speed, Field(gt=0.0, le=1.0)] = 0.020
    accuracy: Annotated[int, Field(ge=0, le=1023, strict=True)] = 4
    serial: Text | None = None
    contact: Annotated[Length, Field(ge=0.0)] | None = None
    rate: Annotated[Frequency, Field(ge=1.0, le=500.0)] = 100.0


class LacConfig(_Actuator):
    """A LAC board on USB."""

    kind: Literal["lac"]


class SimulatedActuatorConfig(_Actuator):
    """A simulated LAC board."""

    kind: Literal["simulated"]


class ReplayActuatorConfig(_Actuator):
    """The actuator of a recorded trial; depth zero is the record's."""

    kind: Literal["replay"]


class _Camera(StrictModel):
    """What every camera has."""

    rate: Frames = 30.0
    size: tuple[Size, Size] = (640, 480)
    calibration: Text | None = None


class WebcamConfig(_Camera):
    """A webcam through OpenCV, or through linuxpy for real frame numbers (`driver = "v4l2"`)."""

    kind: Literal["webcam"]
    device: int | str = 0
    driver: Literal["opencv", "v4l2"] = "opencv"
    controls: dict[str, float] | None = None


class HttpCameraConfig(_Camera):
    """An MJPEG stream."""

    kind: Literal["http"]
    url: Text


class ImagesCameraConfig(_Camera):
    """A folder of pictures."""

    kind: Literal["images"]
    folder: Text


class SimulatedCameraConfig(_Camera):
    """A simulated webcam as an MJPEG stream on loopback: its optics (OpenCV's k1, k2, p1, p2, k3) and its JPEG."""

    kind: Literal["simulated"]
    distance: Annotated[Length, Field(gt=0.0, le=10.0)] = 0.070
    focal_px: Annotated[float, Field(gt=0.0, le=100_000.0)] | None = None
    distortion: tuple[float, float, float, float, float] | None = None
    quality: Annotated[int, Field(ge=1, le=100, strict=True)] = 92
    noise: Annotated[float, Field(ge=0.0, le=255.0)] = 3.0
    blur: Annotated[float, Field(ge=0.0, le=20.0)] = 0.8
    lighting: Annotated[float, Field(ge=-1.0, le=1.0)] = 0.15
    jitter: Annotated[Duration, Field(ge=0.0, le=1.0)] = 0.0
    loss: Share = 0.0


class ReplayCameraConfig(_Camera):
    """The camera of a recorded trial."""

    kind: Literal["replay"]


class Replay(StrictModel):
    """The recorded trial (.mcap) that devices of the kind `replay` give again."""

    trial: Text


class Safety(StrictModel):
    """The limits; `travel` are positions of the actuator from fully retracted (default: the whole stroke)."""

    force_limit: Annotated[Force, Field(gt=0.0, le=1000.0)] = 6.0
    force_stale: Annotated[Duration, Field(ge=0.005, le=5.0)] = 0.050
    force_frozen: Annotated[Duration, Field(ge=0.02, le=3600.0)] = FROZEN
    travel: tuple[Length, Length] | None = None


class ScheduledFault(StrictModel):
    """A fault that simulated devices show at a time after the bench was switched on."""

    kind: Literal[
        "force_stall",
        "force_freeze",
        "force_constant",
        "force_restart",
        "force_saturated",
        "usb_unplug",
        "usb_timeout",
        "camera_unplug",
        "camera_freeze",
    ]
    at: Annotated[Duration, Field(ge=0.0)]
    duration: Annotated[Duration, Field(gt=0.0)] | None = None


class Simulation(StrictModel):
    """What is common to the simulated devices; `specimen` is a file of `simulated.virtual_specimen`, or `phantom`."""

    seed: Annotated[int, Field(ge=0, strict=True)] = 0
    contact: Annotated[Length, Field(ge=0.0)] = 5e-3
    faults: tuple[ScheduledFault, ...] = ()
    specimen: Text | None = None


ForceConfig = Annotated[NetFTConfig | DaqConfig | SimulatedForceConfig | ReplayForceConfig, Field(discriminator="kind")]
ActuatorConfig = Annotated[LacConfig | SimulatedActuatorConfig | ReplayActuatorConfig, Field(discriminator="kind")]
CameraConfig = Annotated[
    WebcamConfig | HttpCameraConfig | ImagesCameraConfig | SimulatedCameraConfig | ReplayCameraConfig,
    Field(discriminator="kind"),
]


_NO_HARDWARE = frozenset({"simulated", "replay"})


class Rig(StrictModel):
    """A whole rig file."""

    schema_version: Annotated[Literal[1], Field(alias="schema")]
    name: Text
    force: ForceConfig
    actuator: ActuatorConfig
    camera: CameraConfig | None = None
    safety: Safety = Safety()
    simulation: Simulation = Simulation()
    replay: Replay | None = None

    @property
    def travel(self) -> tuple[float, float]:
        """Lowest and highest position of the actuator allowed, m."""
        return self.safety.travel or (0.0, self.actuator.stroke)

    @property
    def force_frozen(self) -> float:
        """Longest time in which the force may stay the same, s; infinite of a sensor that has no noise of its own."""
        without = self.force.kind == "replay" or (self.force.kind == "simulated" and self.force.noise == 0.0)
        return math.inf if without else self.safety.force_frozen

    @property
    def camera_silent(self) -> float:
        """Longest time without a picture, s: a second, or three periods of a slow camera."""
        return CAMERA_SILENT if self.camera is None else max(CAMERA_SILENT, MISSED / self.camera.rate)

    @property
    def camera_frozen(self) -> float:
        """Longest time with none but repeated pictures, s; infinite of a camera that has no noise of its own."""
        camera = self.camera
        live = isinstance(camera, WebcamConfig | HttpCameraConfig)
        live |= isinstance(camera, SimulatedCameraConfig) and camera.noise > 0.0
        return self.camera_silent if live else math.inf

    @property
    def simulated(self) -> bool:
        """Whether any device is simulated."""
        return "simulated" in self.kinds

    @property
    def synthetic(self) -> bool:
        """Whether what it records is no new measurement: any device is simulated or replayed."""
        return bool(self.kinds & _NO_HARDWARE)

    @property
    def all_simulated(self) -> bool:
        """Whether every device is simulated."""
        return self.kinds == {"simulated"}

    @property
    def without_hardware(self) -> bool:
        """Whether no device is real, so that time may be simulated, too."""
        return self.kinds <= _NO_HARDWARE

    @property
    def kinds(self) -> set[str]:
        """The kinds of its devices."""
        return {device.kind for device in (self.force, self.actuator, self.camera) if device is not None}

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        low, high = self.travel
        stroke = self.actuator.stroke
        if not 0.0 <= low < high <= stroke * (1.0 + 1e-9):
            raise ValueError(
                f"safety.travel is {low * 1e3:g} to {high * 1e3:g} mm; allowed is 0 <= low < high <= stroke "
                f"({stroke * 1e3:g} mm)"
            )
        contact = self.actuator.contact
        if contact is not None and not low <= contact <= high:
            raise ValueError(f"actuator.contact of {contact * 1e3:g} mm is outside safety.travel")
        for name, device in (("force", self.force), ("camera", self.camera)):
            if device is not None and device.kind == "simulated" and self.actuator.kind != "simulated":
                raise ValueError(
                    f"{name}.kind is simulated but actuator.kind is {self.actuator.kind}: a simulated {name} "
                    "knows nothing of a real tool and could not protect the specimen"
                )
        if ("replay" in self.kinds) != (self.replay is not None) or {"replay"} < self.kinds:
            raise ValueError(
                'a replay is of every device together: allowed is kind = "replay" in [force], [actuator] and [camera] '
                "(or no camera), and replay.trial, the recorded trial"
            )
        return self


@dataclass(frozen=True, slots=True)
class LoadedRig:
    """A rig, the text of its file and where that was; paths in it are relative to that folder."""

    rig: Rig
    text: str
    path: Path

    def resolve(self, name: str) -> Path:
        """Give the path of a file that the rig names."""
        return self.path.parent / name


def shipped_rigs() -> dict[str, Path]:
    """Give the shipped rigs: name to path."""
    return shipped_files("bench_hw.rig")


def load_rig(name_or_path: str | Path) -> LoadedRig:
    """Read a rig file.

    Raises
    ------
    InputError
        No such file or shipped name, or the file says something that is not allowed.
    """
    path = find_file("rig", name_or_path, shipped_rigs())
    tables, text = read_toml(path)
    return LoadedRig(validated(Rig, tables, str(path)), text, path)


def simulated_rig(changes: Mapping[str, Mapping[str, Any] | None]) -> LoadedRig:
    """Give the shipped simulated rig with some keys changed, by section; None takes a section out.

    Raises
    ------
    InputError
        A key or value that a rig file may not have.
    """
    import tomli_w

    path = shipped_rigs()["simulated"]
    tables, _ = read_toml(path)
    for section, keys in changes.items():
        if keys is None:
            tables.pop(section, None)
        else:
            tables[section] = {**tables.get(section, {}), **keys}
    return LoadedRig(validated(Rig, tables, str(path)), tomli_w.dumps(tables), path)
