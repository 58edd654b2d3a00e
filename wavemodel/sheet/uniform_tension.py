"""Runs of a sheet under one uniform tension: at rest at each instant, or in motion by the mid-point rule.

The mid-point rule for Kirchhoff's and Carrier's wave is

    M (v1 - v0) / h + C (v0 + v1) / 2 + (K + (T0 + N) G) (x0 + x1) / 2 + N n = F e,    N = (N(x0) + N(x1)) / 2.

With this mean of N the work of the tension on the step is the change of N^2 / 2 beta exactly, so without load and
damping the energy stays, whatever the step. The one unknown that enters non-linearly is the number N.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError
from wavemodel.integrators.load_history import Load
from wavemodel.integrators.viscoelastic import Damping
from wavemodel.sheet.carrier import Carrier
from wavemodel.sheet.faces import Faces
from wavemodel.sheet.sheet_runs import SheetHistory

CORRECTIONS = 60
ROUNDING = 4.0 * float(np.finfo(np.float64).eps)
SAME_STEP = 1e-12
_Half: TypeAlias = Callable[[float], tuple[FloatArray, float, float]]
"""Mean of N to the change of the amplitudes half-way, the force and the mean of N that they make."""


@dataclass(frozen=True)
class UniformRun:
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

    def at(self, step: int) -> "UniformRun":
        """One step of it, n = 1."""
        one = [step]
        return UniformRun(self.force[one], self.depth[one], self.energy[one], self.amplitude[one])


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


def integrate(load: Load, wave: Carrier, damping: Damping, start: FloatArray) -> UniformRun:
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
    out = UniformRun(np.empty(n), np.empty(n), np.empty(n), np.empty((n, x.size)))
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


@dataclass(frozen=True)
class UniformTension:
    """Kirchhoff's and Carrier's wave with the synthesis of its faces.

    Attributes
    ----------
    wave
        The modes.
    faces
        Of the sheet.
    """

    wave: Carrier
    faces: Faces

    def rest(self, control: str, value: FloatArray) -> tuple[FloatArray, FloatArray]:
        """See `Statics.rest`.

        Raises
        ------
        WaveError
            For a depth under a pressure, or if no tension is found.
        """
        history = self._history(self._resting(value, control == "depth"))
        return history.force, history.depth

    def field(self, depth: float, radii: FloatArray) -> FloatArray:
        """See `Statics.field`."""
        return np.asarray(self._faces(self._resting(np.array([depth]), True), radii)[0])

    def run(self, load: Load) -> SheetHistory:
        """See `Statics.run`."""
        return self._history(self._resting(load.value, load.control == "depth"))

    def move(self, load: Load, damping: Damping) -> SheetHistory:
        """Go through a load history with inertia, from rest.

        Raises
        ------
        WaveError
            For a depth under a pressure, or if no tension is found.
        """
        by_depth = load.control == "depth"
        self._refuse(by_depth)
        start = np.zeros(self.wave.inertia.size)
        if load.time[0] <= 0.0 and load.value[0] != 0.0:
            start = self.wave.at_rest(float(load.value[0]), by_depth)[0]
        return self._history(integrate(load, self.wave, damping, start))

    def _resting(self, value: FloatArray, by_depth: bool) -> UniformRun:
        self._refuse(by_depth)
        states, force = np.empty((value.size, self.wave.inertia.size)), np.empty(value.size)
        pull, still = 0.0, np.zeros(self.wave.inertia.size)
        for i, target in enumerate(value.tolist()):
            states[i], force[i], pull = self.wave.at_rest(target, by_depth, pull)
        energy = np.array([self.wave.energy(x, still) for x in states])
        return UniformRun(force, states @ self.wave.pressed, energy, states)

    def _refuse(self, by_depth: bool) -> None:
        if by_depth and self.faces.dent is not None:
            raise WaveError(
                "control = 'depth' is not allowed with a uniform tension under a uniform pressure: use 'force', or a "
                "rigid tool"
            )

    def _history(self, motion: UniformRun) -> SheetHistory:
        axis = self._faces(motion, np.zeros(1))[:, 1, :-1, 0]
        return SheetHistory(
            force=motion.force,
            depth=motion.depth if self.faces.dent is None else axis[:, 0],
            axis=axis,
            energy=motion.energy,
            faces=lambda step, radii: self._faces(motion.at(step), radii)[0],
        )

    def _faces(self, motion: UniformRun, radius: FloatArray) -> FloatArray:
        """(n, 2, L + 1, R): outward and downward displacement, m; the stretch of the neutral plane is left out."""
        table = self.faces.linear(radius)
        modes = table[..., :-1] @ self.wave.shape
        if self.faces.dent is None:
            modes = modes + table[..., -1:] * self.wave.pressed
        out = np.einsum("cfrd,nd->ncfr", modes, motion.amplitude, optimize=True)
        if self.faces.dent is not None:
            out[:, 1] += motion.force[:, None, None] * self.faces.dent.deflection(radius)
        return np.asarray(out)
