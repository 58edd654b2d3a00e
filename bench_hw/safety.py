"""What must never happen to a specimen, and how it is noticed. Pure logic: it says what is wrong, others act.

Checked on each sample of force: that it is a number and not the same one for long, the force limit, the sensor's
ranges, saturation, faults in its status word. Checked at each turn of the capture's loop: force data that is stale
(silent, or repeating one sample), a position outside the travel, a camera that fell silent or repeats one picture.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench_hw.devices.protocols import ForceBlock
from bench_hw.devices.rdt import describe, is_fault, is_saturated
from bench_hw.errors import DeviceError

CAMERA_SILENT = 1.0
"""Time without a frame after which the camera counts as lost, s; of a slow one, as many periods as `MISSED`."""
MISSED = 3
FROZEN = 0.25
"""How long all six components may stay the same to the last digit, s: a live sensor's noise moves them."""
FEWEST_FROZEN = 5
"""Samples that must be the same before a sensor counts as frozen, however slowly they come."""
_NAMES = ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")


class SafetyError(DeviceError):
    """Something that ends a trial with the tool going back.

    Parameters
    ----------
    kind : str
        A short name: `force_limit`, `force_range`, `force_saturated`, `force_status`, `force_invalid`,
        `force_frozen`, `force_stale`, `travel`, `camera_lost`, `camera_frozen`.
    message : str
        One sentence with values and units.
    time : float
        When it was the case, s of the bench's clock.
    """

    def __init__(self, kind: str, message: str, time: float) -> None:
        super().__init__(message)
        self.kind = kind
        self.time = time


@dataclass(frozen=True, slots=True)
class SafetyLimits:
    """The limits of a rig.

    Parameters
    ----------
    force_limit : float
        Largest force of any direction, N.
    force_stale : float
        Longest time without new force data, s.
    travel : tuple of 2 floats
        Lowest and highest position of the actuator, m.
    ranges : tuple of 6 floats
        Largest magnitudes of Fx..Tz of the sensor, N and N m; NaN where unknown.
    force_frozen : float
        Longest time in which no component of the force changes, s; infinite where that is no sign of a fault.
    camera_silent, camera_frozen : float
        Longest time without a picture, and with none but repeated ones, s; the second is infinite where that is no
        sign of a fault.
    """

    force_limit: float = 6.0
    force_stale: float = 0.050
    travel: tuple[float, float] = (0.0, 0.050)
    ranges: tuple[float, ...] = (np.nan,) * 6
    force_frozen: float = np.inf
    camera_silent: float = CAMERA_SILENT
    camera_frozen: float = np.inf


