"""What a simulated transducer reads: axes, lever, noise, drift and saturation as a wrench, or as six gauge voltages."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bench_hw.clock import Clock
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


class SimulatedVoltages:
    """A DAQ with a transducer on it.

    Parameters
    ----------
    load : callable
        Force on the tool at instants (n,) of the clock, (n, 3) N: sideways x and y, press.
    matrix : ndarray (6, 6)
        Wrench (N, N m) per volt of the transducer; its inverse makes the voltages.
    clock : Clock
        The DAQ's clock.
    sensor : SensorModel
        Axes, noise and drift.
    rng : numpy.random.Generator
        Source of the noise.
    offset : ndarray (6,), optional
        Voltages without load, V.
    full_scale : float
        Voltage at which the inputs stop, V.
    """

    name = "simulated DAQ"

    def __init__(
        self,
        load: Callable[[FloatArray], FloatArray],
        matrix: FloatArray,
        clock: Clock,
        sensor: SensorModel,
        rng: np.random.Generator,
        *,
        offset: FloatArray | None = None,
        full_scale: float = 10.0,
    ) -> None:
        self._load, self._clock, self._sensor, self._rng = load, clock, sensor, rng
        self._inverse = np.linalg.inv(matrix)
        self._offset = np.zeros(6) if offset is None else offset
        self._full_scale = full_scale
        self._rate = 0.0
        self._began = 0.0
        self._taken = 0

    def start(self, rate: float) -> float:
        """Begin to sample; the rate is the one asked for."""
        self._rate, self._began, self._taken = rate, self._clock.now(), 0
        return rate

    def available(self) -> int:
        """Give the number of samples waiting."""
        return max(0, int((self._clock.now() - self._began) * self._rate + 1e-6) - self._taken)

    def read(self, n: int) -> FloatArray:
        """Take the n oldest samples, (n, 6), V."""
        elapsed = np.asarray(np.arange(self._taken + 1, self._taken + n + 1) / self._rate)
        self._taken += n
        wrench = self._sensor.wrench(self._load(self._began + elapsed), elapsed, self._rng)
        volts = wrench @ self._inverse.T + self._offset
        return np.asarray(np.clip(volts, -self._full_scale, self._full_scale))

    def close(self) -> None:
        """Stop."""
        self._rate = 0.0
