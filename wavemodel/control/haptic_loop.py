"""A tissue under the devices of hands: position in, force out, at 1 kHz and more, giving back no more than it got.

A force that is held between two samples is too small while the hand goes in and too large while it comes out: even a
perfect spring so gives energy away, K v^2 dt / 2 a second (J. E. Colgate and G. Schenkel 1997, J Robot Syst 14:37). The
loop therefore bounds the force by the energy that the hand has put in since it touched (as B. Hannaford and J.-H. Ryu
2002, IEEE Trans Robot Autom 18:1, observe it, and J.-P. Kim and J. Ryu 2010, Int J Robot Res 29:666, bound it).
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.control.haptic_device import HapticDevice
from wavemodel.control.interactive_tissue import InteractiveTissue
from wavemodel.errors import WaveError, require_positive

FASTEST = 0.15
"""m/s out of the tissue: an assumption about hands; `EnergyBound.overspeed` counts where it did not hold."""
LOAN = 5e-5
"""J: enough for the whole first force of 0.2 N at that speed."""


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
    hand, the force is nought.

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
        self._before, self._move = [0.0] * len(devices), [0.0] * len(devices)
        self._vector: FloatArray = np.zeros(3)

    def step(self) -> FloatArray:
        """Read all devices, go on by one frame, write; the forces (K,), N."""
        for contact, device in enumerate(self.devices):
            x, y, z = device.read().tolist()
            self._move[contact], self._before[contact] = z - self._before[contact], z
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
