"""The run with inertia: every mode of every wavenumber as an oscillator, exact for the force that it is given.

Under force control the force is linear within each step. Under depth control it is constant within each step and such
that the watched depth comes to its value at the end; a force linear in the step would alternate without bound. That
takes a tool whose depth is what its force works on: a rigid one. To drive one point under a uniform pressure has no
bounded answer once inertia counts.
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.integrators.lags import LagStep, creep, lag_step
from wavemodel.integrators.load_history import History, Load
from wavemodel.integrators.oscillators import OscillatorMotion
from wavemodel.integrators.viscoelastic import Damping, Prony

SAME_STEP = 1e-12
"""Steps that differ by less (relatively) are the same step; clocks round at 1e-14."""


@dataclass(frozen=True)
class ModalSystem:
    """N = K d oscillators, their static states scaled to the force, and what is read off them.

    Attributes
    ----------
    frequency
        (K, d) angular, rad/s.
    deflection
        (L, K, d) amplitude of each layer's top face per state, m3/N.
    outward
        (L + 1, K, d) amplitude in plane of each layer's top face and of the lowest one per state, m3/N.
    axis_weight
        (K,) in 1/m2: amplitudes times it sum to the deflection on the axis.
    depth
        (K, d) depth per state, m/N.
    remainder_depth
        Depth that the static remainder adds per force, m/N.
    remainder_axis
        (L,) what it adds to each layer's deflection on the axis, m/N.
    collocated
        Whether the depth is what the force works on (its rate times the force the power).
    damping
        Of the modes; its stiffness part also of the remainder.
    series
        Relaxation of all layers alike, also of the remainder.
    """

    frequency: FloatArray
    deflection: FloatArray
    outward: FloatArray
    axis_weight: FloatArray
    depth: FloatArray
    remainder_depth: float
    remainder_axis: FloatArray
    collocated: bool
    damping: Damping
    series: Prony


def integrate(load: Load, system: ModalSystem) -> History:
    """Run a load history with inertia.

    Raises
    ------
    WaveError
        Under depth control, if the depth is not what the force works on.
    """
    march = _March(system)
    n, by_depth = load.time.size, load.control == "depth"
    if by_depth and not system.collocated:
        raise WaveError(
            "depth control with inertia has no bounded answer under a uniform pressure: use a rigid tool, or the "
            "integrator 'quasi_static'"
        )
    force, depth, static = np.empty(n), np.empty(n), np.empty(n)
    amplitude = np.empty((n, *system.deflection.shape[:2]))
    for step, (duration, value) in enumerate(zip(load.durations.tolist(), load.value.tolist(), strict=True)):
        _advance(march, duration, value, by_depth)
        force[step], depth[step], static[step] = march.force, march.depth, march.static
        amplitude[step] = march.amplitude
    top = amplitude @ system.axis_weight + np.outer(static, system.remainder_axis)
    return History(
        force, depth, top, static[:, None], amplitude.__getitem__, outward=lambda step: _outward(load, system, step)
    )


def _outward(load: Load, system: ModalSystem, last: int) -> FloatArray:
    """(L + 1, K) amplitudes in plane after a step: the run is gone through again, for its states are not kept."""
    march = _March(system)
    for duration, value in zip(load.durations[: last + 1].tolist(), load.value[: last + 1].tolist(), strict=True):
        _advance(march, duration, value, load.control == "depth")
    return march.outward


def _advance(march: "_March", duration: float, value: float, by_depth: bool) -> None:
    if duration == 0.0:
        march.start(value, by_depth)
    elif by_depth:
        march.by_depth(duration, value)
    else:
        march.by_force(duration, value)


class _March:
    """State of a run: the oscillators, and what the static remainder answers to."""

    def __init__(self, system: ModalSystem) -> None:
        self.system = system
        self.motion = OscillatorMotion(system.frequency.ravel(), system.damping, system.series)
        self.creep = creep(system.series, system.damping.stiffness_time)
        self.lags = np.zeros(self.creep.time.size)
        self.force = 0.0
        self.weight = system.depth.ravel()
        self.duration = 0.0

    def start(self, target: float, by_depth: bool) -> None:
        """Static state of the first value."""
        self.force = target / self.static_compliance if by_depth else target
        self.motion.rest(self.force)
        self.lags[:] = self.force

    def by_force(self, duration: float, force: float) -> None:
        """Step with the force going linearly to `force`."""
        self._prepare(duration)
        self.motion.advance(self.force, force - self.force)
        self.lags = self.lag.keep * self.lags + self.lag.first * self.force + self.lag.last * force
        self.force = force

    def by_depth(self, duration: float, depth: float) -> None:
        """Step with the constant force that ends at `depth`."""
        self._prepare(duration)
        rest, kept = self.system.remainder_depth, self.lag.keep * self.lags
        free = float(self.weight @ self.motion.free()) + rest * float(self.creep.weight @ kept)
        self.force = (depth - free) / (self.gain + rest * self.rest_gain)
        self.motion.advance(self.force, 0.0)
        self.lags = kept + (1.0 - self.lag.keep) * self.force

    @property
    def static(self) -> float:
        """Force that the remainder answers to."""
        return self.creep.instant * self.force + float(self.creep.weight @ self.lags)

    @property
    def depth(self) -> float:
        return float(self.weight @ self.motion.displacement) + self.system.remainder_depth * self.static

    @property
    def amplitude(self) -> FloatArray:
        state = self.motion.displacement.reshape(self.system.frequency.shape)
        return np.asarray(np.einsum("lkd,kd->lk", self.system.deflection, state))

    @property
    def outward(self) -> FloatArray:
        state = self.motion.displacement.reshape(self.system.frequency.shape)
        return np.asarray(np.einsum("lkd,kd->lk", self.system.outward, state))

    @property
    def static_compliance(self) -> float:
        return (float(self.weight.sum()) + self.system.remainder_depth) / self.system.series.long_term

    def _prepare(self, duration: float) -> None:
        if abs(duration - self.duration) <= SAME_STEP * duration:
            return
        self.duration = duration
        self.motion.prepare(duration)
        self.lag: LagStep = lag_step(duration / self.creep.time)
        self.gain = float(self.weight @ self.motion.gain())
        self.rest_gain = self.creep.instant + float(self.creep.weight @ (1.0 - self.lag.keep))