class SafetyMonitor:
    """Watches one trial.

    Parameters
    ----------
    limits : SafetyLimits
        What is allowed.
    started : float
        Reading of the clock now, s: data is fresh from here.
    tolerance : float
        How far the position may read beyond the travel, m.
    """

    def __init__(self, limits: SafetyLimits, started: float, tolerance: float = 0.0) -> None:
        self._limits, self._tolerance = limits, tolerance
        self._ranges = np.where(np.isnan(limits.ranges), np.inf, limits.ranges)
        self._fresh = self._camera = self._picture = started
        self._sample: int | None = None
        self._same = np.full(6, np.nan)
        self._same_since, self._same_count = started, 0

    def check_force(self, block: ForceBlock) -> None:
        """Check each sample of a block.

        Raises
        ------
        SafetyError
            The first thing that is wrong.
        """
        if not len(block):
            return
        self._note_fresh(block)
        self._check_status(block)
        self._check_numbers(block)
        self._check_moving(block)
        magnitude = np.sqrt(np.einsum("ij,ij->i", block.wrench[:, :3], block.wrench[:, :3]))
        over = magnitude > self._limits.force_limit
        if over.any():
            row = int(np.argmax(over))
            raise SafetyError(
                "force_limit",
                f"force of {magnitude[row]:.3f} N is above the limit of {self._limits.force_limit:g} N",
                float(block.time[row]),
            )
        self._check_ranges(block)

    def check_fresh(self, now: float) -> None:
        """Check that force data still comes.

        Raises
        ------
        SafetyError
            The newest is older than allowed.
        """
        age = now - self._fresh
        if age > self._limits.force_stale:
            raise SafetyError(
                "force_stale",
                f"no new force data for {age * 1e3:.0f} ms; allowed are {self._limits.force_stale * 1e3:g} ms",
                now,
            )

    def check_position(self, position: float, now: float) -> None:
        """Check that the actuator is inside its travel.

        Raises
        ------
        SafetyError
            It is not.
        """
        low, high = self._limits.travel
        if not low - self._tolerance <= position <= high + self._tolerance:
            raise SafetyError(
                "travel",
                f"position {position * 1e3:.2f} mm is outside the travel of {low * 1e3:g} to {high * 1e3:g} mm",
                now,
            )

    def check_camera(self, frames: int, now: float, repeated: int = 0) -> None:
        """Check that the camera still gives pictures.

        Parameters
        ----------
        frames : int
            How many came since the last call.
        now : float
            Reading of the clock, s.
        repeated : int
            How many of them are the one before to the byte.

        Raises
        ------
        SafetyError
            None came for a second, or none that differed.
        """
        if frames:
            self._camera = now
        elif now - self._camera > self._limits.camera_silent:
            raise SafetyError("camera_lost", f"no frame for {now - self._camera:.1f} s", now)
        if frames > repeated:
            self._picture = now
        elif now - self._picture > self._limits.camera_frozen:
            still = f"each picture has been the one before to the byte for {now - self._picture:.1f} s"
            raise SafetyError("camera_frozen", f"{still}: the camera hangs, or is covered", now)

    def _note_fresh(self, block: ForceBlock) -> None:
        """Data is fresh while its sample numbers move: a box that repeats one sample is stale."""
        samples = block.ft_sequence
        last = int(samples[-1])
        others = np.flatnonzero(samples != last)
        first = int(others[-1]) + 1 if len(others) else 0
        if len(others) or last != self._sample:
            self._fresh = max(self._fresh, float(block.time[first]))
        self._sample = last

    def _check_status(self, block: ForceBlock) -> None:
        if not block.status.any():
            return
        for row in np.flatnonzero(block.status):
            status, time = int(block.status[row]), float(block.time[row])
            if is_saturated(status):
                raise SafetyError("force_saturated", "the force sensor is saturated: its reading is too small", time)
            if is_fault(status):
                raise SafetyError("force_status", f"force sensor status {status:#010x}: {describe(status)}", time)

    def _check_numbers(self, block: ForceBlock) -> None:
        """No limit holds back what is no number."""
        wrong = ~np.isfinite(block.wrench)
        if wrong.any():
            row, axis = (int(index) for index in np.argwhere(wrong)[0])
            raise SafetyError(
                "force_invalid",
                f"the force sensor gives {_NAMES[axis]} = {block.wrench[row, axis]:g}; allowed are finite numbers",
                float(block.time[row]),
            )

    def _check_moving(self, block: ForceBlock) -> None:
        """Samples that are numbered on but never change tell nothing of the force, and no limit would be seen."""
        before = np.vstack([self._same, block.wrench[:-1]])
        changed = np.flatnonzero((block.wrench != before).any(axis=1))
        if len(changed):
            first = int(changed[-1])
            self._same_since, self._same_count = float(block.time[first]), len(block) - first
        else:
            self._same_count += len(block)
        self._same = block.wrench[-1]
        age = float(block.time[-1]) - self._same_since
        if age > self._limits.force_frozen and self._same_count >= FEWEST_FROZEN:
            raise SafetyError(
                "force_frozen",
                f"the force sensor repeats one value: no component has changed by one digit for {age * 1e3:.0f} ms; "
                f"allowed are {self._limits.force_frozen * 1e3:g} ms (safety.force_frozen)",
                float(block.time[-1]),
            )

    def _check_ranges(self, block: ForceBlock) -> None:
        over = np.abs(block.wrench) > self._ranges
        if over.any():
            row, axis = (int(index) for index in np.argwhere(over)[0])
            raise SafetyError(
                "force_range",
                f"{_NAMES[axis]} = {block.wrench[row, axis]:.3f} is beyond the sensor's range of "
                f"{self._ranges[axis]:g} {'N' if axis < 3 else 'N m'}",
                float(block.time[row]),
            )
