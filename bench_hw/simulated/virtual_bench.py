"""`VirtualBench`: a specimen under a tool on an actuator, as it was at every instant; the twins ask it.

Nothing runs by itself: asking for an instant moves the bench on to it, in steps of `step`. Safe to use from several
threads. The actuator moves towards its target at its speed, with limited acceleration, and stops as soon as its own
reading, in whole counts, is inside the dead band around the target, as the LAC board does. Only the last seconds are
kept, so that an hour takes no more memory than a minute.
"""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass

import numpy as np

from bench_hw.simulated.specimen import FloatArray, Specimen

KEPT = 10.0
"""Seconds that a bench looks back at least; who asks for more gets the oldest instant that is kept."""


@dataclass(slots=True)
class ActuatorMotion:
    """State of the moving part; lengths from fully retracted.

    Parameters
    ----------
    stroke : float
        Mechanical end, m.
    acceleration : float
        Largest acceleration, m/s^2.
    position, velocity : float
        m and m/s.
    target : float
        Where it was sent, m.
    speed : float
        Speed it was set to, m/s.
    dead_band : float
        It stands while its reading is this close to the target, m.
    resolution : float
        One count of its reading, m; 0 reads exactly.
    dead_time : float
        How long it takes to leave rest, s.
    waited : float
        Of that, what is over, s.
    """

    stroke: float
    acceleration: float = 0.5
    position: float = 0.0
    velocity: float = 0.0
    target: float = 0.0
    speed: float = 0.020
    dead_band: float = 0.0
    resolution: float = 0.0
    dead_time: float = 0.0
    waited: float = 0.0

    def step(self, duration: float) -> None:
        """Move on by `duration` seconds."""
        wanted = self._wanted_velocity()
        self.waited = self.waited + duration if wanted and not self.velocity else 0.0
        if 0.0 < self.waited <= self.dead_time:
            return
        change = self.acceleration * duration
        self.velocity += min(max(wanted - self.velocity, -change), change)
        self.position += self.velocity * duration
        if not 0.0 <= self.position <= self.stroke:
            self.position, self.velocity = min(max(self.position, 0.0), self.stroke), 0.0

    def reading(self) -> float:
        """Position as the board reads it, m: the nearest whole count."""
        return round(self.position / self.resolution) * self.resolution if self.resolution else self.position

    def _wanted_velocity(self) -> float:
        error = self.target - self.position
        if abs(self.target - self.reading()) <= self.dead_band + 1e-12:
            return 0.0
        braking = math.sqrt(2.0 * self.acceleration * abs(error))
        return math.copysign(min(self.speed, braking), error)


class VirtualBench:
    """The physics that the twins share.

    Parameters
    ----------
    specimen : Specimen
        What is pressed.
    motion : ActuatorMotion
        What moves the tool; changed only under `lock`.
    contact : float
        Position of the actuator at which the tool meets the resting specimen, m.
    start : float
        Reading of the bench's clock now, s.
    step : float
        Length of a step of the physics, s.
    kept : float
        How far back force, depth and the specimen's history are kept at least, s.
    """

    def __init__(
        self,
        specimen: Specimen,
        motion: ActuatorMotion,
        *,
        contact: float,
        start: float = 0.0,
        step: float = 1e-3,
        kept: float = KEPT,
    ) -> None:
        self.lock = threading.RLock()
        self.motion = motion
        self._specimen, self._contact = specimen, contact
        self._start, self._step = start, step
        self._kept = max(round(kept / step), 2)
        self._rows, self._gone = 1, 0  # since the start, and of them those that are forgotten
        self._time, self._depth = np.zeros(2 * self._kept), np.zeros(2 * self._kept)
        self._force = np.zeros((2 * self._kept, 3))
        self._depth[0] = motion.position - contact
        self._respond(0)

    def lay(self, specimen: Specimen, contact: float, dead_time: float = 0.0) -> None:
        """Put a specimen under the tool, in the air, its surface at `contact` (m); the drive leaves rest late (s)."""
        with self.lock:
            self._specimen, self._contact = specimen, contact
            self.motion.dead_time = dead_time

    def advance(self, now: float) -> None:
        """Move the bench on to the reading `now`; earlier readings change nothing."""
        with self.lock:
            due = int((now - self._start) / self._step + 1e-6) + 1
            while self._rows < due:
                self._move_on(min(due, self._rows + self._kept))

    def force_at(self, instants: FloatArray) -> FloatArray:
        """Force on the tool (n, 3), N (sideways x and y, press), at `instants` (n,), s of the clock, not decreasing.

        An instant that is forgotten is answered by the oldest that is kept.
        """
        span = self._kept * self._step
        parts = np.split(instants, np.flatnonzero(np.diff((instants - instants[0]) // span)) + 1)
        with self.lock:
            return np.concatenate([self._force_within(part - self._start) for part in parts])

    def markers_at(self, now: float) -> FloatArray:
        """Markers (m, 3) on the lower face at the reading `now`, m: x, y and how far each has sunk."""
        with self.lock:
            self.advance(now)
            row = int((now - self._start) / self._step + 0.5) - self._gone
            row = min(self._rows - self._gone - 1, max(0, row))
            markers: FloatArray = self._specimen(self._time[: row + 1], self._depth[: row + 1], row).markers[0]
            return markers

    def depth(self) -> float:
        """Depth of the tool's face below the resting surface, m."""
        with self.lock:
            return float(self._depth[self._rows - self._gone - 1])

    def _force_within(self, since: FloatArray) -> FloatArray:
        """Force (n, 3) at instants since the start that are all kept at one time."""
        self.advance(self._start + float(since[-1]))
        first = max(0, int(since[0] / self._step) - 1 - self._gone)
        rows = slice(first, self._rows - self._gone)
        return np.stack([np.interp(since, self._time[rows], self._force[rows, axis]) for axis in range(3)], axis=-1)

    def _move_on(self, due: int) -> None:
        """Move on until there are `due` rows since the start."""
        if due - self._gone > len(self._time):
            self._forget()
        first, end = self._rows - self._gone, due - self._gone
        for row in range(first, end):
            self.motion.step(self._step)
            self._depth[row] = self.motion.position - self._contact
        self._time[first:end] = self._step * np.arange(self._rows, due)
        self._rows = due
        self._respond(first)

    def _respond(self, first: int) -> None:
        end = self._rows - self._gone
        self._force[first:end] = self._specimen(self._time[:end], self._depth[:end], first).force

    def _forget(self) -> None:
        """Move the rows that must be kept to the front."""
        rows = slice(self._rows - self._gone - self._kept, self._rows - self._gone)
        for kept in (self._time, self._depth, self._force):
            kept[: self._kept] = kept[rows].copy()
        self._gone = self._rows - self._kept
