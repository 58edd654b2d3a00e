"""Devices of a haptic loop: a position in, a force out, three degrees of freedom each; here those without hardware.

Positions are (3,) in m: x and y on the tissue, z downwards from its untouched surface, so that z > 0 presses. Forces
are what the device puts on the hand, (3,) in N along the same axes.
"""

from collections.abc import Callable
from typing import Protocol

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError, require_positive

Plan = Callable[[float], FloatArray]
"""Time in s to where the hand wants to be, (3,) in m."""


class HapticDevice(Protocol):
    """One hand's device. A driver of hardware has these two functions, and may wait in `read` for the next sample."""

    def read(self) -> FloatArray:
        """(3,) where the tool is, m."""
        ...

    def write(self, force: FloatArray) -> None:
        """Put a force (3,), N, on the hand until the next one."""
        ...


class SimulatedDevice:
    """A hand that pulls a tool along a plan by a spring and a damper, and gives way to the force it feels.

    The arm of an operator at a haptic device is about that (N. Hogan 1989, IEEE ICRA, 1626-1631; 10 to 500 N/m).

    Parameters
    ----------
    plan
        Where the hand wants to be.
    dt
        Time between two reads, s.
    mass
        Of the tool and what moves with it, kg.
    stiffness, damping
        Of the hand, N/m and N s/m.

    Attributes
    ----------
    position, velocity
        (3,) of the tool, m and m/s.
    force
        (3,) felt now, N.
    energy
        What the device has given to the hand since the beginning, J; negative where the hand gave it.

    Raises
    ------
    WaveError
        If a value is not positive.
    """

    def __init__(
        self, plan: Plan, dt: float = 1e-3, mass: float = 0.1, stiffness: float = 400.0, damping: float = 8.0
    ) -> None:
        for name, value, unit in (("dt", dt, "s"), ("mass", mass, "kg"), ("stiffness", stiffness, "N/m")):
            require_positive(f"device: {name}", value, unit)
        self._plan, self._dt, self._mass, self._stiffness, self._damping = plan, dt, mass, stiffness, damping
        self._time = 0.0
        self.position: FloatArray = np.array(plan(0.0), dtype=np.float64)
        self.velocity: FloatArray = np.zeros(3)
        self.force: FloatArray = np.zeros(3)
        self.energy = 0.0

    def read(self) -> FloatArray:
        """Move the tool by one step under the force felt, and say where it is."""
        self._time += self._dt
        pull = self._stiffness * (self._plan(self._time) - self.position) - self._damping * self.velocity + self.force
        self.velocity += pull * (self._dt / self._mass)
        move = self.velocity * self._dt
        self.position += move
        self.energy += float(self.force @ move)
        return self.position

    def write(self, force: FloatArray) -> None:
        """Feel a force from now on."""
        self.force[:] = force


class RecordedDevice:
    """A stream of positions replayed as a device; the forces it is given are kept.

    Parameters
    ----------
    time
        (n,) s, rising.
    position
        (n, 3) m.
    dt
        Time between two reads, s; between the instants the position is linear.

    Attributes
    ----------
    force
        List of what was written, (3,) each, N.

    Raises
    ------
    WaveError
        If the stream is not usable.
    """

    def __init__(self, time: FloatArray, position: FloatArray, dt: float = 1e-3) -> None:
        require_positive("device: dt", dt, "s")
        time, position = np.asarray(time, dtype=np.float64), np.asarray(position, dtype=np.float64)
        if time.ndim != 1 or time.size < 2 or position.shape != (time.size, 3):
            raise WaveError(f"stream: times {time.shape} and positions {position.shape}; (n,) and (n, 3) with n > 1")
        if not (np.isfinite(position).all() and np.all(np.diff(time) > 0.0)):
            raise WaveError("stream: finite positions are needed, and times that rise")
        self.steps = int((time[-1] - time[0]) / dt + 1e-9) + 1
        instants = time[0] + dt * np.arange(self.steps)
        self._positions = np.column_stack([np.interp(instants, time, axis) for axis in position.T])
        self._next = 0
        self.force: list[FloatArray] = []

    def read(self) -> FloatArray:
        """The next position, the last one for good."""
        row = self._positions[min(self._next, self.steps - 1)]
        self._next += 1
        return np.asarray(row)

    def write(self, force: FloatArray) -> None:
        """Keep a force."""
        self.force.append(np.array(force))
