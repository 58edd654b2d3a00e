"""ATI's calibration file (.cal, XML) for a transducer on a DAQ: gauge voltages to a wrench.

wrench = UserAxis @ (volts - bias). Files of version 1.1 carry `UserAxis`. Files of version 1.0 have `Axis`
(values and scale, at the transducer's own origin) and `BasicTransform`, the shift of the origin: UserAxis =
T(-d) @ (Axis / scale) with T = [[I, 0], [[p]x, I]] and p = -(Dx, Dy, Dz). The sign matters: with the other
one the torques are those about a point on the wrong side of the transducer.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import DeviceError
from bench_hw.storage.regular_file import read_regular

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

AXES = ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")
_FORCE = {"N": 1.0, "kN": 1e3, "lb": 4.4482216152605, "lbf": 4.4482216152605, "klb": 4448.2216152605}
_DISTANCE = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}
_TORQUE = {f"{force}-{distance}": f * d for force, f in _FORCE.items() for distance, d in _DISTANCE.items()}


@dataclass(frozen=True, slots=True)
class AtiCalibration:
    """A transducer's calibration in SI.

    Parameters
    ----------
    serial : str
        Serial number of the transducer.
    matrix : ndarray (6, 6)
        Wrench (N, N m) per volt of the six gauges.
    ranges : ndarray (6,)
        Largest magnitudes of Fx..Tz, N and N m; NaN where the file has none.
    full_scale : float
        Largest gauge voltage, V.
    fingerprint : str
        SHA-256 of the file.
    """

    serial: str
    matrix: NDArray[np.float64]
    ranges: NDArray[np.float64]
    full_scale: float
    fingerprint: str

    def wrench(self, volts: NDArray[np.float64], bias: NDArray[np.float64]) -> NDArray[np.float64]:
        """Turn gauge voltages (n, 6) into wrenches (n, 6), N and N m; `bias` (6,) are the unloaded volts."""
        result: NDArray[np.float64] = (volts - bias) @ self.matrix.T
        return result


def read_calibration(path: Path) -> AtiCalibration:
    """Read a .cal file of version 1.0 or 1.1.

    Raises
    ------
    DeviceError
        The file is missing, no XML, of another version, incomplete, in unknown units, or turned by a
        `BasicTransform` with angles (no `UserAxis` to take instead).
    """
    import defusedxml.ElementTree

    try:
        data = read_regular(path)
        root: Element = defusedxml.ElementTree.fromstring(data)
    except OSError as error:
        raise DeviceError(f"calibration {path}: cannot be read ({error.strerror})") from error
    except Exception as error:
        raise DeviceError(f"calibration {path}: no XML ({error})") from error
    return _CalFile(path, root).calibration(hashlib.sha256(data).hexdigest())


def _reference_shift(offset: NDArray[np.float64]) -> NDArray[np.float64]:
    """T = [[I, 0], [[p]x, I]], which carries a wrench to an origin shifted by `offset` (3,): p = -offset."""
    x, y, z = -offset
    shift = np.eye(6)
    shift[3:, :3] = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
    return shift


class _CalFile:
    """The elements of one .cal file, refused with file and element where they are wrong."""

    def __init__(self, path: Path, root: Element) -> None:
        self._path = path
        self._root = root
        self._version = root.get("CalFileVersion", "")
        found = root.find("Calibration")
        if root.tag != "FTSensor" or found is None:
            raise self._wrong(f"root <{root.tag[:40]}>", "<FTSensor> with a <Calibration>")
        if self._version not in ("1.0", "1.1"):
            raise self._wrong(f"CalFileVersion = {self._version!r}", "1.0 or 1.1")
        self._calibration = found

    def calibration(self, fingerprint: str) -> AtiCalibration:
        """Give the calibration in SI."""
        units = self._row_units()
        rows = "UserAxis" if self._calibration.find("UserAxis") is not None else "Axis"
        if rows == "Axis" and self._version == "1.1":
            raise self._wrong("no <UserAxis>", "six of them in version 1.1")
        values, largest = self._rows(rows)
        matrix = values * units[:, None]
        if rows == "Axis":
            matrix = _reference_shift(self._offset()) @ (matrix / self._scales()[:, None])
        serial = self._root.get("Serial", "")
        return AtiCalibration(serial, matrix, largest * units, self._full_scale(), fingerprint)

    def _rows(self, tag: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        elements = {element.get("Name"): element for element in self._calibration.findall(tag)}
        if missing := [name for name in AXES if name not in elements]:
            raise self._wrong(f"<{tag}> without {', '.join(missing)}", "all of Fx Fy Fz Tx Ty Tz")
        ordered = [elements[name] for name in AXES]
        values = [self._numbers(element.get("values", ""), f"<{tag}> values") for element in ordered]
        if any(len(row) != 6 for row in values):
            raise self._wrong(f"<{tag}> values", "six numbers")
        largest = [self._numbers(element.get("max", "nan"), f"<{tag}> max")[0] for element in ordered]
        return np.array(values), np.array(largest)

    def _scales(self) -> NDArray[np.float64]:
        elements = {element.get("Name"): element for element in self._calibration.findall("Axis")}
        scales = [self._numbers(elements[name].get("scale", "0"), "<Axis> scale")[0] for name in AXES]
        if not all(scale > 0.0 for scale in scales):
            raise self._wrong(f"<Axis> scale = {scales}", "positive numbers")
        return np.array(scales)

    def _offset(self) -> NDArray[np.float64]:
        element = self._calibration.find("BasicTransform")
        if element is None:
            raise self._wrong("no <BasicTransform>", "one in version 1.0")
        turned = [self._numbers(element.get(key, "0"), key)[0] for key in ("Rx", "Ry", "Rz")]
        if any(turned):
            raise self._wrong(f"<BasicTransform> turned by {turned}", "no rotation (or a file of version 1.1)")
        shift = [self._numbers(element.get(key, "0"), key)[0] for key in ("Dx", "Dy", "Dz")]
        return np.array(shift) * self._unit("DistUnits", _DISTANCE)

    def _row_units(self) -> NDArray[np.float64]:
        return np.repeat([self._unit("ForceUnits", _FORCE), self._unit("TorqueUnits", _TORQUE)], 3)

    def _full_scale(self) -> float:
        output = self._numbers(self._calibration.get("OutputRange", "20"), "OutputRange")[0]
        bipolar = self._calibration.get("OutputBipolar", "True").lower() != "false"
        return output / 2.0 if bipolar else output

    def _unit(self, key: str, units: dict[str, float]) -> float:
        name = self._calibration.get(key, "")
        if name not in units:
            raise self._wrong(f"{key} = {name!r}", " or ".join(units))
        return units[name]

    def _numbers(self, text: str, what: str) -> list[float]:
        try:
            return [float(part) for part in text.split()]
        except ValueError:
            raise self._wrong(f"{what} = {text[:60]!r}", "numbers") from None

    def _wrong(self, what: str, allowed: str) -> DeviceError:
        return DeviceError(f"calibration {self._path}: {what}; allowed is {allowed}")
