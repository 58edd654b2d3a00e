"""How the simulated actuator moves: towards its target at its speed, with limited acceleration, and then stands.

It stops as soon as its own reading, in whole counts, is inside the dead band around the target, as the LAC
board does: it stands up to the dead band short of where it was sent.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


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
    """

    stroke: float
    acceleration: float = 0.5
    position: float = 0.0
    velocity: float = 0.0
    target: float = 0.0
    speed: float = 0.020
    dead_band: float = 0.0
    resolution: float = 0.0

    def step(self, duration: float) -> None:
        """Move on by `duration` seconds."""
        wanted = self._wanted_velocity()
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
