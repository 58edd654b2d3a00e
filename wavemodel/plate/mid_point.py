"""Motion of Kirchhoff's and Carrier's wave by the mid-point rule, which keeps its energy.

    M (v1 - v0) / h + C (v0 + v1) / 2 + (K + (T0 + N) G) (x0 + x1) / 2 + N n = F e,    N = (N(x0) + N(x1)) / 2.

With this mean the work of the tension on the step is the change of N^2 / 2 beta exactly, so without load and damping
the energy stays, whatever the step. The one unknown that enters non-linearly is the number N.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.integrators.damping import Damping
from wavemodel.integrators.load import Load
from wavemodel.plate.carrier import Carrier

CORRECTIONS = 60
ROUNDING = 4.0 * float(np.finfo(np.float64).eps)
SAME_STEP = 1e-12
_Half: TypeAlias = Callable[[float], tuple[FloatArray, float, float]]
"""Mean of N to the change of the amplitudes half-way, the force and the mean of N that they make."""


@dataclass(frozen=True)
class Motion:
    """A run over n steps.

    Attributes
    ----------
    force, depth, energy
        (n,) in N, m and J (kinetic, bending and of the tension).
    amplitude
        (n, d) of the modes.
    """

    force: FloatArray
    depth: FloatArray
    energy: FloatArray
    amplitude: FloatArray

    def at(self, step: int) -> "Motion":
        """One step of it, n = 1."""
        one = [step]
        return Motion(self.force[one], self.depth[one], self.energy[one], self.amplitude[one])


class _Step:
    """One step length: (4 M / h^2 + 2 C / h + K + T G) diagonal for every tension T."""

    def __init__(self, wave: Carrier, damping: Damping, duration: float) -> None:
        self.wave, self.duration = wave, duration
        self.inertia = 4.0 * wave.inertia / duration**2
        self.mass = 1.0 + self.inertia + 2.0 * (damping.mass_rate * wave.inertia + damping.stiffness_time) / duration
        root = 1.0 / np.sqrt(self.mass)
        self.values, vectors = np.linalg.eigh(wave.tension * np.outer(root, root))
        self.into = root[:, None] * vectors
        self.press = self.into.T @ wave.pressed

    def half(self, x: FloatArray, v: FloatArray, target: float, by_depth: bool) -> tuple[FloatArray, float]:
        """Change of the amplitudes half-way and the force: the target, or such that the depth there is the target.

        Solving for the change, with its residual corrected once, keeps the digits over thousands of steps.

        Raises
        ------
        WaveError
            If no tension is found.
        """
        wave = self.wave
        depth, start, drawn = float(wave.pressed @ x), wave.pull(x), wave.tension @ x
        shift = 0.5 * self.duration * self.inertia * v - x

        def half(pull: float) -> tuple[FloatArray, float, float]:
            tension = wave.pretension + pull
            soft = 1.0 / (1.0 + tension * self.values)
            right = shift - tension * drawn - pull * wave.push
            free, give = self.into @ (soft * (self.into.T @ right)), self.into @ (soft * self.press)
            force = (target - depth - float(wave.pressed @ free)) / float(wave.pressed @ give) if by_depth else target
            change = free + force * give
            miss = right + force * wave.pressed - self.mass * change - tension * (wave.tension @ change)
            change = change + self.into @ (soft * (self.into.T @ miss))
            more = float(change @ (drawn + wave.tension @ change)) + float(wave.push @ change)
            return change, force, start + wave.stiffening * more

        return self._consistent(half, start, abs(start) + wave.stiffening * float(x @ drawn))

    def _consistent(self, half: _Half, pull: float, scale: float) -> tuple[FloatArray, float]:
        """Secant method for the mean of N that gives itself."""
        change, force, found = half(pull)
        last, miss_last, pull = pull, found - pull, found
        for _ in range(CORRECTIONS):
            change, force, found = half(pull)
            miss = found - pull
            if abs(miss) <= ROUNDING * (abs(found) + scale):
                return change, force
            last, miss_last, pull = pull, miss, pull - miss * (pull - last) / (miss - miss_last)
        raise WaveError(f"mid-point rule: no tension found within a step of {self.duration:g} s; use shorter steps")


def integrate(load: Load, wave: Carrier, damping: Damping, start: FloatArray) -> Motion:
    """Run a load history with inertia, each step as long as the history's.

    Parameters
    ----------
    load
        Force, or depth of a rigid tool, linear between its instants; within a step its mean acts.
    wave
        The modes.
    damping
        Proportional to mass and stiffness.
    start
        (d,) amplitudes at the first instant if that is at or before zero, at rest; otherwise it starts unloaded.

    Raises
    ------
    WaveError
        If no tension is found within a step.
    """
    by_depth, n = load.control == "depth", load.time.size
    x, v = np.zeros(wave.inertia.size), np.zeros(wave.inertia.size)
    out = Motion(np.empty(n), np.empty(n), np.empty(n), np.empty((n, x.size)))
    before, step = 0.0, None
    for i, (duration, value) in enumerate(zip(load.durations.tolist(), load.value.tolist(), strict=True)):
        force = value
        if duration == 0.0:
            x = start.copy()
        else:
            if step is None or abs(duration - step.duration) > SAME_STEP * duration:
                step = _Step(wave, damping, duration)
            change, force = step.half(x, v, 0.5 * (before + value), by_depth)
            x, v = x + 2.0 * change, 4.0 * change / step.duration - v
        before = value
        out.force[i], out.depth[i] = (force if by_depth else value), wave.pressed @ x
        out.energy[i], out.amplitude[i] = wave.energy(x, v), x
    return out
