"""What the simulated force sensor makes of a force: axes, lever, noise, drift, saturation, counts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench_hw.simulated.specimen import FloatArray

NANO17_RANGES = (25.0, 25.0, 35.0, 0.25, 0.25, 0.25)
"""Ranges of a Nano17 SI-25-0.25: Fx, Fy, Fz in N, Tx, Ty, Tz in N m."""


@dataclass(frozen=True, slots=True)
class SensorModel:
    """A six-axis sensor above the tool.

    Parameters
    ----------
    press_axis : str
        Axis and sign along which a press shows, for instance `-z`: pressing gives a negative Fz.
    lever : float
        Distance from the tool's face to the sensor's origin, m: sideways forces show as torques.
    force_noise, torque_noise : float
        Standard deviations of a sample, N and N m.
    drift : float
        Creep of the press axis, N/s.
    ranges : tuple of 6 floats
        Largest magnitudes of Fx..Tz, N and N m; beyond them the reading stops and is marked saturated.
    """

    press_axis: str = "-z"
    lever: float = 0.070
    force_noise: float = 2e-3
    torque_noise: float = 2e-5
    drift: float = 0.0
    ranges: tuple[float, ...] = NANO17_RANGES

    def wrench(self, force: FloatArray, elapsed: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Read a force.

        Parameters
        ----------
        force : ndarray (n, 3)
            Force on the tool, N: sideways x and y, press.
        elapsed : ndarray (n,)
            Time since the sensor was switched on, s.
        rng : numpy.random.Generator
            Source of the noise.

        Returns
        -------
        ndarray (n, 6)
            Fx..Tz before saturation, N and N m.
        """
        sign = -1.0 if self.press_axis[0] == "-" else 1.0
        axis = "xyz".index(self.press_axis[1])
        sideways = [other for other in range(3) if other != axis]
        wrench = np.zeros((len(force), 6))
        wrench[:, axis] = sign * (force[:, 2] + self.drift * elapsed)
        wrench[:, sideways] = force[:, :2]
        wrench[:, 3 + sideways[0]] = -self.lever * force[:, 1]
        wrench[:, 3 + sideways[1]] = self.lever * force[:, 0]
        noise = np.repeat([self.force_noise, self.torque_noise], 3)
        return wrench + noise * rng.standard_normal(wrench.shape)

    def saturated(self, wrench: FloatArray) -> tuple[FloatArray, np.ndarray]:
        """Stop at the ranges: the wrench (n, 6) as it can be read, and which rows (n,) are saturated."""
        largest = np.asarray(self.ranges)
        return np.clip(wrench, -largest, largest), np.any(np.abs(wrench) > largest, axis=1)
