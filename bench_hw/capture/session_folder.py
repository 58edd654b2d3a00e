"""`SessionFolder`: the files of a session around its trials, each written whole or not at all.

Among them the `camera.toml`: the rig's own, or the true optics of a simulated camera.
"""

from __future__ import annotations

import json
import shlex
import shutil
import tempfile
import tomllib
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from bench_hw.capture.order import CaptureOrder
from bench_hw.capture.session_keys import check_session, check_session_file, specimen_source
from bench_hw.configuration import read_toml
from bench_hw.devices.protocols import DeviceInfo
from bench_hw.errors import InputError
from bench_hw.rig.rig_file import LoadedRig, Rig, SimulatedCameraConfig
from bench_hw.storage.atomic import write_text
from bench_hw.storage.regular_file import read_regular

SESSION_FILE = "session.toml"
LOG_FILE = "capture.json"
CAMERA_FILE = "camera.toml"
SCHEMA = 1
_LEAST_FREE = 20_000_000


class SessionFolder:
    """A session's folder.

    Parameters
    ----------
    order : CaptureOrder
        What was asked for; its `out` is the folder.

    Raises
    ------
    InputError
        The folder holds something already (and nothing is to be appended), is no folder, or cannot be written;
        or there is no session to append to.
    """

    def __init__(self, order: CaptureOrder) -> None:
        self.path = order.out
        self._session = self._existing() if order.append else {}
        if order.append and order.specimen:
            self._check_same(order.specimen)
        check_session(_keys_of(order), "--set")
        if order.append:
            self._check_keys(order)
            self._check_camera(order.rig)
        self._log: list[dict[str, Any]] = []
        if not order.append and self.path.exists():
            self._check_empty()
        self._made = not self.path.exists()
        self._check_writable()

    def seed(self, order: CaptureOrder) -> int | None:
        """Give the seed of simulated devices: trials that are appended are no copies of those that are there."""
        if not order.append:
            return order.seed
        return (order.rig.rig.simulation.seed if order.seed is None else order.seed) + len(self._names())

    def next_trial(self) -> str:
        """Give the name of the next trial, `trial_001` being the first."""
        names = self._names()
        number = 1
        while f"trial_{number:03d}" in names:
            number += 1
        return f"trial_{number:03d}"

    def _names(self) -> set[str]:
        """The names of the trials that are there, whole or not."""
        return {path.name.split(".")[0] for path in self.path.glob("trial_*.mcap*")}

    def begin(self, order: CaptureOrder, keys: dict[str, Any]) -> None:
        """Prepare the session's entries, and copy its tissue's file; the rest waits until the first trial is whole.

        Raises
        ------
        InputError, OSError
            The tissue's file cannot be read, or not be written.
        """
        if self._session:
            return
        self._session = {"schema": SCHEMA, "name": self.path.resolve().name}
        if order.rig.rig.synthetic:
            self._session["synthetic"] = True
        _merge(self._session, keys)
        if order.specimen:
            source = specimen_source(order.specimen, self.path)
            self._session["specimen"] = order.specimen if source is None else source.name
            if source is not None:
                self.keep(source.name, read_toml(source)[1])
        _merge(self._session, _keys_of(order))

    @property
    def told(self) -> dict[str, Any]:
        """What the session's file says, or will say once a trial is whole, but for its trials."""
        return {key: value for key, value in self._session.items() if key != "trials"}

    def other_rig(self, order: CaptureOrder) -> str | None:
        """Name of a rig that the session's captures were made with, where none was made with this one."""
        names = sorted({str(_logged(path).get("rig", "")) for path in self.path.glob("capture*.json")} - {""})
        return names[0] if names and order.rig.rig.name not in names else None

    def add_trial(self, file: Path, condition: str) -> None:
        """Add a trial to `session.toml`.

        Raises
        ------
        OSError
            It cannot be written.
        """
        import tomli_w

        trials = [*self._session.get("trials", []), {"file": file.name, "condition": condition}]
        self._session = {**self.told, "trials": trials}
        write_text(self.path / SESSION_FILE, tomli_w.dumps(self._session), check_session_file)

    def write_log(self, order: CaptureOrder, devices: dict[str, DeviceInfo], entry: dict[str, Any]) -> None:
        """Note a trial, good or not, with the devices that made it, in `capture.json`.

        Raises
        ------
        OSError
            It cannot be written.
        """
        self._log.append(entry)
        written = {
            "schema": SCHEMA,
            "rig": order.rig.rig.name,
            "protocol": order.protocol.protocol.name,
            "synthetic": order.rig.rig.synthetic,
            "devices": {name: asdict(info) for name, info in devices.items()},
            "session": self.told,
            "trials": self._log,
        }
        write_text(self.path / self._log_name(), json.dumps(written, indent=2) + "\n")

    def keep(self, name: str, text: str) -> None:
        """Write a text file beside the trials.

        Raises
        ------
        OSError
            It cannot be written.
        """
        write_text(self.path / name, text)

    def abandon(self) -> None:
        """Take the folder away again if it was made here and nothing is in it."""
        if self._made and self.path.is_dir() and not any(self.path.iterdir()):
            self.path.rmdir()

    def _log_name(self) -> str:
        """`capture.json`, or the next free name where an earlier capture left its own."""
        if not hasattr(self, "_chosen_log"):
            number = 1
            while (self.path / _numbered(number)).exists():
                number += 1
            self._chosen_log = _numbered(number)
        return self._chosen_log

    def _existing(self) -> dict[str, Any]:
        path = self.path / SESSION_FILE
        if not path.is_file():
            if told := _told_before(self.path / LOG_FILE):
                return told
            empty = not self.path.is_dir() or not any(self.path.iterdir())
            new = "leave --append out for a new one" if empty else "give another --out, without --append, for a new one"
            raise InputError(f"{path}: there is no session to append to; {new}{self._cut_off()}")
        return read_toml(path)[0]

    def _check_same(self, specimen: str) -> None:
        """Refuse another specimen than the session's, which the trials to be added are of."""
        told = str(self._session.get("specimen", ""))
        if told not in (specimen, Path(specimen).name):
            its = f"this session's is {told}" if told else "this session names none, and another is not put in"
            raise InputError(f"--specimen {specimen}: {its}; leave it out with --append, or give another --out")

    def _check_keys(self, order: CaptureOrder) -> None:
        """Refuse keys that the session's file has otherwise, or not: it stays as it is."""
        for key, value in order.session_keys.items():
            told: Any = self._session
            for part in key.split("."):
                told = told.get(part) if isinstance(told, dict) else None
            if told != _plain(value):
                its = f"{self.path / SESSION_FILE} has " + (f"{told!r}" if told is not None else "none")
                raise InputError(
                    f"--set {key}={value}: {its}, which stays with --append; leave it out, change that file, or give "
                    "another --out"
                )

    def _check_camera(self, loaded: LoadedRig) -> None:
        """Refuse pictures of a camera that is calibrated otherwise than the session's, by which all are read."""
        told = self._session.get("camera")
        path = self.path / (told.get("file", CAMERA_FILE) if isinstance(told, dict) else CAMERA_FILE)
        text = None
        with suppress(OSError):  # one that cannot be read is told of where the bench is opened
            text = camera_text(loaded) if path.is_file() else None
        if text is not None and _tables(text) != read_toml(path)[0]:
            raise InputError(
                f"--append: {path} is another calibration than that of the rig's camera ({loaded.path}, [camera]), and "
                "the markers of all trials are read by it; give another --out, or the rig the session's calibration"
            )

    def _check_empty(self) -> None:
        if not self.path.is_dir():
            raise InputError(f"{self.path}: is no folder; give another --out")
        if any(self.path.iterdir()):
            append = ", or --append to add trials to its session" if (self.path / SESSION_FILE).is_file() else ""
            left = f"{append}{self._cut_off()}"
            raise InputError(f"{self.path}: is not empty and nothing in it is overwritten; give another --out{left}")

    def _cut_off(self) -> str:
        """What a killed capture left of a trial, and how to get at it; nothing where there is none."""
        part = next(iter(sorted(self.path.glob("trial_*.mcap.part"))), None)
        if part is None:
            return ""
        whole = part.with_name(part.name.replace(".mcap.part", "_recovered.mcap"))
        recover = shlex.join(["recover", str(part), "--out", str(whole)])
        return f". {part.name} was cut off; python -m bench_hw {recover} writes what is whole of it"

    def _check_writable(self) -> None:
        try:
            free = self._free_bytes()
            if free < _LEAST_FREE:
                raise InputError(
                    f"{self.path}: {free / 1e6:.0f} MB free on that disk; allowed is {_LEAST_FREE / 1e6:.0f} MB or more"
                )
        except InputError:
            if self._made:
                with suppress(OSError):
                    self.path.rmdir()
            raise

    def _free_bytes(self) -> int:
        """Room on the folder's disk; it is made where it is missing, and a byte is written to see that it can be."""
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=self.path) as probe:
                probe.write(b"x")
            return shutil.disk_usage(self.path).free
        except OSError as error:
            raise InputError(f"{self.path}: cannot be written ({error.strerror}); give another --out") from error


