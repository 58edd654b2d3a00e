"""What devices there are, what is missing, and what to do about it. Looks, sets nothing, moves nothing."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from bench_hw.clock import MonotonicClock
from bench_hw.devices import netft_network
from bench_hw.errors import BenchError, DeviceError, InputError
from bench_hw.rig import rig_file
from bench_hw.rig.rig_file import LoadedRig, host_address

_QUICK = 0.5


@dataclass(frozen=True, slots=True)
class Finding:
    """One device or driver, whether it is there, and the fix if it is not."""

    device: str
    kind: str
    found: bool
    detail: str
    fix: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Give it as plain values."""
        return asdict(self)


_UNASKED = Finding(
    "force", "netft", False, "no address to look at", "give --host (a Net F/T box leaves the factory as 192.168.1.1)"
)


def survey(host: str | None = None, http_port: int = 80) -> list[Finding]:
    """Look for every kind of device on this machine, and for a Net F/T box at an address that was given.

    Without one nothing is sent to the network: that address may be another machine's.
    """
    return [
        _UNASKED if host is None else _netft(host, http_port),
        _module("force", "daq", "nidaqmx", "pip install 'tissuebench[daq]' and NI's NI-DAQmx driver (only for a DAQ)"),
        _lac(),
        *_cameras(),
        _module("camera", "v4l2", "linuxpy", "pip install 'tissuebench[v4l2]' (only for numbered frames on Linux)"),
    ]


def survey_rig(loaded: LoadedRig) -> list[Finding]:
    """Look for each device of a rig and check that it is the one the rig names."""
    rig = loaded.rig
    devices: list[tuple[str, Any]] = [("force", rig.force), ("actuator", rig.actuator), ("camera", rig.camera)]
    return [_of_rig(name, device, loaded) for name, device in devices if device is not None]


def _of_rig(name: str, device: Any, loaded: LoadedRig) -> Finding:
    if device.kind == "simulated":
        return Finding(name, "simulated", True, "simulated on this machine")
    if device.kind == "replay":
        return _of_record(name, loaded)
    try:
        return Finding(name, device.kind, True, _LOOK[type(device)](device, loaded))
    except BenchError as error:
        return Finding(name, device.kind, False, "not usable", str(error))


def _of_record(name: str, loaded: LoadedRig) -> Finding:
    from bench_hw.rig.opening import open_bench

    try:
        with open_bench(loaded, MonotonicClock()) as bench:
            return Finding(name, "replay", True, f"replay of {bench.infos()[name].settings['replayed']}")
    except BenchError as error:
        return Finding(name, "replay", False, "not usable", str(error))


def _look_netft(device: rig_file.NetFTConfig, loaded: LoadedRig) -> str:
    found = netft_network.read_configuration(device.host, device.http_port, 2.0)
    if device.serial is not None and device.serial != found.serial:
        raise DeviceError(f"serial {found.serial!r} at {device.host}; {loaded.path} asks for {device.serial!r}")
    return f"{found.product}, serial {found.serial}, {found.rate} Hz"


def _look_daq(device: rig_file.DaqConfig, loaded: LoadedRig) -> str:
    from bench_hw.devices.daq import MISSING, DaqForceSensor, NidaqmxSource

    sensor = DaqForceSensor(NidaqmxSource(device.device), loaded.resolve(device.calibration), serial=device.serial)
    with sensor:
        if importlib.util.find_spec("nidaqmx") is None:
            raise DeviceError(MISSING)
        return f"calibration of serial {sensor.info.serial}; inputs {device.device} are tried by capture"


def _look_actuator(device: rig_file.LacConfig, loaded: LoadedRig) -> str:
    from bench_hw.rig.opening import Opening, open_actuator

    with open_actuator(device, Opening(loaded, MonotonicClock())) as actuator:
        return f"{actuator.info.model} {actuator.info.serial} at {actuator.position() * 1e3:.2f} mm"


def _look_camera(device: Any, loaded: LoadedRig) -> str:
    from bench_hw.rig.opening import Opening, open_camera

    with open_camera(device, Opening(loaded, MonotonicClock())) as camera:
        settings = ", ".join(f"{key} {value}" for key, value in camera.info.settings.items())
        return f"{camera.info.model}: {settings}"


_LOOK: dict[type, Callable[[Any, LoadedRig], str]] = {
    rig_file.NetFTConfig: _look_netft,
    rig_file.DaqConfig: _look_daq,
    rig_file.LacConfig: _look_actuator,
    rig_file.WebcamConfig: _look_camera,
    rig_file.HttpCameraConfig: _look_camera,
    rig_file.ImagesCameraConfig: _look_camera,
}


def _host(text: str) -> str:
    try:
        return host_address(text)
    except ValueError as error:
        raise InputError(f"--host {text!r}: {error}") from None


def _netft(host: str, http_port: int) -> Finding:
    try:
        found = netft_network.read_configuration(_host(host), http_port, _QUICK)
    except DeviceError as error:
        return Finding("force", "netft", False, f"no Net F/T box at {host}", str(error))
    return Finding("force", "netft", True, f"{found.product}, serial {found.serial}, {found.rate} Hz at {host}")


def _lac() -> Finding:
    from bench_hw.devices.lac_usb import LacLink

    try:
        link = LacLink(None, None, 0.1)
    except DeviceError as error:
        return Finding("actuator", "lac", False, "no LAC board", str(error))
    serial = link.serial
    link.close()
    return Finding("actuator", "lac", True, f"LAC board, serial {serial or 'none'}")


def _cameras() -> list[Finding]:
    if sys.platform != "linux":
        return [Finding("camera", "webcam", False, "not listed on this system", "try numbers 0, 1, ... as device")]
    found = sorted(Path("/dev").glob("video*"))
    if not found:
        return [Finding("camera", "webcam", False, "no /dev/video*", "plug a webcam in; in a container, pass it on")]
    return [Finding("camera", "webcam", True, f"{path} ({_name(path)})") for path in found]


def _name(path: Path) -> str:
    named = Path("/sys/class/video4linux") / path.name / "name"
    return named.read_text(encoding="utf-8").strip() if named.is_file() else "unnamed"


def _module(device: str, kind: str, module: str, fix: str) -> Finding:
    there = importlib.util.find_spec(module) is not None
    return Finding(device, kind, there, f"{module} is {'' if there else 'not '}installed", "" if there else fix)
