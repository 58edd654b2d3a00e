"""A tissue under the devices of hands: position in, force out, at 1 kHz and more, giving back no more than it got.

A force that is held between two samples is too small while the hand goes in and too large while it comes out: even a
perfect spring so gives energy away, K v^2 dt / 2 a second (J. E. Colgate and G. Schenkel 1997, J Robot Syst 14:37). The
loop therefore bounds the force by the energy that the hand has put in since it touched (as B. Hannaford and J.-H. Ryu
2002, IEEE Trans Robot Autom 18:1, observe it, and J.-P. Kim and J. Ryu 2010, Int J Robot Res 29:666, bound it).

A device has three degrees of freedom. Positions are (3,) in m: x and y on the tissue, z downwards from its untouched
surface, so that z > 0 presses. Forces are what the device puts on the hand, (3,) in N along the same axes.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import isfinite
from typing import Protocol

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.control.interactive_tissue import InteractiveTissue
from wavemodel.errors import WaveError, require_positive

FASTEST = 0.15
"""m/s out of the tissue: an assumption about hands; `EnergyBound.overspeed` counts where it did not hold."""
LOAN = 5e-5
"""J: enough for the whole first force of 0.2 N at that speed."""

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
        If time, mass or stiffness is not positive.
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


@dataclass
class EnergyBound:
    """Lets through no more force than the energy in hand pays for, whatever the next sample brings.

    With E in hand and a hand no faster than v, a force of E / (v dt) held for one sample gives back E at most. On the
    way in a small loan is added, or the first contact would be felt by nobody; on the way out and at rest there is
    none, so that a press ends with nothing lost to the hand. A debt (a touch drawn back within the first samples) is
    kept and paid by the next press: over any time the hand never gains more than the loan. A tool that is deep in the
    tissue at its first sample has put nothing in, and feels nothing until it moves in.

    Attributes
    ----------
    fastest
        v in m/s.
    loan
        In J.
    energy
        What the hand has put in since the touch, less what it owes, J.
    overspeed
        Samples in which it came out faster than v, for which nothing is promised.
    """

    fastest: float = FASTEST
    loan: float = LOAN
    energy: float = 0.0
    overspeed: int = 0

    def paid(self, held: float, move: float, dt: float) -> None:
        """Book the work of a force `held` (N) against a `move` (m) into the tissue that took dt (s)."""
        self.energy += held * move
        self.overspeed += move < -self.fastest * dt

    def bounded(self, force: float, move: float, dt: float) -> float:
        """The force, or as much of it as the energy allows after a last move (m), N."""
        backed = self.energy + (self.loan if move > 0.0 else 0.0)
        return min(force, max(backed, 0.0) / (self.fastest * dt))

    def lifted(self) -> None:
        """The tool has left the tissue: what is in hand stays in the tissue, what is owed is kept."""
        self.energy = min(self.energy, 0.0)


class HapticLoop:
    """One or more devices on a tissue, each on the contact of its number.

    Forces act along the press; the tissue's surface carries no shear. A tool that leaves the grid, or rises above the
    untouched surface, lets go; one that goes deeper than the model answers feels the force at its end; one that moves
    to where another tool is stays where it was. No tool is pulled: where the tissue creeps back more slowly than the
    hand, the force is nought. A sample with a number that is not finite is dropped: the tool stays where it was.

    Parameters
    ----------
    tissue
        What is pressed.
    devices
        K devices of hands.
    dt
        Time of a step, s.
    bound
        Makes a device's bound of the energy; None renders the model's forces as they are.

    Attributes
    ----------
    force
        (K,) last forces along the press, N, against the hands. The same memory at every step.
    bounds
        K bounds, or none.
    dropped
        Samples that were not finite.

    Raises
    ------
    WaveError
        If the time is not positive, or there are more devices than contacts.
    """

    def __init__(
        self,
        tissue: InteractiveTissue,
        devices: Sequence[HapticDevice],
        dt: float = 1e-3,
        bound: Callable[[], EnergyBound] | None = EnergyBound,
    ) -> None:
        require_positive("haptic loop: dt", dt, "s")
        for contact in range(len(devices)):
            tissue.presses(contact)
        self.tissue, self.devices, self.dt = tissue, tuple(devices), dt
        self.force: FloatArray = np.zeros(len(devices))
        self.bounds = () if bound is None else tuple(bound() for _ in devices)
        self.dropped = 0
        self._at: list[list[float]] = [[0.0] * 3 for _ in devices]
        self._move = [0.0] * len(devices)
        self._vector: FloatArray = np.zeros(3)

    def step(self) -> FloatArray:
        """Read all devices, go on by one frame, write; the forces (K,), N."""
        for contact, device in enumerate(self.devices):
            x, y, z = self._read(contact, device)
            if self.bounds:
                self.bounds[contact].paid(float(self.force[contact]), self._move[contact], self.dt)
            self._touch(contact, x, y, z)
        self.tissue.advance(self.dt)
        for contact, device in enumerate(self.devices):
            force = max(float(self.tissue.force[contact]), 0.0)
            if self.bounds:
                force = self.bounds[contact].bounded(force, self._move[contact], self.dt)
            self.force[contact] = force
            self._vector[2] = -force
            device.write(self._vector)
        return self.force

    def run(self, steps: int) -> FloatArray:
        """(steps, K) forces along the press of so many steps, N."""
        return np.array([self.step().copy() for _ in range(steps)])

    def _read(self, contact: int, device: HapticDevice) -> list[float]:
        """Where a device is, m: where it was before if it does not say."""
        before, at = self._at[contact], device.read().tolist()
        if not all(map(isfinite, at)):
            self.dropped += 1
            at = before
        self._move[contact], self._at[contact] = at[2] - before[2], at
        return list(at)

    def _touch(self, contact: int, x: float, y: float, z: float) -> None:
        """Put a tool where its device is, or let go."""
        tissue = self.tissue
        if z > 0.0 and tissue.grid.holds(x, y):
            with suppress(WaveError):  # another tool holds the place
                tissue.touch(contact, x, y, min(z, tissue.body.deepest))
            return
        if tissue.presses(contact):
            tissue.release(contact)
        if self.bounds:
            self.bounds[contact].lifted()
