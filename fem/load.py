"""The load history of a run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from fem.arrays import FloatArray
from fem.errors import FemError, require_one_of

Control = Literal["force", "depth"]


@dataclass(frozen=True)
class Load:
    """A history of prescribed force or depth; the state before the first step is unloaded, at rest, at time zero.

    Between the steps the prescribed value changes linearly. A first step at time zero is a sudden press.

    Attributes
    ----------
    control
        "force" (N) or "depth" (m): what is prescribed. Depth is the deflection of the top face on
        the tool axis (of the tool itself if it is rigid). Press is positive.
    time
        Times (n,) in s, increasing.
    value
        Prescribed values (n,) in N or m.

    Raises
    ------
    FemError
        If the arrays are empty, of different shapes, not finite, or time does not increase.
    """

    control: Control
    time: FloatArray
    value: FloatArray

    def __post_init__(self) -> None:
        require_one_of("load.control", self.control, ("force", "depth"))
        time = np.array(self.time, dtype=np.float64)
        value = np.array(self.value, dtype=np.float64)
        if time.ndim != 1 or time.size == 0 or time.shape != value.shape:
            raise FemError(
                f"load.time has shape {time.shape}, load.value {value.shape}: "
                "both must be one-dimensional, of one length, with at least one step"
            )
        _require_finite("load.time", time, "s")
        _require_finite("load.value", value, self.unit)
        if np.any(np.diff(time) <= 0.0):
            k = int(np.argmax(np.diff(time) <= 0.0)) + 1
            raise FemError(f"load.time[{k}] = {time[k]:g} s after {time[k - 1]:g} s: time must increase")
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "value", value)

    @property
    def start(self) -> float:
        """Time in s of the state at rest: zero, or the first step's if that is not after zero (a sudden press)."""
        return min(0.0, float(self.time[0]))

    @property
    def unit(self) -> str:
        """Unit of the prescribed value."""
        return "N" if self.control == "force" else "m"


def _require_finite(name: str, array: FloatArray, unit: str) -> None:
    bad = np.flatnonzero(~np.isfinite(array))
    if bad.size:
        raise FemError(f"{name}[{bad[0]}] = {array[bad[0]]} {unit}: must be finite")