def _logged(path: Path) -> dict[str, Any]:
    """What a capture's log says; nothing where there is none or it cannot be read."""
    try:
        found = json.loads(read_regular(path))
    except (OSError, ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


def _told_before(path: Path) -> dict[str, Any]:
    """What a session's log tells of its set-up where a fault ended its first trial; else nothing."""
    log = _logged(path)
    told, trials = log.get("session"), log.get("trials")
    ended = isinstance(trials, list) and all(isinstance(one, dict) and one.get("fault") for one in trials)
    if not ended or not isinstance(told, dict):
        return {}
    check_session(told, f"{path}, session")
    return told


def _numbered(number: int) -> str:
    return LOG_FILE if number == 1 else f"capture-{number}.json"


def _keys_of(order: CaptureOrder) -> dict[str, Any]:
    """The keys of `session.toml` that were asked for."""
    tables: dict[str, Any] = {}
    for key, value in order.session_keys.items():
        _merge(tables, _nested(key, value))
    return tables


def _nested(key: str, value: str) -> dict[str, Any]:
    first, dot, rest = key.partition(".")
    return {first: _nested(rest, value) if dot else _plain(value)}


def _plain(text: str) -> Any:
    """A number, truth value or list as TOML reads it, else the text."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):  # no TOML, or a number of too many digits
        return text


def _merge(into: dict[str, Any], more: dict[str, Any]) -> None:
    for key, value in more.items():
        if isinstance(value, dict) and isinstance(into.get(key), dict):
            _merge(into[key], value)
        else:
            into[key] = value


def _tables(text: str) -> dict[str, Any] | None:
    """The tables of a TOML text; None where it is none."""
    try:
        return tomllib.loads(text)
    except ValueError:
        return None


def camera_text(loaded: LoadedRig) -> str | None:
    """Give the text of the session's `camera.toml`; None if the camera is not calibrated.

    Raises
    ------
    OSError
        The rig's calibration cannot be read.
    """
    camera = loaded.rig.camera
    if camera is None:
        return None
    if camera.calibration is not None:
        return read_regular(loaded.resolve(camera.calibration)).decode("utf-8-sig")
    return _of_simulated(loaded) if isinstance(camera, SimulatedCameraConfig) else None


def camera_place(rig: Rig) -> dict[str, str]:
    """Give what a session file says of where the camera is: known of a simulated one only."""
    camera = rig.camera
    return {"distance": f"{camera.distance * 1e3:g} mm"} if isinstance(camera, SimulatedCameraConfig) else {}


def _of_simulated(loaded: LoadedRig) -> str:
    import tomli_w

    from bench_hw.rig.simulation import optics_of
    from bench_hw.vision.camera.camera_file import camera_tables
    from bench_hw.vision.camera.pinhole import Camera, Plane, Quality

    optics = optics_of(loaded.rig)
    focal, (width, height) = optics.focal_length, optics.size
    centre = ((width - 1) / 2.0, (height - 1) / 2.0)
    plane = Plane(optics.distance / focal, 0.0, centre)
    camera = Camera(optics.size, (focal, focal), centre, optics.distortion, plane, Quality(0, 0.0, 0.0))
    return "# The true optics of the simulated camera; not measured.\n" + tomli_w.dumps(camera_tables(camera))
