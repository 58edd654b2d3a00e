"""A body without inertia whose layers creep each in its own way: one field for each of a few shared lags."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray, NumberArray
from wavemodel.integrators.lag_sum import LagSum
from wavemodel.integrators.load import Load


@dataclass(frozen=True)
class LayerwiseBody:
    """B = 1 + M fields: the first answers at once, the others as lags of the force (a `StaticBody`).

    Attributes
    ----------
    unit
        (B, L, K) amplitudes per force, m3/N.
    axis
        (B, L) deflection of each layer's top face on the axis per force, m/N.
    depth
        (B,) depth per force, m/N; the first is zero under Kelvin-Voigt damping.
    rate
        (M,) of the lags, 1/s.
    """

    unit: FloatArray
    axis: FloatArray
    depth: FloatArray
    rate: FloatArray

    def follow(self, load: Load) -> tuple[FloatArray, FloatArray, FloatArray]:
        """(n, B) course, (n,) force, (n,) depth; exact for a force, or depth, linear in each step."""
        if load.control == "force":
            lags = self._lags(load, load.value, 1.0 / self.rate)
            course = np.concatenate([load.value[:, None], lags.T], axis=1)
            return course, load.value, course @ self.depth
        inverse = self._inverse
        lags = self._lags(load, load.value, inverse.time)
        state = np.outer(load.value, inverse.direct) + np.real(lags.T @ inverse.states.T)
        force = inverse.force_by_depth * load.value + state @ inverse.force_by_state
        if inverse.force_by_rate:
            rate = LagSum(0.0, np.empty(0), np.empty(0), inverse.force_by_rate)
            force = force + rate.follow(load.durations, load.value, rate.rest(load.initial(load.value)))[0]
        return np.concatenate([force[:, None], state], axis=1), force, load.value

    @staticmethod
    def _lags(load: Load, driven: FloatArray, time: NumberArray) -> NumberArray:
        bank = LagSum(0.0, np.ones(time.size), time)
        return bank.lags(load.durations, driven, bank.rest(load.initial(driven)))

    @cached_property
    def _inverse(self) -> "_DepthDriven":
        """Driven by depth d = c_0 F + c y, the lags y' = rate (F - y) obey y' = A y + b d or, with c_0 = 0, b d'."""
        first, rest = self.depth[0], self.depth[1:]
        pull = self.rate * rest
        if first > 0.0:
            matrix = -np.diag(self.rate) - np.outer(self.rate, rest) / first
            values, shapes = np.linalg.eig(matrix)
            driven = np.linalg.solve(shapes, (self.rate / first).astype(shapes.dtype))
            return _DepthDriven(
                -1.0 / values, -shapes * (driven / values), np.zeros(rest.size), 1.0 / first, -rest / first, 0.0
            )
        direct = self.rate / pull.sum()
        values, shapes = np.linalg.eig(-np.diag(self.rate) + np.outer(self.rate, pull) / pull.sum())
        driven = np.linalg.solve(shapes, direct.astype(shapes.dtype))
        kept = np.arange(values.size) != np.abs(values).argmin()
        return _DepthDriven(
            -1.0 / values[kept], -(shapes * driven)[:, kept], direct, 0.0, pull / pull.sum(), 1.0 / pull.sum()
        )


@dataclass(frozen=True)
class _DepthDriven:
    """The M lags of the force from lags of the depth, and the force from both.

    Attributes
    ----------
    time, states
        (m,) times of lags of the depth and (M, m) what they add to the lags of the force.
    direct
        (M,) what the depth itself adds.
    force_by_depth, force_by_state, force_by_rate
        The force per depth, per lag (M,) and per rate of depth.
    """

    time: NumberArray
    states: NumberArray
    direct: FloatArray
    force_by_depth: float
    force_by_state: FloatArray
    force_by_rate: float
