"""The history of force or depth that drives a run, linear between its instants, and what an integrator hands back."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias, cast

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.errors import WaveError

ControlKind: TypeAlias = Literal["force", "depth"]


@dataclass(frozen=True)
class Load:
    """A checked load history.

    Attributes
    ----------
    control
        "force" (N) or "depth" (m), press positive.
    time, value
        (n,); time rises strictly. Before its first instant the specimen is unloaded and at rest, from time zero
        on; a history that starts at or before zero starts from the static state of its first value.
    """

    control: ControlKind
    time: FloatArray
    value: FloatArray

    @property
    def durations(self) -> FloatArray:
        """(n,) of the steps, s; the first is zero where the history starts at or before zero."""
        out = np.empty_like(self.time)
        out[0] = self.time[0] - min(0.0, float(self.time[0]))
        np.subtract(self.time[1:], self.time[:-1], out=out[1:])
        return out

    @property
    def line(self) -> tuple[FloatArray, FloatArray]:
        """Corners of the whole broken line: time and value, from rest on."""
        if self.time[0] <= 0.0:
            return self.time, self.value
        return np.concatenate([[0.0], self.time]), np.concatenate([[0.0], self.value])

    def initial(self, driven: FloatArray) -> float:
        """What the body has rested at before the first step, for what drives it (n,): zero or the first value."""
        return float(driven[0]) if self.time[0] <= 0.0 else 0.0


def checked_load(control: str, time: FloatArray, value: FloatArray) -> Load:
    """Check a load history.

    Raises
    ------
    WaveError
        If the control is neither "force" nor "depth", the arrays differ in length or are empty, a number is not
        finite, or time does not rise strictly.
    """
    if control not in ("force", "depth"):
        raise WaveError(f"control = {control!r} is not allowed: 'force' or 'depth'")
    instants, values = np.array(time, dtype=np.float64), np.array(value, dtype=np.float64)
    if instants.ndim != 1 or instants.shape != values.shape or instants.size == 0:
        raise WaveError(
            f"load: time has shape {instants.shape} and value {values.shape}; both must be one-dimensional, "
            "of one length of at least 1"
        )
    for name, array in (("time", instants), ("value", values)):
        if not np.isfinite(array).all():
            at = int(np.flatnonzero(~np.isfinite(array))[0])
            raise WaveError(f"load: {name}[{at}] = {array[at]} is not allowed: only finite numbers are")
    if not (rises := instants[1:] > instants[:-1]).all():
        at = int(np.flatnonzero(~rises)[0]) + 1
        raise WaveError(f"load: time[{at}] = {instants[at]:g} s is not above the one before it; time must rise")
    return Load(cast(ControlKind, control), instants, values)


@dataclass(frozen=True)
class History:
    """A run over n steps.

    Attributes
    ----------
    force, depth
        (n,) in N and m.
    top_deflection
        (n, L) in m: each layer's top face on the axis.
    static_force
        (n, B) forces that the B fields of the static remainder answer to, N (the force as creep delays it).
    amplitude
        Step to (L, K): amplitudes of the top faces by wavenumber.
    elastic
        (n,) elastic forces that a finite-strain correction is read at, N; None where the body is linear.
    outward
        With inertia, step to (L + 1, K): amplitudes in plane of the top faces and the lowest one; None where they
        follow from the force.
    """

    force: FloatArray
    depth: FloatArray
    top_deflection: FloatArray
    static_force: FloatArray
    amplitude: Callable[[int], FloatArray]
    elastic: FloatArray | None = None
    outward: Callable[[int], FloatArray] | None = None
