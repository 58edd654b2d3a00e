"""`SimulatedVoltages`: the six gauge voltages of a transducer under a load, as a `VoltageSource` for the DAQ driver."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bench_hw.clock import Clock
from bench_hw.simulated.sensor import SensorModel
from bench_hw.simulated.specimen import FloatArray


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
